#include "engine/report/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/error.h"
#include "engine/base/nan.h"
#include "engine/model/leading_response.h"
#include "engine/report/display.h"
#include "engine/report/drawing_table.h"
#include "engine/report/drawn_errors.h"
#include "engine/report/report_kind.h"
#include "engine/stats/proportion.h"
#include "engine/study/limit_keys.h"

namespace poesy {
namespace {

constexpr int kDigits = 6;  ///< digits of numbers that the study states

std::string judged_by(const LimitVerdicts& verdicts) {
  if (!verdicts.judge) return "largest";
  if (*verdicts.judge == Judge::rms) return "rms";
  return percent_text(verdicts.share) + " of draws";
}

std::string rule(const LimitVerdicts& verdicts) {
  if (!verdicts.judge) {
    return "largest: the largest magnitude of any row of errors at any pose; a limit is kept if every row is within it "
           "at each pose; a pose that was not solved is not within it";
  }
  if (*verdicts.judge == Judge::rms) {
    return "rms: the root mean square over the draws of all poses; draws that were not solved are left out; within: "
           "the share of all draws that are within the limit";
  }
  return fmt::format(
      "value: {} of the draws at the worst pose are within this magnitude; draws that were not solved are within no "
      "magnitude; within: the share of the draws of all poses that are within the limit",
      percent_text(verdicts.share));
}

/// The pose at which the judged value (LimitVerdict::value) occurs, in words, after the name of its row of errors if it
/// has one; empty if the value is not that of a single pose.
std::string place(const StoredResult& result, const LimitVerdict& verdict) {
  if (!verdict.pose) return {};
  const bool named = verdict.row && !result.row_names.empty();
  return (named ? result.row_names[*verdict.row] + ", " : "") + place_text(result, *verdict.pose);
}

std::string yield_caption(const YieldVerdict& yield) {
  using enum YieldVerdict::Decision;
  const std::string found = fmt::format("{} of {} within all limits at all poses", percent_text(yield.value),
                                        counted(yield.machines, "machine is", "machines are"));
  const std::string asked = percent_text(yield.asked);
  switch (yield.decision) {
    case kept:
      return fmt::format("{}{}: the yield is at least {}: {}", verdict_words(yield),
                         yield.parts_leave_open() ? ", which do not show it of others" : "", asked, found);
    case not_kept:
      return fmt::format("{}: the yield is below {}: {}", verdict_words(yield), asked, found);
    case undecided:
      return fmt::format("{}: so few machines do not tell whether the yield is {}: {}", verdict_words(yield), asked,
                         found);
    case not_asked:
      break;
  }
  return "Yield: " + found;
}

/// Appends cells to the row: the share of good machines, the share's interval, and the numbers of rejects and machines.
void add_share(std::vector<Cell>& row, std::uint64_t good, const YieldVerdict& yield) {
  const Estimate estimate = proportion(good, yield.machines, yield.conf_level);
  for (const double share : {estimate.value, estimate.interval.low, estimate.interval.high}) {
    row.push_back(percent_cell(share));
  }
  row.push_back(count_cell(yield.machines - good));
  row.push_back(count_cell(yield.machines));
}

std::string with_parts_text(const YieldVerdict& yield) {
  if (std::isnan(yield.with_parts->low)) {
    return "What few measured parts leave open of the yield is not known: fewer than 10 machines are rejects or good, "
           "errors are correlated that were not all measured on the same parts, or measured errors are drawn anew at "
           "each pose";
  }
  return fmt::format(
      "Interval of machines and measured parts: {} to {} (resampled parts, {}); low, high count machines "
      "alone",
      percent_text(yield.with_parts->low), percent_text(yield.with_parts->high), percent_text(yield.conf_level));
}

/// A cell that shows one end of a limit; empty if the limit has no such end.
Cell end_cell(double end, const NamedUnit& response) {
  return number_cell((std::isfinite(end) ? end : kNaN) / display(response).si, kDigits);
}

/// The cell of a value that is shown beside its limit. The value has as many digits as the limit (kDigits) if with
/// fewer digits it would look equal to an end of the limit.
Cell value_beside(double value, const ValueLimit& limit, const Unit& unit) {
  const auto reads_as = [&](double end) { return number_text(value / unit.si) == number_text(end / unit.si); };
  const bool is_near = reads_as(limit.to()) || reads_as(limit.from());
  return is_near ? number_cell(value / unit.si, kDigits) : number_cell(value / unit.si);
}

/// If some limit is not simply a largest magnitude at each pose (ValueLimit::is_plain), adds a column with the lower
/// ends of all limits and a column with the limits in words. Precondition: the last rows of the table are those of the
/// limits.
void add_limit_words(const StoredResult& result, std::span<const LimitVerdict> limits, Table& table) {
  if (std::ranges::all_of(limits, [](const LimitVerdict& one) { return one.limit.is_plain(); })) return;
  const std::size_t before = table.rows.size() - limits.size();
  table.columns.push_back(number_column("from", "from", "", 1));
  table.columns.push_back(text_column("limit_text", "the limit", 1));
  table.notes.emplace_back(
      "from, limit: the ends of the values that are good, or in limit alone a magnitude or the largest spread over the "
      "poses of a machine; between two ends a value counts with its sign");
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (row < before) {
      table.rows[row].insert(table.rows[row].end(), {text_cell(""), text_cell("")});
      continue;
    }
    const LimitVerdict& one = limits[row - before];
    const NamedUnit& response = result.responses[one.response];
    table.rows[row].push_back(end_cell(one.limit.is_spread() ? kNaN : one.limit.from(), response));
    table.rows[row].push_back(
        text_cell(limit_text(one.limit, [&](double value) { return response_text(response, value); })));
  }
}

/// The yield to which tolerances are usually set: the share within three standard deviations of a normal distribution.
constexpr double kUsualYield = 0.9973;

constexpr std::size_t kMostShown = 5;

/// The indices, in an array [responses x slots], of those quantities whose intervals did not become as narrow as the
/// study asks for, the widest interval first. Responses that are not in Settling::responses are left out.
std::vector<std::size_t> not_reached(const ConvergenceResult& found, const Settling& settling) {
  const std::size_t slots = found.samples.size();
  std::vector<std::size_t> list;
  for (const std::size_t r : settling.responses) {
    for (std::size_t at = r * slots; at < (r + 1) * slots; ++at) {
      if (found.reached[at] == 0) list.push_back(at);
    }
  }
  const auto width = [&](std::size_t at) {
    const double relative = found.relative_half_width[at];
    return std::isnan(relative) ? HUGE_VAL : relative;
  };
  std::ranges::stable_sort(list, std::ranges::greater(), width);
  return list;
}

std::string samples_text(const ConvergenceResult& found) {
  const auto [least, most] = std::ranges::minmax(found.samples);
  if (least == most) return counted(least, "sample", "samples") + " at each pose";
  return fmt::format("from {} to {} samples at each pose", count_text(least), count_text(most));
}

/// The cell with the number of samples that would be enough, rounded up to two digits. The half-width of an interval is
/// inversely proportional to the square root of this number.
Cell needed_cell(const ConvergenceResult& found, std::size_t at) {
  const double ratio = found.relative_half_width[at] / found.relative_error;
  const double needed = static_cast<double>(found.samples[at % found.samples.size()]) * ratio * ratio;
  if (!(needed < 1e15)) return text_cell("unknown");
  const double digit = std::pow(10.0, std::floor(std::log10(needed)) - 1.0);
  return count_cell(static_cast<std::uint64_t>(std::ceil(needed / digit) * digit));
}

/// A note on the machines that are rejected only because they were not solved at some pose.
std::string unsolved_note(const YieldVerdict& yield) {
  const bool one = yield.unsolved == 1;
  const std::string rejects = count_text(yield.unsolved) + " of the rejects ";
  const std::uint64_t impossible = yield.solves.not_assembled();
  if (impossible > 0) {
    return fmt::format("{}cannot be assembled{} at some pose; elsewhere {} within all limits", rejects,
                       impossible == yield.solves.not_converged() ? "" : ", or not solved,",
                       one ? "it is" : "they are");
  }
  return rejects + fmt::format("{} within all limits where {} solved; if that made {} good, the yield would be {}",
                               one ? "is" : "are", one ? "it is" : "they are", one ? "it" : "them",
                               percent_text(share_of(yield.machines - yield.rejects + yield.unsolved, yield.machines)));
}

}  // namespace

