#include <algorithm>

#include "engine/io/result_parts.h"

namespace poesy {
namespace {

constexpr std::string_view kByRow = "row";  ///< `judge` of an evaluation

/// One number of each limit.
template <class T, class Member>
std::vector<T> each(const LimitVerdicts& verdicts, const Member& member) {
  std::vector<T> list;
  for (const LimitVerdict& one : verdicts.limits) list.push_back(static_cast<T>(std::invoke(member, one)));
  return list;
}

std::int64_t position_or_none(const std::optional<std::size_t>& position) {
  return position ? static_cast<std::int64_t>(*position) : -1;
}

/// The opposite, of a position below `count`.
std::optional<std::size_t> read_position(std::int64_t stored, std::size_t count) {
  if (stored < 0) return std::nullopt;
  if (static_cast<std::size_t>(stored) >= count) throw h5::Error("/limits names a place that does not exist");
  return static_cast<std::size_t>(stored);
}

std::size_t position_of(const std::string& response, const StoredResult& result) {
  const auto found = std::ranges::find(result.responses, response, &NamedUnit::name);
  if (found == result.responses.end()) throw h5::Error("/limits names an unknown response");
  return static_cast<std::size_t>(found - result.responses.begin());
}

void describe(h5::File& file, const LimitVerdicts& verdicts) {
  file.set_attribute(
      "/limits", "description",
      std::string("How each limit of [analysis.limits] was kept. judge: what is compared with it: rms, the "
                  "root mean square over the samples of all poses; share, what a share of the draws stays "
                  "within at the worst pose; row, the largest magnitude of any row of errors"));
  file.set_attribute("/limits", "judge", std::string(verdicts.judge ? name(*verdicts.judge) : kByRow));
  if (verdicts.judge == Judge::share) file.set_attribute("/limits", "share", verdicts.share);
}

}  // namespace

void add_limits(ResultBuilder& result, const ModelDescription& model, const LimitVerdicts& verdicts) {
  const std::string unit = "SI: response unit, see /responses/unit";
  const Axes axes{"limited_response"};
  const auto names =
      each<std::string>(verdicts, [&](const LimitVerdict& one) { return model.responses[one.response].name; });
  result.add_axis("limited_response", names, {"1", "Name of the response that has a limit"});
  result.file().make_group("/limits");
  result.show_axes("/limits", axes);
  describe(result.file(), verdicts);
  result.add("/limits/response", axes, names, {"1", "Name of the response that has a limit"});
  result.add("/limits/limit", axes, each<double>(verdicts, &LimitVerdict::limit), {unit, "The limit"});
  result.add("/limits/value", axes, each<double>(verdicts, &LimitVerdict::value),
             {unit, "What is compared with it, a magnitude; infinite or NaN where too few samples were solved"});
  result.add("/limits/passed", axes, each<std::uint8_t>(verdicts, &LimitVerdict::passed),
             {"1", "1: the limit is kept; 0: it is not"});
  result.add("/limits/tried", axes, each<std::uint64_t>(verdicts, &LimitVerdict::tried),
             {"1", "Draws at all poses together; of an evaluation its rows of errors"});
  result.add("/limits/within", axes, each<std::uint64_t>(verdicts, &LimitVerdict::within),
             {"1", "Of these, those within the limit, a row at each of its poses; what was not solved is not"});
  const auto place = [](std::optional<std::size_t> LimitVerdict::*member) {
    return [member](const LimitVerdict& one) { return position_or_none(one.*member); };
  };
  result.add("/limits/pose", axes, each<std::int64_t>(verdicts, place(&LimitVerdict::pose)),
             {"1", "Pose of the value, from 0; -1 where it is of all poses"});
  result.add("/limits/row", axes, each<std::int64_t>(verdicts, place(&LimitVerdict::row)),
             {"1", "Row of errors, or case, of the value, from 0; -1 where there are none"});
}

std::optional<LimitVerdicts> read_limits(const h5::File& file, const StoredResult& result) {
  if (!file.exists("/limits")) return std::nullopt;
  LimitVerdicts verdicts;
  const auto judge = file.attribute<std::string>("/limits", "judge").at(0);
  const auto word = std::ranges::find(kJudges, judge, [](Judge one) { return name(one); });
  if (word != kJudges.end()) verdicts.judge = *word;
  if (word == kJudges.end() && judge != kByRow) throw h5::Error("/limits has the unknown judge '" + judge + "'");
  if (verdicts.judge == Judge::share) verdicts.share = file.attribute<double>("/limits", "share").at(0);
  const std::size_t count = axis_length(file, "limited_response");
  const auto names = read_exactly<std::string>(file, "/limits/response", count);
  const auto limit = read_exactly<double>(file, "/limits/limit", count);
  const auto value = read_exactly<double>(file, "/limits/value", count);
  const auto passed = read_exactly<std::uint8_t>(file, "/limits/passed", count);
  const auto tried = read_exactly<std::uint64_t>(file, "/limits/tried", count);
  const auto within = read_exactly<std::uint64_t>(file, "/limits/within", count);
  const auto pose = read_exactly<std::int64_t>(file, "/limits/pose", count);
  const auto row = read_exactly<std::int64_t>(file, "/limits/row", count);
  for (std::size_t k = 0; k < count; ++k) {
    verdicts.limits.push_back({.response = position_of(names[k], result),
                               .limit = limit[k],
                               .value = value[k],
                               .passed = passed[k] != 0,
                               .tried = tried[k],
                               .within = within[k],
                               .pose = read_position(pose[k], result.poses.size()),
                               .row = read_position(row[k], tried[k])});
  }
  return verdicts;
}

}  // namespace poesy
