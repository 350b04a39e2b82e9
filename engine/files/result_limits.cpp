#include <algorithm>

#include "engine/files/result_parts.h"

namespace poesy {
namespace {

constexpr std::string_view kByRow = "row";  ///< `judge` of an evaluation

const Axes kLimited{"limited_response"};

/// In the order of the columns of limits.csv.
const Fields<LimitVerdict> kLimitFields{
    {"value", &LimitVerdict::value, kLimited, kResponseUnit,
     "What is compared with it, a magnitude; infinite or NaN where too few samples were solved"},
    {"limit", &LimitVerdict::limit, kLimited, kResponseUnit, "The limit"},
    {"passed", &LimitVerdict::passed, kLimited, "1", "1: the limit is kept; 0: it is not"},
    {"tried", &LimitVerdict::tried, kLimited, "1", "Draws at all poses together; of an evaluation its rows of errors"},
    {"within", &LimitVerdict::within, kLimited, "1",
     "Of these, those within the limit, a row at each of its poses; what was not solved is not"},
    {"pose", &LimitVerdict::pose, kLimited, "1", "Pose of the value, from 0; -1 where it is of all poses"},
    {"row", &LimitVerdict::row, kLimited, "1",
     "Row of errors, or case, of the value, from 0; -1 where there are none"}};

void check_position(const std::optional<std::size_t>& position, std::size_t count) {
  if (position && *position >= count) throw h5::Error("/limits names a place that does not exist");
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

void add_limits(ResultBuilder& result, const ModelDescription& model, const std::optional<LimitVerdicts>& verdicts) {
  if (!verdicts) return;
  const auto names =
      texts(verdicts->limits, [&](const LimitVerdict& one) { return model.responses[one.response].name; });
  const Label label{"1", "Name of the response that has a limit"};
  result.add_axis("limited_response", names, label);
  result.file().make_group("/limits");
  result.show_axes("/limits", kLimited);
  describe(result.file(), *verdicts);
  result.add("/limits/response", kLimited, names, label);
  write_columns(result, "/limits", kLimitFields, verdicts->limits);
}

std::optional<LimitVerdicts> read_limits(const h5::File& file, const StoredResult& result) {
  if (!file.exists("/limits")) return std::nullopt;
  LimitVerdicts verdicts;
  const auto judge = file.attribute<std::string>("/limits", "judge").at(0);
  const auto word = std::ranges::find(kJudges, judge, [](Judge one) { return name(one); });
  if (word != kJudges.end()) verdicts.judge = *word;
  if (word == kJudges.end() && judge != kByRow) throw h5::Error("/limits has the unknown judge '" + judge + "'");
  if (verdicts.judge == Judge::share) verdicts.share = file.attribute<double>("/limits", "share").at(0);
  const auto names = read_along<std::string>(file, "/limits/response", kLimited);
  verdicts.limits = read_columns(file, "/limits", kLimitFields);
  for (std::size_t k = 0; k < names.size(); ++k) {
    LimitVerdict& one = verdicts.limits[k];
    one.response = position_of(names[k], result);
    check_position(one.pose, result.poses.size());
    check_position(one.row, one.tried);
  }
  return verdicts;
}

void append_limit_table(CsvTables& tables, const StoredResult& result) {
  if (!result.verdicts) return;
  const std::vector<LimitVerdict>& limits = result.verdicts->limits;
  const auto response = [&](std::size_t line) -> const NamedUnit& { return result.responses[limits[line].response]; };
  CsvTable table{"limits",
                 {"response", [response](std::size_t line) { return response(line).name; }},
                 limits.size(),
                 {},
                 {"unit", [response](std::size_t line) { return response(line).unit; }}};
  for (const FieldRow<LimitVerdict>& field : kLimitFields) {
    table.columns.push_back(
        list_column(field.name, limits, 0, 1, [&](const LimitVerdict& one) { return number_at(field, one, 0); }));
  }
  tables.push_back(std::move(table));
}

}  // namespace poesy
