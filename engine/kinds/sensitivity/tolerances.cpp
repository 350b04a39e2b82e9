#include "engine/kinds/sensitivity/tolerances.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/base/nan.h"
#include "engine/kinds/sensitivity/figures.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/linearity.h"
#include "engine/kinds/sensitivity/ranking.h"

namespace poesy::sensitivity {
namespace {

using Indices = Result::Indices;

/// The group /tolerances. It repeats data of other groups, for programs that read only this group.
struct ToleranceGroup {
  Array<std::string, axis::Factor> kind;  ///< dimension of the error: "linear" or "angular"
  Array<std::string, axis::Factor> unit;
  Indices equal_effect;
  Indices mean_square_share;
  Indices rms_effect;
  Array<double, axis::Response> background_rms;
};

const Group<ToleranceGroup> kToleranceGroup{
    "/tolerances",
    "Tolerances from the indices; a tolerance is the standard deviation of a normal error",
    {},
    {},
    {{"kind", &ToleranceGroup::kind, "1", "Kind of the error: linear or angular"},
     {"unit", &ToleranceGroup::unit, "1", "SI unit of the error and of its tolerance"},
     {"equal_effect", &ToleranceGroup::equal_effect, "SI: factor unit, see /tolerances/unit",
      "Tolerance that gives every error the reference's effect: index(reference) / index x reference_tolerance (Du et "
      "al. 2022, Section 6.3, Table 10); infinity: no effect on its own; NaN: unknown"},
     {"mean_square_share", &ToleranceGroup::mean_square_share, "1",
      "Share of what all errors add to the response's mean square over samples and poses, with sigma as set in the "
      "study: (rms_effect x sigma)^2 over its sum; NaN: unknown"},
     {"rms_effect", &ToleranceGroup::rms_effect, kIndexUnit,
      "Growth of the response's mean square over samples and poses per tolerance^2, square root of it: mean square = "
      "background_rms^2 + sum of (rms_effect x tolerance)^2"},
     {"background_rms", &ToleranceGroup::background_rms, kResponseUnit,
      "Root mean square over the poses of the response with all varied errors zero"}}};

const std::vector<Attribute<Result>> kIndexLevel{{"conf_level", &Result::conf_level}};

/// The fields of the group /tolerances that repeat indices of the group /sensitivity.
const Fields<Result> kIndexFields{
    {"index", &Result::global, kIndexUnit,
     "Global sensitivity index as published, /sensitivity/global: tolerances are counted from it"},
    {"index_ci_low", &Result::global_ci_low, kIndexUnit, "Lower end of the interval of index", Presence::always,
     kIndexLevel},
    {"index_ci_high", &Result::global_ci_high, kIndexUnit, "Upper end of the interval of index", Presence::always,
     kIndexLevel}};

/// The fields of numbers that follow from the study. Only these fields and the reference errors are read from the group
/// /tolerances.
const Fields<Result> kStudyFields{
    {"limb", &Result::limb, "1", "Limb of the error, from 1"},
    {"mean_square_bound", &Result::mean_square_bound, "1",
     "To first order, the mean square of all errors together is at most this times the sum of those of each error "
     "alone; 1: they add exactly"}};

/// The reference error of each response.
struct ReferenceColumns {
  Array<std::string, axis::Response> factor;  ///< name of the reference; empty if there is none
  Array<double, axis::Response> tolerance;    ///< its tolerance; NaN if there is none
};

const Fields<ReferenceColumns> kReferenceFields{
    {"reference_factor", &ReferenceColumns::factor, "1",
     "The error from which equal_effect is counted; empty when no error has an effect"},
    {"reference_tolerance", &ReferenceColumns::tolerance, "SI: unit of reference_factor",
     "Tolerance of reference_factor"}};

std::optional<ReferenceError> reference_for(const Study& study, const Result& found, std::size_t response) {
  const std::vector<FactorIndex>& factors = study.analysis.factors;
  if (const auto& chosen = asked_of<Options>(study.analysis).reference) {
    const auto at = std::ranges::find(factors, chosen->factor);
    return ReferenceError{static_cast<std::size_t>(at - factors.begin()), chosen->tolerance};
  }
  const std::vector<double> sigma = standard_deviations(study);
  const auto smallest = smallest_effect(response_study(found, sigma, {}, response).index, sigma);
  if (!smallest) return std::nullopt;
  return ReferenceError{*smallest, display_unit(study.model().factors[factors[*smallest].value].dimension).si};
}

/// Appends columns with the numbers of each error to the table. heading(name, unit, suffix): the heading of a column;
/// the suffix is "_display" for columns in display units.
template <class Heading>
void append_tolerance_columns(CsvTable& table, const StoredResult& result, const ResponseTolerances& tolerances,
                              const Heading& heading) {
  const Result& found = sensitivity_of(result);
  const std::size_t r = tolerances.response;
  const std::string index_unit = csv_unit(kIndexUnit, result, &result.responses[r]);
  table.columns.push_back(list_column(heading("index", index_unit, ""), found.global.row(r)));
  table.columns.push_back(list_column(heading("index_ci_low", index_unit, ""), found.global_ci_low.row(r)));
  table.columns.push_back(list_column(heading("index_ci_high", index_unit, ""), found.global_ci_high.row(r)));
  table.columns.push_back(
      {"mean_square_share", [shares = tolerances.all.mean_square_share](std::size_t p) { return shares[p]; }});
  table.columns.push_back(list_column("index_change", found.index_change.row(r)));
  std::vector<std::pair<std::string, std::vector<double>>> lists;
  if (tolerances.limit) {
    lists.emplace_back("limit_equal_effect", tolerances.limit->equal_effect);
    lists.emplace_back("limit_equal_tolerance", tolerances.limit->equal_tolerance);
  }
  lists.emplace_back("equal_effect", tolerances.all.equal_effect);
  for (const auto& [name, list] : lists) {
    table.columns.push_back(
        {heading(name, si_units(result.factors), ""), [values = list](std::size_t p) { return values[p]; }});
  }
  for (const auto& [name, list] : lists) {
    table.columns.push_back(
        {heading(name, display_units(result.factors), "_display"),
         [&result, values = list](std::size_t p) { return values[p] / display(result.factors[p]).si; }});
  }
}

Cell tolerance_cell(double tolerance, const Unit& unit) {
  return std::isinf(tolerance) ? text_cell("no effect") : number_cell(tolerance / unit.si);
}

void add_reference_notes(std::vector<std::string>& notes, const StoredResult& result,
                         const ResponseTolerances& tolerances) {
  const NamedUnit& response = result.responses[tolerances.response];
  const std::optional<ReferenceError>& reference = tolerances.all.reference;
  if (!reference) {
    notes.push_back(fmt::format("no error has an effect on {}", response.name));
    return;
  }
  const NamedUnit& factor = result.factors[reference->factor];
  const double rms = std::sqrt(tolerances.all.mean_square.at(tolerances.all.equal_effect));
  notes.push_back(fmt::format("equal effect: as much as {} = {}; with these, predicted root mean square of {}: {}",
                              factor.name, readable_text({reference->tolerance, dimension_of(factor.unit)}),
                              response.name, std::isnan(rms) ? "unknown" : response_text(response, rms)));
}

void add_limit_notes(std::vector<std::string>& notes, const StoredResult& result,
                     const ResponseTolerances& tolerances) {
  if (!tolerances.limit) return;
  const NamedUnit& response = result.responses[tolerances.response];
  notes.push_back(
      fmt::format("limit: predicted root mean square of {} over samples and poses = {}; the background alone gives {}",
                  response.name, response_text(response, tolerances.limit->limit),
                  response_text(response, std::sqrt(tolerances.all.mean_square.background))));
  notes.emplace_back(
      "equal tolerance: one number for all lengths and one for all angles, in the proportion of the median "
      "sigma that the study sets to lengths and to angles");
  notes.emplace_back(
      "an error without effect on its own has its equal tolerance, because it may act together with others");
  notes.emplace_back(
      "a quick look: standard deviations under a limit on one root mean square, without costs, bounds or a yield. A "
      "study of kind allocation finds the tolerances of a drawing, with a certificate: poesy template MODEL "
      "allocation");
}

/// Adds a note if the response combines several norms. Their mean squares do not add exactly, so the note states how
/// far the limit may be exceeded even if every effect is linear.
void add_bound_note(std::vector<std::string>& notes, const StoredResult& result, const ResponseTolerances& tolerances) {
  if (!tolerances.limit) return;
  const double bound = std::sqrt(sensitivity_of(result).mean_square_bound(tolerances.response));
  if (bound == 1.0) return;
  const NamedUnit& response = result.responses[tolerances.response];
  notes.push_back(
      fmt::format("the root mean square may come out up to {:.3g} times as large, {}, even where every effect is "
                  "linear: {} is made of several norms, and their mean squares do not add exactly. To be safe, give "
                  "--limit \"{}\"",
                  bound, response_text(response, tolerances.limit->limit * bound), response.name,
                  response_text(response, tolerances.limit->limit / bound)));
}

/// Adds a note if the study states means of errors, and notes if some of its errors are not normal.
void add_distribution_note(std::vector<std::string>& notes, const StoredResult& result) {
  std::vector<std::string> shapes;
  std::size_t count = 0;
  for (const std::string& shape : result.factor_distribution) {
    if (shape == "normal") continue;
    ++count;
    if (std::ranges::find(shapes, shape) == shapes.end()) shapes.push_back(shape);
  }
  if (!result.factor_mean.empty()) {
    notes.emplace_back(
        "the study states means of errors: tolerances are about them, and what the means do to the response is not "
        "counted here. Confirm by a Monte Carlo study");
  }
  if (count == 0) return;
  notes.push_back(
      fmt::format("{} of {} not normal in the study ({}): the tolerance is still the standard deviation of a normal "
                  "error, the same as of an error of another distribution where effects are linear",
                  count, counted(result.factors.size(), "error is", count == 1 ? "errors is" : "errors are"),
                  fmt::join(shapes, ", ")));
  if (std::ranges::find(shapes, "measured") == shapes.end()) return;
  notes.emplace_back(
      "measured errors need not have a mean of zero: what their means do to the response counts as if it were scatter "
      "here, and means of several errors do not add as scatter does. Confirm by a Monte Carlo study");
}

/// Adds a note on how many errors get a proposed tolerance (proposed_tolerances()) that is larger than their size in
/// the study.
void add_extrapolation_note(std::vector<std::string>& notes, const StoredResult& result,
                            const ResponseTolerances& tolerances) {
  const std::vector<std::span<const double>> lists = proposed_tolerances(tolerances);
  std::size_t count = 0;
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    const double studied = result.factor_sigma[p] * (1.0 + 1e-9);
    const auto larger = [&](std::span<const double> list) { return std::isfinite(list[p]) && list[p] > studied; };
    count += std::ranges::any_of(lists, larger) ? 1U : 0U;
  }
  if (count == 0) return;
  notes.push_back(
      fmt::format("{} of {} a tolerance larger than the sigma of the study: it extrapolates beyond the size "
                  "studied. Confirm it by a Monte Carlo study: errors that act with the square of their "
                  "size make it too loose",
                  count, counted(result.factors.size(), "error has", count == 1 ? "errors has" : "errors have")));
}

std::vector<std::string> notes(const StoredResult& result, const ResponseTolerances& tolerances) {
  std::vector<std::string> list;
  if (!tolerances.limit) add_reference_notes(list, result, tolerances);
  add_limit_notes(list, result, tolerances);
  add_bound_note(list, result, tolerances);
  add_distribution_note(list, result);
  add_extrapolation_note(list, result, tolerances);
  if (!tolerances.negligible.empty()) list.push_back(negligible_text(result, tolerances));
  if (!tolerances.caveat.empty()) list.push_back(tolerances.caveat);
  list.push_back(fmt::format(
      "index: scatter of the response per scatter of the error; low, high: its {:.3g} % interval; "
      "tolerances are counted from it as published; share: of what the errors add to the mean square of the "
      "response over samples and poses, the quantity that a limit limits, at the size the study sets",
      100.0 * sensitivity_of(result).conf_level));
  return list;
}

/// The columns of the table of tolerances. Keeps references to both arguments.
std::vector<FilledColumn> columns(const StoredResult& result, const ResponseTolerances& tolerances) {
  const std::size_t r = tolerances.response;
  const Result& found = sensitivity_of(result);
  const auto tolerance = [&result](std::string name, std::string heading, const std::vector<double>& values) {
    return FilledColumn{number_column(std::move(name), std::move(heading)), [&result, &values](std::size_t p) {
                          return tolerance_cell(values[p], display(result.factors[p]));
                        }};
  };
  std::vector<FilledColumn> list{
      name_column(result.factors, "error"),
      {text_column("kind", "kind", 4),
       [&](std::size_t p) { return text_cell(error_kind(dimension_of(result.factors[p].unit))); }},
      {number_column("limb", "limb", "", 3), [&](std::size_t p) { return count_cell(found.limb(p)); }}};
  if (!tolerances.limit) {
    list.push_back(tolerance("equal_effect", "equal effect", tolerances.all.equal_effect));
  } else {
    list.push_back(tolerance("limit_equal_effect", "limit, equal effect", tolerances.limit->equal_effect));
    list.push_back(tolerance("limit_equal_tolerance", "limit, equal tolerance", tolerances.limit->equal_tolerance));
  }
  list.push_back(unit_column(result.factors));
  list.push_back(index_column(result, found.global, r, "index", "index"));
  list.push_back(index_column(result, found.global_ci_low, r, "index_low", "low", 2));
  list.push_back(index_column(result, found.global_ci_high, r, "index_high", "high", 2));
  list.push_back({percent_column("mean_square_share", "share", 1),
                  [&](std::size_t p) { return percent_cell(tolerances.all.mean_square_share[p]); }});
  return list;
}

Bars tolerance_bars(const StoredResult& result, const Tolerances& found, ArrayPool& pool) {
  std::vector<std::string> units;
  std::vector<double> shown;
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    units.push_back(unit_text(result.factors[p]));
    shown.push_back(found.equal_effect[p] / display(result.factors[p]).si);
  }
  return error_bars(result, {share_quantity("share of the mean square that the study's sizes cause",
                                            "mean_square_share", found.mean_square_share, pool),
                             {"tolerance of equal effect", {units}, pool.add("equal_effect", shown)}});
}

}  // namespace