std::string rejected_text(const StoredResult& result) {
  const bool is_boundary = readable_setting(result.study_text, "poses", "select") == "boundary";
  return is_boundary ? end_of_reach_text(result.rejected) : rejected_text(result.rejected, result.candidates);
}

std::string summary_text(const StoredResult& result, const SolveTally& tally, std::size_t width) {
  const RunFacts& facts = result.facts;
  const double per_second =
      static_cast<double>(facts.samples()) / std::max(facts.wall_seconds, std::numeric_limits<double>::min());
  const std::string each =
      tally.second ? fmt::format(", {} at each of two fidelities,", count_text(facts.samples() / 2)) : "";
  std::string text = prose_of(result.title, width);
  text += prose_of(fmt::format("{} of {}: {}, poesy {}", result.kind, result.model,
                               counted(result.poses.size(), "pose", "poses"), result.poesy_version),
                   width);
  if (const std::string rejected = rejected_text(result); !rejected.empty()) {
    text += prose_of(rejected, width);
  }
  if (!result.metric.empty()) text += prose_of("metric: " + metric_text(result), width);
  if (is_first_order(result)) text += prose_of(std::string(kFirstOrder), width);
  text += prose_of(fmt::format("{}{} in {:.2f} s on {}: {}/s", counted_samples(facts.samples(), facts.by_series), each,
                               facts.wall_seconds, counted(facts.threads, "thread", "threads"),
                               counted_samples(static_cast<std::uint64_t>(std::llround(per_second)), facts.by_series)),
                   width);
  if (facts.by_series > 0) {
    text += prose_of(
        fmt::format("by certified series: {} of the samples, in {} of {}",
                    percent_text(share_of(facts.by_series, facts.samples())), count_text(tally.cells_by_series()),
                    counted(tally.cells.size(), "pair of an error and a pose", "pairs of an error and a pose")),
        width);
  }
  return text;
}

