#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/kinds/allocation/in_no_part.h"
#include "engine/kinds/allocation/kind.h"
#include "engine/kinds/allocation/prediction.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/allocation/summary.h"
#include "engine/report/display.h"
#include "engine/report/far_limits.h"

namespace poesy::allocation {
namespace {

SolveTally tally(const StoredResult& result) {
  const auto& solves = allocation_of(result).solves;
  return {"", {"all errors"}, result.poses.size(), {solves.begin(), solves.end()}};
}

/// The responses that figures show at each pose: those with a limit. Two values are shown for each: the use of the
/// limit and its multiplier.
ShownCells cells(const StoredResult& result) {
  return shown_cells(result, 2, limited_responses(allocation_of(result)));
}

void add_certificate(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const Result& found = allocation_of(result);
  Section& section = page.add_section("certificate", "Is it certified");
  section.paragraph(fmt::format(
      "The tolerances were found with one set of {}. Then {} were drawn, to be looked at once: tolerances that are "
      "tried on the machines they were fitted to look better than they are. A machine is good if it is within all "
      "limits at all poses; one that is not solved at a pose is rejected.",
      counted(found.design_machines, "machine", "machines"),
      counted(found.certificate.machines, "fresh one", "fresh ones")));
  section.table(tables, "yield");
  if (!found.certificate_study.empty()) {
    section.folded_text("The study that repeats the certificate", found.certificate_study);
  }
}

/// The display unit of each part's tolerance, and the tolerance in this unit.
std::pair<std::vector<std::string>, std::vector<double>> shown_tolerances(const Result& found) {
  std::pair<std::vector<std::string>, std::vector<double>> shown;
  for (std::size_t n = 0; n < found.parts(); ++n) {
    const Unit& unit = display_unit(dimension_of(found.part_unit(n)));
    shown.first.emplace_back(unit.name);
    shown.second.push_back(found.tolerance(n) / unit.si);
  }
  return shown;
}

/// Bars that show the cost (if the study has costs), the share of the mean square, and the tolerance of each part.
Bars part_bars(const Result& found, ArrayPool& pool) {
  const auto [units, tolerances] = shown_tolerances(found);
  Bars bars{{}, {}, found.part_names};
  if (has_costs(found)) bars.quantities.push_back({"cost", {{""}}, pool.add("part_cost", found.cost)});
  bars.quantities.push_back(
      {"share of the mean square", {{"%"}}, pool.add("part_mean_square", found.mean_square_share, 0.01)});
  bars.quantities.push_back({"tolerance T", {units}, pool.add("part_tolerance", tolerances)});
  return bars;
}

void add_drawing(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const Result& found = allocation_of(result);
  Section& section = page.add_section("drawing", "What goes on the drawing");
  section.table(tables, "drawing");
  section.table(tables, "in_no_part");
  if (found.has_zones()) section.paragraph("Tolerance frames are in mm.");
  for (std::size_t n = 0; n < found.parts(); ++n) {
    page.figures.about.emplace(found.part_names[n], found.part_members(n));
  }
  add_figure(page, section, "parts", part_bars(found, page.figures.pool),
             has_costs(found) ? "What the tolerance of each part costs." : "Which parts use the tightest limit.");
}

/// A line chart of costs over x.
Lines cost_lines(const std::string& key, Coordinate x, std::span<const double> costs, Mark mark, ArrayPool& pool) {
  return {.x = std::move(x),
          .panels = {{"predicted cost", "", {{"cost", pool.add(key, costs)}}}},
          .marks = {std::move(mark)}};
}

void add_costs(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const Result& found = allocation_of(result);
  Section& section = page.add_section("limits", "What the limits ask for");
  section.table(tables, "allocation_limits");
  if (!has_costs(found)) return;
  ArrayPool& pool = page.figures.pool;
  if (!found.curve_yield.empty()) {
    add_figure(page, section, "cost-of-yield",
               cost_lines("yield_cost", {"yield", "%", pool.add("curve_yield", found.curve_yield, 0.01)},
                          found.curve_yield_cost, {"asked for", 100.0 * found.wanted_yield}, pool),
               "Predicted cost over the yield that is asked for, and would be certified with the same margin.");
    section.table(tables, "cost_of_yield");
  }
  if (!found.curve_factor.empty()) {
    add_figure(page, section, "cost-of-limits",
               cost_lines("factor_cost", {"all limits times", "", pool.add("curve_factor", found.curve_factor)},
                          found.curve_factor_cost, {"the study", 1.0}, pool),
               "Predicted cost if all limits were wider or narrower by one factor.");
    section.table(tables, "cost_of_limits");
  }
}

/// The numbers of these responses at all poses, one response after the other.
std::vector<double> rows_of(const Result::AtPoses& values, std::span<const std::size_t> responses) {
  std::vector<double> list;
  for (const std::size_t r : responses) std::ranges::copy(values.row(r), std::back_inserter(list));
  return list;
}

/// Adds to the page the section that shows, for each pose, how much of each limit is used and how often it decides.
void add_where(const StoredResult& result, Page& page) {
  const Result& found = allocation_of(result);
  const PoseFigures figures(result, cells(result), page);
  const std::vector<std::string> names = names_of(result.responses, figures.responses());
  if (names.empty()) return;
  Section& section = page.add_section("where", "Where in the workspace");
  section.paragraph(
      "The use of a limit: the predicted root mean square over what the tightest limit allows it. Where it is 100 %, "
      "the pose sets the tolerances.");
  figures.add_note(section);
  const auto add = [&](const std::string& name, const Result::AtPoses& values, double unit) {
    return figures.add(name, rows_of(values, figures.responses()), unit);
  };
  std::vector<HeatLayer> layers{{"use of the limit", "%", add("limit_use", found.limit_use, 0.01)}};
  std::vector<Field> fields{{"use of the limit", "%", layers.front().value, names}};
  if (!found.deciding_share.empty()) {
    layers.push_back({"machines near the limits that this decides", "%", add("decides", found.deciding_share, 0.01)});
    fields.push_back({layers.back().label, "%", layers.back().value, names});
  }
  add_figure(page, section, "poses", figures.heat_map(std::move(layers), names, ""),
             "The use of each limit at each pose.");
  fields.push_back(figures.not_converged(tally(result).shares_by_pose()));
  figures.add_condition(fields);
  figures.add_workspace(section, std::move(fields));
}

void add_page(const StoredResult& result, std::span<const Table> tables, Page& page) {
  if (allocation_of(result).poses() == 0 || allocation_of(result).parts() == 0) return;
  add_certificate(result, tables, page);
  add_drawing(result, tables, page);
  add_costs(result, tables, page);
  add_where(result, page);
  page.add_section("stages", "How they were found").table(tables, "stages");
}

void warn(const StoredResult& result, std::vector<std::string>& list) {
  const Result& found = allocation_of(result);
  if (found.certified()) return;
  std::string text = certificate_text(found);
  text.front() = 'N';
  list.push_back(text + ".");
}

/// Notes on limits of which the tolerances use only a small part. Empty if the certificate has rejects.
std::vector<std::string> notes_on_far_limits(const StoredResult& result) {
  const Result& found = allocation_of(result);
  std::vector<std::string> notes;
  if (found.certificate.machines == 0 || found.certificate.rejects > 0 || found.poses() == 0) return notes;
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const double times = 1.0 / std::ranges::max(found.limit_use.row(r));
    if (std::isnan(found.limit(r)) || !is_far(times)) continue;
    notes.push_back(fmt::format("The limit of {} is {} times what these tolerances use of it{}",
                                result.responses[r].name, number_text(times, 2), kLookAtUnits));
  }
  return notes;
}

/// Names the parts with the largest shares of the cost, or of the mean square.
std::string largest_parts(const Result& found) {
  constexpr std::size_t kMost = 3;
  const Result::Parts<double>& shares = shown_shares(found);
  const std::vector<std::size_t> order = ordered_parts(found, RowOrder::effect);
  std::string text;
  for (const std::size_t n : std::span(order).first(std::min(kMost, order.size()))) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", found.part_names[n], percent_text(shares(n)));
  }
  return text;
}

