#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/kinds/allocation/in_no_part.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/allocation/summary.h"
#include "engine/kinds/allocation/zone_tables.h"
#include "engine/model/calibrated.h"
#include "engine/report/display.h"
#include "engine/study/limit_keys.h"

namespace poesy::allocation {
namespace {

constexpr int kCostDigits = 4;
constexpr int kFullDigits = 6;  ///< digits of a tolerance and of its standard deviation

std::string cost_text(double cost) { return number_text(cost, kCostDigits); }

/// A sentence on why the yield is above the wanted one.
std::string margin_text(const Result& found) {
  const YieldVerdict& shown = found.certificate;
  const double least = 1.0 - share_of(found.certificate_most, shown.machines);
  return fmt::format(
      "margin: chance may make these machines look better than all are, so at least {} of them have to be good to show "
      "{} with {} confidence; tolerances were found with a further margin, so that fresh machines pass as a "
      "rule",
      percent_text(least), percent_text(shown.asked), percent_text(shown.conf_level));
}

Table certificate_table(const StoredResult& result) {
  const Result& found = allocation_of(result);
  Table table = yield_table(result, {.judge = Judge::yield, .limits = {}, .yield = found.certificate});
  table.caption = certificate_text(found);
  table.notes.push_back(fmt::format(
      "fresh machines: drawn with the seed {}, which nothing before used; how many was set before; a machine that is "
      "not solved at a pose is rejected",
      found.certificate_seed));
  if (found.certified()) table.notes.push_back(margin_text(found));
  if (found.calibrated) table.notes.push_back(fmt::format("limits are on {}", kLeftByCalibration));
  return table;
}

/// The tolerance T of part n as a sum: "3 sigma + 10 % of T".
std::string made_of(const Result& found, std::size_t n) {
  const std::string text = number_text(found.sigmas(n), kCostDigits) + " sigma";
  const double share = found.shift(n) / found.tolerance(n);
  return share > 0.0 ? text + " + " + percent_text(share) + " of T" : text;
}

/// Whether tolerances were rounded down at the end of the search. They then cost more than before.
bool is_rounded(const Result& found) {
  return std::ranges::find(found.stages, kRoundedDown, &AllocationStage::name) != found.stages.end();
}

std::string drawing_caption(const Result& found) {
  const std::string parts = counted(parts_on_drawing(found), "part", "parts");
  const std::string cost = has_costs(found) ? ", which cost " + cost_text(found.total_cost) : "";
  switch (found.aim) {
    case Aim::least_cost:
      return fmt::format("The drawing: tolerances of {} at least cost{}, {} in all", parts,
                         is_rounded(found) ? ", then rounded down" : "", cost_text(found.total_cost));
    case Aim::equal_effect:
      return fmt::format("The drawing: tolerances of {}, each with the same share of the limit that it uses most{}",
                         parts, cost);
    case Aim::equal_tolerance:
      return fmt::format("The drawing: one tolerance for all lengths and one for all angles of {}{}", parts, cost);
    case Aim::common_factor:
      return fmt::format("The drawing: tolerances of {}, the study's errors times one factor{}", parts, cost);
  }
  return {};
}

/// Adds a note on how the cost counts zones that several limbs share.
void add_copies_note(const Result& found, Table& table) {
  const auto is_shared = [](const std::string& limbs) { return limbs.find_first_of("-, ") != std::string::npos; };
  if (!has_costs(found) || std::ranges::none_of(found.zone_limbs, is_shared)) return;
  table.notes.emplace_back(
      "cost: of each tolerance once, however many limbs share it; where each copy costs, state a cost that many times "
      "as large");
}

/// Adds a note on how far the cost may be from the least cost.
void add_bound_note(const Result& found, Table& table) {
  if (std::isnan(found.lower_bound) || !has_costs(found)) return;
  const std::string least = fmt::format(
      "under the last limits on root mean squares no tolerances cost less than {}, to "
      "within {}",
      cost_text(found.lower_bound), number_text(found.gap, 2));
  const bool cheaper = found.total_cost < found.lower_bound;
  table.notes.push_back(cheaper ? least + "; these cost less, because they keep the yield with other shares" : least);
}

FilledColumn cost_column(std::string name, std::string heading, std::span<const double> values, int dispensable = 0) {
  return {number_column(std::move(name), std::move(heading), "", dispensable),
          [values](std::size_t at) { return number_cell(values[at], kCostDigits); }};
}

FilledColumn share_column(std::string name, std::string heading, std::span<const double> values, int dispensable = 0) {
  return {percent_column(std::move(name), std::move(heading), dispensable),
          [values](std::size_t at) { return percent_cell(values[at]); }};
}

FilledColumn words_column(std::string name, std::string heading, std::span<const std::string> values,
                          int dispensable = 0) {
  return {text_column(std::move(name), std::move(heading), dispensable),
          [values](std::size_t at) { return text_cell(values[at]); }};
}

/// Adds columns with the tolerance T to six digits, the standard deviation, their unit, and the errors of each part.
/// Narrow tables omit these columns.
void add_details(const Result& found, std::vector<FilledColumn>& columns) {
  constexpr int kFirstToGo = 3;
  const auto unit = [&](std::size_t n) { return display_unit(dimension_of(found.part_unit(n))); };
  const auto length = [&](std::string name, std::string heading, const Result::Parts<double>& values) {
    return FilledColumn{number_column(std::move(name), std::move(heading), "", kFirstToGo),
                        [&values, unit](std::size_t n) { return number_cell(values(n) / unit(n).si, kFullDigits); }};
  };
  columns.push_back(length("tolerance", "T", found.tolerance));
  columns.push_back(length("sigma", "sigma", found.sigma));
  columns.push_back(
      {text_column("unit", "unit", kFirstToGo), [unit](std::size_t n) { return text_cell(unit(n).name); }});
  if (found.has_zones()) columns.push_back(words_column("part", "part", found.part_names, kFirstToGo));
  columns.push_back(words_column("errors", "errors", found.part_members, kFirstToGo + 1));
}

/// Returns true if some tolerances are chosen from processes, grades or rounded numbers.
bool has_steps(const Result& found) {
  return std::ranges::any_of(found.chosen, [](const std::string& one) { return !one.empty(); });
}

bool has_no_effect(const Result& found, std::size_t n) { return found.bound(n) == Result::kWithoutEffect; }

/// Columns with the name and the tolerance of each part.
std::vector<FilledColumn> part_columns(const Result& found) {
  return {
      words_column("part", "part", found.part_names),
      {text_column("drawing", "drawing"), [&](std::size_t n) {
         return text_cell(has_no_effect(found, n) ? "no effect" : drawing_text(found.tolerance(n), found.part_unit(n)));
       }}};
}

std::vector<FilledColumn> drawing_columns(const Result& found, bool alike) {
  static constexpr std::array<std::string_view, 5> kBounds{"", "lower", "upper", "no choice", "upper"};
  std::vector<FilledColumn> columns = found.has_zones() ? zone_columns(found) : part_columns(found);
  if (has_steps(found)) {
    columns.push_back(words_column("chosen", "grade or process", found.chosen));
  }
  if (!alike) {
    columns.push_back({text_column("made_of", "T ="), [&](std::size_t n) { return text_cell(made_of(found, n)); }});
  }
  if (has_costs(found)) {
    columns.push_back(cost_column("cost", "cost", found.cost));
    columns.push_back(share_column("share", "share of cost", found.share, 1));
  }
  columns.push_back(share_column("mean_square_share", "share of mean square", found.mean_square_share));
  if (found.has_zones()) {
    std::ranges::move(inside_columns(found), std::back_inserter(columns));
  } else {
    columns.push_back(
        {text_column("bound", "at bound"), [&](std::size_t n) { return text_cell(kBounds.at(found.bound(n))); }});
  }
  columns.push_back({number_column("coarser_rejects", "rejects if coarser", "", 2), [&](std::size_t n) {
                       const double machines = static_cast<double>(found.design_machines);
                       return number_cell(std::round(10.0 * machines * (1.0 - found.coarser_yield(n))) / 10.0);
                     }});
  add_details(found, columns);
  return columns;
}

/// The largest of these numbers; 0 if none is above zero.
double largest(std::span<const double> at_poses) {
  const std::optional<std::size_t> pose = worst_pose(at_poses);
  return pose ? at_poses[*pose] : 0.0;
}

constexpr double kNoticeable = 0.001;  // smallest share of a mean square that tables show

/// Returns true if causes other than the parts (Result::fixed_share) make up at least this share of the mean
/// square of some limited response.
bool have_fixed_share(const Result& found, double least) {
  return std::ranges::any_of(found.fixed_share.all(), [&](double share) { return share >= least; });
}

/// A note on the share of the mean square that no part causes, under the limit that is used most. Empty if the share is
/// below kNoticeable.
std::string fixed_note(const Result& found) {
  const std::vector<std::size_t> limited = limited_responses(found);
  if (found.fixed_share.empty() || limited.empty()) return {};
  const std::size_t r =
      *std::ranges::max_element(limited, {}, [&](std::size_t one) { return largest(found.limit_use.row(one)); });
  if (!(found.fixed_share(r) >= kNoticeable)) return {};
  return fmt::format(
      "in no part is {} of the mean square under the tightest limit: background, errors without a part, noise of "
      "measurements, interactions of errors; the tolerances of this table do not reduce it",
      percent_text(found.fixed_share(r)));
}

Table drawing_table(const Result& found, RowOrder order) {
  std::set<std::string> statements;
  for (std::size_t n = 0; n < found.parts(); ++n) {
    if (!found.has_zones() || found.zone_key(n).empty()) statements.insert(made_of(found, n));
  }
  const bool alike = statements.size() == 1;
  Table table{.name = "drawing", .caption = drawing_caption(found), .columns = {}, .ranked = true};
  if (found.has_zones()) table.notes.push_back(zones_note(found));
  table.notes.push_back(
      fmt::format("{}sigma: standard deviation about the mean{}; on the drawing T is rounded down to four digits",
                  alike ? "T = " + *statements.begin() + "; " : "",
                  std::ranges::any_of(found.shift, [](double one) { return one > 0.0; })
                      ? "; a share of T is for a mean that is off by so much, as often up as down"
                      : ""));
  table.notes.emplace_back(
      "share of mean square: of what all parts add to the mean square under the tightest limit; rejects if "
      "coarser: of the design's machines, predicted for this part alone with a T 5 % larger, or the next larger one "
      "that "
      "can be had");
  const auto idle = [&](std::size_t n) { return has_no_effect(found, n); };
  if (!found.has_zones() && std::ranges::any_of(positions(found.parts()), idle)) {
    table.notes.emplace_back(
        "no effect: a part on which no limit depends; its T is where the search ends, not what the part needs; so is a "
        "T at its upper bound");
  }
  if (std::string note = fixed_note(found); !note.empty()) table.notes.push_back(std::move(note));
  add_copies_note(found, table);
  add_bound_note(found, table);
  std::vector<std::size_t> parts = ordered_parts(found, order);
  if (found.has_zones()) parts = drawn_parts(found, parts);
  fill(table, parts, drawing_columns(found, alike || statements.empty()));
  return table;
}

/// Columns with the number and the coordinates of the pose at which the value of each response is largest.
std::vector<FilledColumn> pose_columns(const StoredResult& result, const std::string& name,
                                       const Result::AtPoses& values, int dispensable) {
  return {{number_column(name + "_pose", "at pose", "", dispensable),
           [&values](std::size_t r) {
             const std::optional<std::size_t> pose = worst_pose(values.row(r));
             return pose ? count_cell(*pose) : text_cell("");
           }},
          {text_column(name + "_place", "where", 2), [&result, &values](std::size_t r) {
             const std::optional<std::size_t> pose = worst_pose(values.row(r));
             return text_cell(pose ? coordinates_text(result, *pose) : std::string());
           }}};
}

/// The limit on response r, as the study states it.
ValueLimit limit_on(const Result& found, std::size_t r) {
  const double most = found.limit(r);
  if (!found.limit_is_spread.empty() && found.limit_is_spread(r) == 1.0) return ValueLimit::of_spread(most);
  const bool has_ends = !found.limit_from.empty() && found.limit_from(r) < found.limit_to(r);  // a file may be damaged
  const ValueLimit limit = has_ends ? ValueLimit::between(found.limit_from(r), found.limit_to(r)) : ValueLimit(most);
  const double share = found.limit_pose_share.empty() ? 1.0 : found.limit_pose_share(r);
  return share > 0.0 && share < 1.0 ? limit.at_share(share) : limit;
}

/// A note that states a limit in full. Empty if the limit is simply on a magnitude at each pose.
std::string limit_note(const StoredResult& result, std::size_t r) {
  const ValueLimit limit = limit_on(allocation_of(result), r);
  if (limit.is_plain()) return {};
  const auto text = [&](double value) { return response_text(result.responses[r], value); };
  const std::string note = fmt::format("{}: {}", result.responses[r].name, limit_text(limit, text));
  if (limit.is_magnitude() || limit.is_spread()) return note;
  return note + "; limit: the least distance of the mechanism with perfect parts from the nearer end";
}

/// Result::deciding_share, with NaN for limits that are judged from several poses together: they decide at no pose.
Result::AtPoses deciding_poses(const Result& found) {
  Result::AtPoses shares = found.deciding_share;
  for (const std::size_t r : limited_responses(found)) {
    if (!shares.empty() && limit_on(found, r).is_over_poses()) std::ranges::fill(shares.row(r), kNaN);
  }
  return shares;
}

Table use_table(const StoredResult& result) {
  const Result& found = allocation_of(result);
  const Result::AtPoses deciding = deciding_poses(found);
  std::vector<FilledColumn> columns{name_column(result.responses, "response"),
                                    {number_column("limit", "limit"),
                                     [&](std::size_t r) { return value_cell(found.limit(r), result.responses[r], 6); }},
                                    unit_column(result.responses),
                                    {percent_column("used", "used"), [&](std::size_t r) {
                                       return percent_cell(std::round(1e4 * largest(found.limit_use.row(r))) / 1e4);
                                     }}};
  std::ranges::move(pose_columns(result, "used", found.limit_use, 0), std::back_inserter(columns));
  const bool has_fixed = have_fixed_share(found, kNoticeable);
  if (has_fixed) columns.push_back(share_column("fixed_share", "in no part", found.fixed_share, 3));
  Table table{
      .name = "allocation_limits",
      .caption = "What each limit asks for, and where",
      .columns = {},
      .notes = {"used: the predicted root mean square over what the tightest limit allows it, at the pose where "
                "it is largest"}};
  if (has_fixed) {
    table.notes.emplace_back(
        "in no part: share of the mean square at this pose that belongs to no part (background, errors without a part, "
        "noise of measurements, interactions of errors)");
  }
  if (has_costs(found)) {
    columns.push_back(cost_column("saving", "1 % wider saves", found.saving));
    table.notes.push_back(fmt::format(
        "1 % wider saves: of the cost, if this limit alone is wider by 1 % at all poses, to first order{}",
        found.deciding_share.empty() ? ""  // a file of version 0.2
                                     : ", at the same yield; much wider, a limit saves less for each per cent, "
                                       "because others then decide"));
  }
  if (!found.deciding_share.empty()) {
    columns.push_back(
        {percent_column("decides", "decides"), [&](std::size_t r) { return percent_cell(found.decides(r)); }});
    std::ranges::move(pose_columns(result, "decides", deciding, 1), std::back_inserter(columns));
    table.notes.emplace_back(
        "decides: share of the fresh machines near the limits, within 10 %, whose largest ratio of a response to its "
        "limit is under this limit; at pose: where most of them have it");
  }
  for (const std::size_t r : limited_responses(found)) {
    if (std::string note = limit_note(result, r); !note.empty()) table.notes.push_back(std::move(note));
  }
  fill(table, limited_responses(found), columns);
  return table;
}

Table stages_table(const Result& found) {
  const auto stage = [&](std::size_t k) -> const AllocationStage& { return found.stages[k]; };
  const auto of_tried = [&](std::size_t k, auto number) {
    return stage(k).machines == 0 ? text_cell("") : count_cell(number(stage(k)));
  };
  std::vector<FilledColumn> columns{
      {text_column("stage", "stage"), [=](std::size_t k) { return text_cell(stage(k).name); }}};
  if (has_costs(found)) {
    columns.push_back(
        {number_column("cost", "cost"), [=](std::size_t k) { return number_cell(stage(k).cost, kCostDigits); }});
    columns.push_back({number_column("gap", "above the bound"),
                       [=](std::size_t k) { return number_cell(stage(k).cost - stage(k).lower_bound); }});
  }
  columns.push_back(
      {number_column("rms_share", "rms over limit"), [=](std::size_t k) { return number_cell(stage(k).rms_share); }});
  columns.push_back({number_column("machines", "machines"),
                     [=](std::size_t k) { return of_tried(k, [](const auto& one) { return one.machines; }); }});
  columns.push_back({number_column("rejects", "rejects"),
                     [=](std::size_t k) { return of_tried(k, [](const auto& one) { return one.rejects; }); }});
  Table table{.name = "stages",
              .caption = "How the tolerances were found, step by step",
              .columns = {},
              .notes = {"rms over limit: the limit on a root mean square over the limit on a value; rejects: of the "
                        "machines that were tried at these tolerances"}};
  if (found.design_machines > 0) {
    table.notes.push_back(
        fmt::format("at the end {} of the design's {} are rejects; with up to {} the certificate will probably hold",
                    count_text(found.design_rejects), counted(found.design_machines, "machine", "machines"),
                    count_text(found.design_most)));
  }
  if (has_costs(found))
    table.notes.emplace_back("above the bound: cost above what no tolerances of this step's problem go below");
  fill(table, positions(found.stages.size()), columns);
  return table;
}

/// The relative change from the cost of the tolerances found to a predicted cost, rounded to 0.01 %. Smaller changes
/// are only rounding errors of the search.
double change_of_cost(double predicted, double found) {
  constexpr double kHundredths = 1e4;
  return std::round(kHundredths * (predicted / found - 1.0)) / kHundredths + 0.0;
}

/// Fills a table with predicted costs, and their changes from the cost of the tolerances found. at: the column with the
/// yields or factors for which the costs are predicted.
void add_costs(const Result& found, std::span<const double> costs, FilledColumn at, Table& table) {
  table.notes.emplace_back("predicted, not certified; change: from the cost of the tolerances found");
  if (has_steps(found)) {
    table.notes.emplace_back(
        "tolerances go in steps (grades, processes, rounded numbers), so costs jump, and the tolerances that a study "
        "finds may cost some per cent more than this");
  }
  fill(table, positions(costs.size()),
       {std::move(at), cost_column("cost", "cost", costs), {percent_column("change", "change"), [&](std::size_t k) {
                                                              return percent_cell(
                                                                  change_of_cost(costs[k], found.total_cost));
                                                            }}});
}

void append_curves(const Result& found, std::vector<Table>& tables) {
  if (!has_costs(found)) return;
  if (!found.curve_yield.empty()) {
    Table table{.name = "cost_of_yield",
                .caption = "What another yield would cost",
                .columns = {},
                .notes = {"yield: what a study would ask for and certify with the same margin, so that more of its "
                          "machines would be good"}};
    add_costs(found, found.curve_yield_cost, share_column("yield", "yield", found.curve_yield), table);
    tables.push_back(std::move(table));
  }
  if (!found.curve_factor.empty()) {
    Table table{.name = "cost_of_limits", .caption = "What other limits would cost", .columns = {}};
    // If Result::fixed_share is at least this, the distribution of the response changes noticeably with the limits.
    constexpr double kConsiderable = 0.05;
    if (have_fixed_share(found, kConsiderable)) {
      table.notes.emplace_back(
          "errors that are in no part keep their size, so far from the study's limits these costs may be off by a "
          "third; run the study with the limits that you want");
    }
    add_costs(found, found.curve_factor_cost,
              {number_column("factor", "all limits times"),
               [&](std::size_t k) { return number_cell(found.curve_factor[k]); }},
              table);
    tables.push_back(std::move(table));
  }
}

}  // namespace

std::vector<Table> allocation_tables(const StoredResult& result, const TableOptions& options) {
  const Result& found = allocation_of(result);
  std::vector<Table> tables{certificate_table(result), drawing_table(found, options.order)};
  if (const auto errors = errors_in_no_part(result); !errors.empty()) tables.push_back(in_no_part_table(errors));
  tables.push_back(use_table(result));
  tables.push_back(stages_table(found));
  append_curves(found, tables);
  return tables;
}

}  // namespace poesy::allocation