void set_references(const Study& study, Result& found) {
  const ModelDescription& model = study.model();
  found.limb = Array<std::uint64_t, axis::Factor>({found.factors()});
  for (std::size_t p = 0; p < found.factors(); ++p) {
    found.limb(p) = model.factors[study.analysis.factors[p].value].limb;
  }
  found.reference = Array<std::optional<ReferenceError>, axis::Response>({found.responses()});
  found.mean_square_bound = Array<double, axis::Response>({found.responses()});
  for (std::size_t r = 0; r < found.responses(); ++r) {
    found.mean_square_bound(r) = model.responses[r].mean_square_bound;
    found.reference(r) = reference_for(study, found, r);
  }
}

void write_tolerance_group(ResultBuilder& result, const Study& study, const Result& found) {
  const std::vector<double> sigma = standard_deviations(study);
  const std::vector<double> mean = stated_means(study);
  ToleranceGroup group;
  group.kind = group.unit = Array<std::string, axis::Factor>({found.factors()});
  const auto factor = [&](std::size_t p) -> const Factor& {
    return study.model().factors[study.analysis.factors[p].value];
  };
  for (std::size_t p = 0; p < found.factors(); ++p) {
    group.kind(p) = error_kind(factor(p).dimension);
    group.unit(p) = unit_of(factor(p));
  }
  group.equal_effect = group.mean_square_share = group.rms_effect = Indices(found.global.lengths());
  group.background_rms = Array<double, axis::Response>({found.responses()});
  ReferenceColumns references{Array<std::string, axis::Response>({found.responses()}),
                              Array<double, axis::Response>({found.responses()}, kNaN)};
  for (std::size_t r = 0; r < found.responses(); ++r) {
    const Tolerances all = response_tolerances(found, sigma, mean, r, found.reference(r));
    std::ranges::copy(all.equal_effect, group.equal_effect.row(r).begin());
    std::ranges::copy(all.mean_square_share, group.mean_square_share.row(r).begin());
    std::ranges::transform(all.mean_square.effects, group.rms_effect.row(r).begin(),
                           [](double effect) { return std::sqrt(effect); });
    group.background_rms(r) = std::sqrt(all.mean_square.background);
    if (!all.reference) continue;
    references.factor(r) = factor(all.reference->factor).name;
    references.tolerance(r) = all.reference->tolerance;
  }
  write_group(result, kToleranceGroup, group);
  write_fields(result, "/tolerances", kIndexFields, found);
  write_fields(result, "/tolerances", kStudyFields, found);
  write_fields(result, "/tolerances", kReferenceFields, references);
}

