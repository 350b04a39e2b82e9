#include "engine/study/limit_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/schema/keys_section.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The two ends of a limit, SI. An end that the file does not state is infinite.
struct Ends {
  double from = -kInfinity;
  double to = kInfinity;
};

/// Makes the limit with these ends; for a response that is never below zero, a limit on its magnitude. Throws
/// InputError if the ends are in the wrong order, or cannot limit this response.
ValueLimit between(const StudyValue& value, const Ends& ends, const Response& response) {
  const auto text = [&](double end) { return readable_text({end, response.dimension}); };
  if (!(ends.from < ends.to)) {
    value.fail("runs from " + text(ends.from) + " to " + text(ends.to),
               "write the lower end first, and two different ends");
  }
  if (!response.is_magnitude()) return ValueLimit::between(ends.from, ends.to);
  if (ends.from > 0.0) {
    value.fail("begins at " + text(ends.from) + ", but " + response.name + " has no sign and is zero without errors",
               "write the upper end alone");
  }
  if (!(ends.to > 0.0)) {
    value.fail("ends at " + text(ends.to) + ", but " + response.name + " has no sign and is never below zero",
               "write an upper end above zero");
  }
  if (std::isinf(ends.to)) {
    value.fail("has a lower end alone, which limits nothing, because " + response.name + " has no sign",
               "write an upper end, to");
  }
  return {ends.to};
}

/// Reads one end of a limit, SI; 0 needs no unit.
double read_end(const StudyValue& value, const Response& response) {
  return value.is_zero() ? 0.0 : value.quantity(response.dimension);
}

double read_share(const StudyValue& value) {
  return read_number(value, {.least = std::numeric_limits<double>::min(),
                             .most = 1.0,
                             .ends_included = true,
                             .words = "above 0 and at most 1",
                             .remedy = "it must be above 0 and at most 1, e.g. 0.99",
                             .percent = true});
}

ValueLimit read_spread(const StudyValue& value, const StudySection& section, const Response& response) {
  for (const char* key : {"from", "to", "share"}) {
    if (const auto other = section.find(key)) {
      other->fail("is set beside spread, which is a limit of its own",
                  "leave one of them out, or write a [[response]] of the same value with its own limit");
    }
  }
  return ValueLimit::of_spread(value.positive_quantity(response.dimension));
}

ValueLimit read_table(const StudyValue& value, const Response& response) {
  const StudySection section = value.section();
  section.allow();
  if (const auto spread = section.find("spread")) return read_spread(*spread, section, response);
  const auto from = section.find("from");
  const auto to = section.find("to");
  if (!from && !to) value.fail("states no end", "write from, to, or both; or spread");
  Ends ends;
  if (from) ends.from = read_end(*from, response);
  if (to) ends.to = read_end(*to, response);
  const ValueLimit limit = between(value, ends, response);
  const auto share = section.find("share");
  return share ? limit.at_share(read_share(*share)) : limit;
}

ValueLimit read_limit(const StudyValue& value, const Response& response) {
  if (value.is_section()) return read_table(value, response);
  if (!value.is_list()) return {value.positive_quantity(response.dimension)};
  const auto ends = value.list(2, "write the two ends, the lower one first; { to = ... } has one end");
  return between(value, {read_end(ends[0], response), read_end(ends[1], response)}, response);
}

/// A limit as TOML that is read back as exactly the same limit.
std::string exact_limit(const ValueLimit& limit, const Response& response) {
  const auto exact = [&](double value) { return exact_value(value, response.dimension); };
  if (limit.is_plain()) return exact(limit.to());
  if (limit.is_spread()) return fmt::format("{{ spread = {} }}", exact(limit.to()));
  const bool has_from = std::isfinite(limit.from()) && !(limit.is_magnitude() && response.is_magnitude());
  if (limit.share() == 1.0 && has_from && std::isfinite(limit.to())) {
    return fmt::format("[{}, {}]", exact(limit.from()), exact(limit.to()));
  }
  std::vector<std::string> keys;
  if (has_from) keys.push_back("from = " + exact(limit.from()));
  if (std::isfinite(limit.to())) keys.push_back("to = " + exact(limit.to()));
  if (limit.share() < 1.0) keys.push_back("share = " + shortest(limit.share()));
  return fmt::format("{{ {} }}", fmt::join(keys, ", "));
}

}  // namespace

void read_response_limits(const StudyValue& value, Study& study) {
  const std::vector<Response>& responses = study.model().responses;
  read_named(value.section(), responses, "response", [&](std::size_t r, const StudyValue& own) {
    study.analysis.limits.push_back({r, read_limit(own, responses[r])});
  });
  if (study.analysis.limits.empty()) value.fail("states no limit", "write a response with its limit, or leave it out");
}

std::string response_limits_lines(const Study& study) {
  std::string text;
  for (const ResponseLimit& limit : study.analysis.limits) {
    const Response& response = study.model().responses[limit.response];
    text += fmt::format("limits.{} = {}\n", response.name, exact_limit(limit.allowed, response));
  }
  return text;
}

StudyTables limit_tables() {
  return {
      {.paths = {"analysis.limits"},
       .meaning = "'poesy models MODEL' lists the responses.",
       .keys =
           {{.name = "RESPONSE",
             .type = "quantity, list of two quantities, or table",
             .bounds = "greater than 0",
             .usual = "none",
             .meaning =
                 "A value of this response is good up to here; one that has a sign, by its magnitude. "
                 "A list, [\"-0.02 mm\", \"0.1 mm\"], has the lower and the upper end of the values that are good; a "
                 "table has one end, a share of the poses or the spread over them."}}},
      {.paths = {"analysis.limits.RESPONSE"},
       .meaning = "A limit with one end, for a share of the poses, or on the spread over them.",
       .keys = {{.name = "from",
                 .type = "quantity",
                 .usual = "none",
                 .meaning = "The lower end of the values that are good."},
                {.name = "to",
                 .type = "quantity",
                 .usual = "none",
                 .meaning = "The upper end; a response without a sign has this end alone."},
                {.name = "share",
                 .type = "number",
                 .bounds = "above 0 and at most 1",
                 .usual = "`1`",
                 .meaning = "Of the poses of a machine at least this share must be within the ends. With draws = "
                            "\"per machine\", in an allocation, or for cases."},
                {.name = "spread",
                 .type = "quantity",
                 .bounds = "greater than 0",
                 .meaning = "Instead of ends: the largest less the smallest value over the poses of a machine is "
                            "good up to here. With draws = \"per machine\", in an allocation, or for cases."}}}};
}

StudyValue limit_value(const StudySection& analysis, const Study& study, const ResponseLimit& limit) {
  return analysis.section("limits").require(study.model().responses[limit.response].name);
}

std::string limit_text(const ValueLimit& limit, const std::function<std::string(double)>& value_text) {
  std::string text;
  if (limit.is_spread()) {
    text = "a spread of " + value_text(limit.to());
  } else if (limit.is_magnitude()) {
    text = value_text(limit.to());
  } else if (std::isinf(limit.from())) {
    text = "at most " + value_text(limit.to());
  } else if (std::isinf(limit.to())) {
    text = "at least " + value_text(limit.from());
  } else {
    text = value_text(limit.from()) + " to " + value_text(limit.to());
  }
  return limit.share() < 1.0 ? fmt::format("{} at {:.6g} % of the poses", text, 100.0 * limit.share()) : text;
}

std::string limit_text(const ValueLimit& limit, Dimension dimension) {
  return limit_text(limit, [dimension](double value) { return readable_text({value, dimension}); });
}

}  // namespace poesy