bool varies(const StoredResult& result, std::size_t response) {
  return std::ranges::find(result.constant, response) == result.constant.end();
}

std::string constant_text(const NamedUnit& response) {
  return response.name +
         " does not vary: what its samples scatter, if they do, is the rounding of their solves, so no error has "
         "a share of it";
}

std::vector<std::size_t> varying_first(const StoredResult& result, std::vector<std::size_t> responses) {
  std::stable_partition(responses.begin(), responses.end(), [&](std::size_t r) { return varies(result, r); });
  return responses;
}

std::string default_ranking(const StoredResult& result) {
  const std::vector<std::size_t> order = varying_first(result, result.headline);
  if (order.empty()) return {};
  const NamedUnit& leading = result.responses[order.front()];
  if (verdict_on(result, order.front()) != nullptr || leading_rank(leading.name) < kNotLeading) return leading.name;
  const bool some_vary = varies(result, order.front());
  const auto is_varying_length = [&](std::size_t r) {
    return varies(result, r) == some_vary && dimension_of(result.responses[r].unit) == Dimension::length;
  };
  const auto first = std::ranges::find_if(order, is_varying_length);
  return result.responses[first == order.end() ? order.front() : *first].name;
}

namespace {

/// The table of the drawing's features, ordered by their effect on the response by which errors are ranked.
std::optional<Table> features_table(const StoredResult& result, const TableOptions& options) {
  const auto response = std::ranges::find(result.responses, options.ranked_by, &NamedUnit::name);
  if (response == result.responses.end()) return std::nullopt;
  return drawing_table(result, static_cast<std::size_t>(response - result.responses.begin()));
}

}  // namespace

std::vector<Table> result_tables(const ReportKind& kind, const StoredResult& result, const TableOptions& options) {
  std::vector<Table> tables = kind.tables(result, options);
  auto limits = limits_table(result);
  // A kind that shows more about the yield makes a table of this name itself.
  if (limits && std::ranges::find(tables, limits->name, &Table::name) == tables.end()) {
    tables.insert(tables.begin(), *std::move(limits));
  }
  if (auto features = features_table(result, options)) {
    tables.insert(tables.begin() + (tables.empty() ? 0 : 1), *std::move(features));
  }
  if (auto measured = measured_table(result)) tables.push_back(*std::move(measured));
  if (auto stated = stated_table(result)) tables.push_back(*std::move(stated));
  if (kind.settling == nullptr) return tables;
  if (auto convergence = convergence_table(result, kind.settling(result))) tables.push_back(*std::move(convergence));
  return tables;
}

void keep_first(std::size_t most, std::span<Table> tables) {
  for (Table& table : tables) {
    if (!table.ranked || table.rows.size() <= most) continue;
    table.notes.push_back(fmt::format("{} of {} rows shown", most, table.rows.size()));
    table.rows.resize(most);
  }
}