void read_tolerance_group(const h5::File& file, const std::vector<NamedUnit>& factors, Result& found) {
  read_fields(file, "/tolerances", kStudyFields, found);
  ReferenceColumns references;
  read_fields(file, "/tolerances", kReferenceFields, references);
  found.reference = Array<std::optional<ReferenceError>, axis::Response>(references.factor.lengths());
  for (std::size_t r = 0; r < found.reference.size(); ++r) {
    const std::string& name = references.factor(r);
    if (name.empty()) continue;
    const std::size_t factor =
        position_in(factors, name, "its reference error is none of its factors", &NamedUnit::name);
    found.reference(r) = ReferenceError{factor, references.tolerance(r)};
  }
}

ResponseTolerances stored_tolerances(const StoredResult& result, std::size_t response) {
  const Result& found = sensitivity_of(result);
  return {response,
          response_tolerances(found, result.factor_sigma, result.factor_mean, response, found.reference(response)),
          std::nullopt};
}

void append_tolerance_tables(CsvTables& tables, const StoredResult& result) {
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    CsvTable table = lines_of_factors(result, "tolerances_" + result.responses[r].name);
    table.columns.push_back({"angular", [&](std::size_t p) {
                               return to_number(dimension_of(result.factors[p].unit) == Dimension::angle);
                             }});
    table.columns.push_back(list_column("limb", sensitivity_of(result).limb));
    const auto heading = [](const std::string& name, const std::string& unit, const char*) {
      return with_unit(name, unit);
    };
    append_tolerance_columns(table, result, stored_tolerances(result, r), heading);
    tables.push_back(std::move(table));
  }
}