/// Names the limit whose relaxation would save most, the pose at which it is used most, and what other limits would
/// save. Empty if no saving is known.
std::string tightest_text(const StoredResult& result) {
  constexpr double kOfNote = 0.1;  // share of the largest saving
  const Result& found = allocation_of(result);
  std::optional<std::size_t> most;
  for (const std::size_t r : limited_responses(found)) {
    if (!std::isnan(found.saving(r)) && (!most || found.saving(r) > found.saving(*most))) most = r;
  }
  if (!most) return {};
  const NamedUnit& response = result.responses[*most];
  const std::optional<std::size_t> pose = worst_pose(found.limit_use.row(*most));
  const std::string where = pose ? fmt::format(", used most at {}", place_text(result, *pose)) : std::string();
  std::string others;
  for (const std::size_t r : limited_responses(found)) {
    if (r == *most || !(found.saving(r) > kOfNote * found.saving(*most))) continue;
    others += fmt::format("; that on {} {}", result.responses[r].name, number_text(found.saving(r), 3));
  }
  return fmt::format("The limit of {} on {}{}. 1 % wider it saves {} of {}{}.",
                     response_text(response, found.limit(*most)), response.name, where,
                     number_text(found.saving(*most), 3), number_text(found.total_cost), others);
}

/// Sentences that name the errors in no part, because the certificate is valid only for their sizes. Empty if there are
/// no such errors.
std::string keep_text(const StoredResult& result) {
  const std::string text = in_no_part_text(errors_in_no_part(result), result.factors.size());
  return text.empty() ? text : text + ". The certificate holds only with these sizes. ";
}