const LimitVerdict* verdict_on(const StoredResult& result, std::size_t response) {
  const std::optional<LimitVerdicts>& verdicts = result.verdicts;
  if (!verdicts) return nullptr;
  const auto found = std::ranges::find(verdicts->limits, response, &LimitVerdict::response);
  return found == verdicts->limits.end() ? nullptr : &*found;
}

Table yield_table(const StoredResult& result, const LimitVerdicts& verdicts) {
  const YieldVerdict& yield = *verdicts.yield;
  Table table{.name = "yield",
              .caption = yield_caption(yield),
              .columns = {text_column("limit_of", "limit of"), percent_column("yield", "yield"),
                          percent_column("low", "low"), percent_column("high", "high"),
                          number_column("rejects", "rejects"), number_column("machines", "machines", "", 2),
                          number_column("limit", "limit", "", 1), text_column("unit", "unit", 1)},
              .notes = {fmt::format("yield: the share of the machines that are within the limit at every pose; low, "
                                    "high: its {} interval (Clopper and Pearson)",
                                    percent_text(yield.conf_level))}};
  std::vector<Cell> all{text_cell("all responses")};
  add_share(all, yield.machines - yield.rejects, yield);
  all.insert(all.end(), {text_cell(""), text_cell("")});
  table.rows.push_back(std::move(all));
  for (const LimitVerdict& one : verdicts.limits) {
    const Unit& unit = display(result.responses[one.response]);
    std::vector<Cell> row{text_cell(result.responses[one.response].name)};
    add_share(row, one.within, yield);
    row.push_back(end_cell(one.limit.to(), result.responses[one.response]));
    row.push_back(text_cell(unit.name));
    table.rows.push_back(std::move(row));
  }
  add_limit_words(result, verdicts.limits, table);
  if (yield.unsolved > 0) table.notes.push_back(unsolved_note(yield));
  if (yield.with_parts) table.notes.push_back(with_parts_text(yield));
  if (!result.measured.names.empty()) table.notes.push_back(few_parts_text(result, yield.conf_level, yield.asked));
  if (std::string given = given_errors_text(result); !given.empty()) table.notes.push_back(std::move(given));
  return table;
}

std::optional<Table> measured_table(const StoredResult& result) {
  const MeasuredErrors& found = result.measured;
  if (found.names.empty()) return std::nullopt;
  const auto number = [&](std::string name, std::string heading, const std::vector<double>& values, int dispensable) {
    return FilledColumn{number_column(std::move(name), std::move(heading), "", dispensable),
                        [&](std::size_t e) { return value_cell(values[e], result.factors[found.factors[e]]); }};
  };
  Table table{.name = "measured_errors",
              .caption = "Errors as measured: mean and standard deviation of the draws are those of the parts",
              .columns = {},
              .notes = {"sigma of the parts: with n - 1; least, greatest: of the parts, and of what is drawn; "
                        "correlation: of normal scores, with the error whose correlation is largest"}};
  fill(table, positions(found.names.size()),
       {{text_column("error", "error"), [&](std::size_t e) { return text_cell(found.names[e]); }},
        {text_column("unit", "unit"),
         [&](std::size_t e) { return text_cell(unit_text(result.factors[found.factors[e]])); }},
        {number_column("parts", "parts"), [&](std::size_t e) { return count_cell(found.parts[e]); }},
        number("mean", "mean", found.mean, 0),
        number("sigma_of_parts", "sigma of the parts", found.sigma_of_parts, 0),
        number("sigma", "of the draws", found.sigma, 0),
        number("least_part", "least part", found.least_part, 2),
        number("greatest_part", "greatest part", found.greatest_part, 2),
        number("least", "least draw", found.least, 3),
        number("greatest", "greatest draw", found.greatest, 3),
        {number_column("correlation", "correlation", "", 1),
         [&](std::size_t e) { return number_cell(found.correlation[e], 3); }},
        {text_column("most_correlated", "with", 1),
         [&](std::size_t e) { return text_cell(found.most_correlated[e]); }}});
  return table;
}