std::string write_tolerances(const std::string& folder, const StoredResult& result,
                             const ResponseTolerances& tolerances) {
  make_folder(folder);
  CsvTable table = lines_of_factors(result, "tolerances");
  const std::string& response_unit = result.responses[tolerances.response].unit;
  const auto unit = [&](std::size_t p) { return result.factors[p].unit; };
  table.more = {{"kind", [&](std::size_t p) { return std::string(error_kind(dimension_of(unit(p)))); }},
                {"limb", [&](std::size_t p) { return std::to_string(sensitivity_of(result).limb(p)); }},
                {"unit", unit},
                {"display_unit", [&](std::size_t p) { return std::string(display(result.factors[p]).name); }},
                {"index_unit", [&](std::size_t p) { return response_unit + "/" + unit(p); }},
                {"studied_as", [&](std::size_t p) { return result.factor_distribution[p]; }}};
  const auto heading = [](const std::string& name, const std::string&, const char* suffix) { return name + suffix; };
  append_tolerance_columns(table, result, tolerances, heading);
  return write_csv(folder, table);
}

Table tolerance_table(const StoredResult& result, const ResponseTolerances& tolerances) {
  Table table{.name = "tolerances",
              .caption = fmt::format("Tolerances for {}: standard deviations of normal errors",
                                     result.responses[tolerances.response].name),
              .columns = {},
              .notes = notes(result, tolerances)};
  fill(table, positions(result.factors.size()), columns(result, tolerances));
  return table;
}