Answer answer(const StoredResult& result) {
  const Result& found = allocation_of(result);
  if (found.poses() == 0 || found.parts() == 0) return {};
  const YieldVerdict& shown = found.certificate;
  const std::string parts = counted(parts_on_drawing(found), "part", "parts");
  const std::string largest = largest_parts(found);
  Answer lines{{"Answer", as_sentence(certificate_text(found))},
               {has_costs(found) ? "Cost" : "Parts",
                has_costs(found)
                    ? fmt::format("{} cost {} in all; most of it {}.", parts, number_text(found.total_cost), largest)
                    : fmt::format("{}; most of the mean square is made by {}.", parts, largest)}};
  if (std::string tightest = tightest_text(result); !tightest.empty()) {
    lines.emplace_back("What decides", std::move(tightest));
  }
  lines.emplace_back(
      "How sure", fmt::format("{} of fresh machines are good, {} interval {} to {}.", percent_text(shown.value),
                              percent_text(shown.conf_level), percent_text(shown.ci_low), percent_text(shown.ci_high)));
  lines.emplace_back(kWhatToDo, found.certified()
                                    ? fmt::format("Put the tolerances of the table below on the drawing. {}The study "
                                                  "of the certificate repeats the proof.",
                                                  keep_text(result))
                                    : "Do not use these tolerances as they are: study again with more samples or a "
                                      "lower yield. Another seed until the certificate is reached proves nothing.");
  return lines;
}

/// The tolerances with which the fresh machines were drawn, as one text for lengths and one for angles: "34 parts with
/// tolerances of 0.01 to 0.05 mm, standard deviations of 0.003 to 0.015 mm".
std::vector<std::string> tolerance_sizes(const Result& found) {
  std::vector<std::string> sizes;
  for (const std::string_view unit : {"m", "rad"}) {
    std::vector<double> tolerances;
    std::vector<double> sigmas;
    for (std::size_t q = 0; q < found.parts(); ++q) {
      if (found.part_unit(q) != unit || found.is_left_out(q)) continue;
      tolerances.push_back(found.tolerance(q));
      sigmas.push_back(found.sigma(q));
    }
    if (tolerances.empty()) continue;
    const NamedUnit named{"", std::string(unit)};
    const Unit& shown = display(named);
    const auto range = [&](const std::vector<double>& values) {
      const auto [least, most] = std::ranges::minmax(values);
      return fmt::format("{:.4g} to {:.4g} {}", least / shown.si, most / shown.si, shown.name);
    };
    sizes.push_back(fmt::format("{} with tolerances of {}, standard deviations of {}",
                                counted(tolerances.size(), "part", "parts"), range(tolerances), range(sigmas)));
  }
  return sizes;
}