std::optional<Table> stated_table(const StoredResult& result) {
  const auto mean = [&](std::size_t p) { return result.factor_mean.empty() ? 0.0 : result.factor_mean[p]; };
  const auto draws = [&](std::size_t p) {
    return result.factor_draws.empty() ? std::string(name(Draws::per_machine)) : result.factor_draws[p];
  };
  std::vector<std::size_t> stated;
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    if (mean(p) != 0.0 || is_drawn_per_pose(result, p)) stated.push_back(p);
  }
  if (stated.empty()) return std::nullopt;
  Table table{.name = "stated_errors",
              .caption = "Errors with a mean, or that a machine draws anew at each pose",
              .columns = {},
              .notes = {"sigma: of the scatter about the mean; drawn: in a study of machines"}};
  const bool has_pins =
      result.drawing && std::ranges::find(result.drawing->location, "clearance") != result.drawing->location.end();
  if (has_pins && has_zone_shape(result)) {
    table.notes.emplace_back(
        "the errors of a clearance are drawn together, so that the pin stays in its bore; one of them alone is not "
        "normal");
  }
  const auto value = [&](double si, std::size_t p) { return value_cell(si, result.factors[p], kDigits); };
  fill(table, stated,
       {name_column(result.factors, "error"),
        {text_column("unit", "unit"), [&](std::size_t p) { return text_cell(unit_text(result.factors[p])); }},
        {text_column("distribution", "distribution"),
         [&](std::size_t p) { return text_cell(result.factor_distribution[p]); }},
        {number_column("mean", "mean"), [&](std::size_t p) { return value(mean(p), p); }},
        {number_column("sigma", "sigma"), [&](std::size_t p) { return value(result.factor_sigma[p], p); }},
        {text_column("draws", "drawn"), [&](std::size_t p) { return text_cell(draws(p)); }}});
  return table;
}

std::string few_parts_text(const StoredResult& result, double conf_level, double asked) {
  const MeasuredErrors& found = result.measured;
  const std::uint64_t fewest = *std::ranges::min_element(found.parts);
  const double target = asked > 0.0 ? asked : kUsualYield;
  // With confidence conf_level, n good parts of n show that the yield is at least (1 - conf_level)^(1/n).
  const double shown = std::pow(1.0 - conf_level, 1.0 / static_cast<double>(fewest));
  std::string text = fmt::format(
      "{} drawn from {} measured parts{}: where one such error alone makes the rejects, {} good parts show a yield of "
      "{} at {}",
      counted(found.names.size(), "error is", "errors are"), count_text(fewest),
      found.parts.size() > 1 && std::ranges::max(found.parts) > fewest ? " or more" : "", count_text(fewest),
      percent_text(shown), percent_text(conf_level));
  if (!(shown < target && target < 1.0 && conf_level < 1.0)) return text;  // because a result file may have any numbers
  return text + fmt::format(", and cannot show {}, which takes {}", percent_text(target),
                            count_text(trials_without_failure(target, conf_level)));
}

std::string open_parts_text(const YieldVerdict& yield) {
  if (!yield.parts_leave_open()) return {};
  return fmt::format(
      "the machines keep a yield of {}, but the parts on which errors were measured do not show it; "
      "measure more parts, or state a distribution",
      percent_text(yield.asked));
}

std::string judged_text(const LimitVerdicts& verdicts) {
  if (!verdicts.judge) return {};
  return *verdicts.judge == Judge::rms
             ? " by root mean square"
             : fmt::format(" by {} of the draws at the worst pose", percent_text(verdicts.share));
}

std::string not_within_text(const LimitVerdicts& verdicts, const LimitVerdict& one) {
  if (!verdicts.judge) return {};
  if (one.within == one.tried) return "; all samples are within it";
  return fmt::format("; {} of the samples are not within it",
                     percent_text(share_of(one.tried - one.within, one.tried)));
}

std::optional<Table> limits_table(const StoredResult& result) {
  const std::optional<LimitVerdicts>& verdicts = result.verdicts;
  if (!verdicts) return std::nullopt;
  if (verdicts->yield) return yield_table(result, *verdicts);
  std::size_t kept = 0;
  Table table{.name = "limits",
              .caption = {},
              .columns = {text_column("verdict", "limit kept"), text_column("response", "response"),
                          text_column("unit", "unit"), text_column("judged_by", "judged by", 3),
                          number_column("value", "value"), number_column("limit", "limit"),
                          percent_column("within", "within", 1), text_column("place", "where", 2)},
              .notes = {rule(*verdicts)}};
  for (const LimitVerdict& one : verdicts->limits) {
    const Unit& unit = display(result.responses[one.response]);
    kept += one.passed ? 1 : 0;
    table.rows.push_back({text_cell(one.passed ? "PASS" : "FAIL"), text_cell(result.responses[one.response].name),
                          text_cell(unit.name), text_cell(judged_by(*verdicts)),
                          value_beside(one.value, one.limit, unit),
                          end_cell(one.limit.to(), result.responses[one.response]),
                          percent_cell(share_of(one.within, one.tried)), text_cell(place(result, one))});
  }
  if (verdicts->rows_within && !verdicts->limits.empty()) {
    const std::uint64_t rows = verdicts->limits.front().tried;
    const bool several = verdicts->limits.size() > 1;
    const std::string share = several ? fmt::format(" ({})", percent_text(share_of(*verdicts->rows_within, rows))) : "";
    table.notes.push_back(fmt::format("{} of {} are within {}{}", count_text(*verdicts->rows_within),
                                      counted(rows, "row", "rows"), several ? "all limits" : "the limit", share));
  }
  add_limit_words(result, verdicts->limits, table);
  const std::size_t all = verdicts->limits.size();
  const std::string judged = judged_text(*verdicts);
  table.caption = kept == all
                      ? fmt::format("PASS{}: {} kept", judged, all == 1 ? "the limit is" : "all limits are")
                      : fmt::format("FAIL{}: {} of {} not kept", judged, all - kept, counted(all, "limit", "limits"));
  if (all == 1) table.caption += not_within_text(*verdicts, verdicts->limits.front());
  return table;
}