void add_tolerance_section(const StoredResult& result, Page& page) {
  Section& section = page.add_section("tolerances", "How tight must each be");
  const std::size_t response = response_named(result, default_ranking(result));
  const std::string& name = result.responses[response].name;
  if (!sensitivity_of(result).reference(response)) {
    section.paragraph(fmt::format("No error has an effect on {}, so nothing can be said about tolerances.", name));
    return;
  }
  ResponseTolerances found = stored_tolerances(result, response);
  found.caveat = wrong_sizes_text(result, found);
  section.paragraph(fmt::format(
      "Tolerances, as standard deviations of normal errors, with which every error has the same effect on {}: the "
      "tighter one, the more its error matters. They are counted from a reference, and all may be multiplied by one "
      "number. 'poesy tolerances' with --limit gives those that keep {} below a limit, and studies that confirm them.",
      name, name));
  add_figure(page, section, "tolerances", tolerance_bars(result, found.all, page.figures.pool),
             fmt::format(
                 "What each error adds to the mean square of {} over samples and poses, and its tolerance of equal "
                 "effect; {}.",
                 name,
                 mixed_units(result.factors) ? "the largest share first, for tolerances in mm and in deg do not compare"
                                             : "the largest first"));
  section.table(tolerance_table(result, found));
}

}  // namespace poesy::sensitivity