StudyWords words(const StoredResult& result) {
  const Result& found = allocation_of(result);
  return {.draws = true,
          .samples = counted(found.certificate.machines, "fresh machine", "fresh machines"),
          .drawn = tolerance_sizes(found),
          .seed = found.certificate_seed};
}

MethodWords method(const StoredResult& result) {
  const Result& found = allocation_of(result);
  const std::string others = in_no_part_text(errors_in_no_part(result), result.factors.size());
  return {fmt::format(
      "{} under the wanted yield were found by linearised mean squares and by the yield of drawn machines, and were "
      "judged with fresh machines, which the search had not seen. {}{}",
      has_costs(found) ? "Tolerances of least cost" : "The largest tolerances", as_sentence(certificate_text(found)),
      others.empty() ? "" : " " + others + ".")};
}

/// The share of each error in the mean square, and at each pose the use of the limit that is used most.
ErrorShares error_shares(const StoredResult& result) {
  const Result& found = allocation_of(result);
  if (found.parts() == 0 || found.poses() == 0) return {};
  ErrorShares shares{.what = "share of the mean square under the tightest limit",
                     .values = {found.error_mean_square_share.begin(), found.error_mean_square_share.end()},
                     .pose_what = "the use of the limits",
                     .at_poses = std::vector<double>(found.poses(), kNaN)};
  if (shares.values.empty()) {
    shares.values =
        divided_shares(result, {found.part_members.begin(), found.part_members.end()}, found.mean_square_share);
    shares.joined = "part";
  }
  for (std::size_t r = 0; r < found.limit.size(); ++r) {
    for (std::size_t m = 0; m < found.poses(); ++m) {
      shares.at_poses[m] = std::fmax(shares.at_poses[m], found.limit_use(r, m));
    }
  }
  return shares;
}

/// The tolerances of a result, part by part, for comparison with the result `other`. Costs are included if both results
/// have costs.
Comparable comparable(const StoredResult& result, const StoredResult& other) {
  const Result& found = allocation_of(result);
  Comparable all{"tolerances", {"all limits"}, "part", found.part_names};
  if (has_costs(found) && has_costs(allocation_of(other))) {
    all.quantities.push_back({"cost", "cost", {{""}}, {found.cost.begin(), found.cost.end()}});
    all.total_label = "Cost of all parts";
    all.totals = {found.total_cost};
  }
  std::vector<double> shares;
  for (const double share : found.mean_square_share) shares.push_back(100.0 * share);
  all.quantities.push_back({"share of the mean square", "mean_square", {{"%"}}, std::move(shares)});
  const auto [units, tolerances] = shown_tolerances(found);
  all.quantities.push_back({"tolerance T", "tolerance", {units}, tolerances});
  all.ranked = true;
  return all;
}

/// The number that decides which of two results is better: the cost. It has no confidence interval, because a result
/// does not show which cost the search would have found with other machines.
std::vector<Merit> merits(const StoredResult& result, std::string_view) {
  const Result& found = allocation_of(result);
  if (!has_costs(found)) return {};
  return {{.what = std::string(kCostMerit),
           .value = found.total_cost,
           .note =
               "the cost has no interval: a search with another seed finds other tolerances at another cost; poesy run "
               "--seed shows by how much"}};
}

}  // namespace

constinit const ReportKind kReport{.tally = tally,
                                   .tables = allocation_tables,
                                   .merits = merits,
                                   .sorts = true,
                                   .words = words,
                                   .method = method,
                                   .warn = warn,
                                   .far_limits = notes_on_far_limits,
                                   .answer = answer,
                                   .shown_cells = cells,
                                   .page = add_page,
                                   .solved_page = add_prediction,
                                   .error_shares = error_shares,
                                   .comparable = comparable};

}  // namespace poesy::allocation