std::optional<Table> convergence_table(const StoredResult& result, const Settling& settling) {
  if (!result.convergence) return std::nullopt;
  const ConvergenceResult& found = *result.convergence;
  const std::size_t slots = found.samples.size();
  const std::vector<std::size_t> missing = not_reached(found, settling);
  const std::size_t all = settling.responses.size() * slots;
  Table table{
      .name = "convergence",
      .caption = fmt::format("Convergence: {} of {} {} have a {:.3g} % interval within +-{:.3g} % of their value, {}",
                             all - missing.size(), all, settling.quantities, 100.0 * found.course.conf_level,
                             100.0 * found.relative_error, samples_text(found)),
      .columns = {text_column("error", "error"), text_column("response", "response"),
                  percent_column("half_width", "half the interval"),
                  number_column("samples_needed", "samples that would do, about")}};
  for (const std::size_t at : std::span(missing).first(std::min(missing.size(), kMostShown))) {
    table.rows.push_back({text_cell(settling.slots[at % slots]), text_cell(result.responses[at / slots].name),
                          percent_cell(found.relative_half_width[at]), needed_cell(found, at)});
  }
  if (missing.size() > kMostShown) table.notes.push_back(fmt::format("and {} more", missing.size() - kMostShown));
  if (!missing.empty()) {
    table.notes.push_back(fmt::format("Raise max, which is {}, and go on with --resume if the checkpoint was kept",
                                      count_text(found.max)));
  }
  return table;
}

std::string not_settled_text(const StoredResult& result, const Settling& settling) {
  if (!result.convergence) return {};
  const ConvergenceResult& found = *result.convergence;
  const std::size_t missing = not_reached(found, settling).size();
  if (missing == 0) return {};
  return fmt::format(
      "{} of {} {} did not reach the interval of +-{} that the study asks for, with at most {} samples at each pose.",
      missing, settling.responses.size() * found.samples.size(), settling.quantities,
      percent_text(found.relative_error), count_text(found.max));
}

void check_comparable(const StoredResult& a, const std::string& path_a, const StoredResult& b,
                      const std::string& path_b) {
  if (a.kind != b.kind) {
    throw InputError({.file = path_b},
                     fmt::format("cannot be compared with {}: its kind is '{}', not '{}'", path_a, b.kind, a.kind),
                     "compare results of one kind, or look at each alone");
  }
  if (common(names_of(a.responses), names_of(b.responses)).empty()) {
    throw InputError({.file = path_b}, fmt::format("has no response in common with {}", path_a),
                     "compare results that share some");
  }
}

bool differ_in_metric(const StoredResult& a, const StoredResult& b) {
  return !a.metric.empty() && !b.metric.empty() && a.metric != b.metric;
}

std::string ranked_text(char letter, const RankedResult& ranked, std::string_view role) {
  const StoredResult& result = ranked.result;
  std::string text = result.title.empty() ? fmt::format("{}: {}", letter, ranked.path)
                                          : fmt::format("{}: {} ({})", letter, result.title, ranked.path);
  if (!result.metric.empty()) text += "; metric: " + metric_text(result);
  return text + fmt::format("; {} {}; {} of {} {}", role, ranked.response, count_text(ranked.solves.not_converged()),
                            counted_samples(ranked.solves.total(), ranked.solves.by_series()),
                            why_unsolved(ranked.solves));
}

}  // namespace poesy
