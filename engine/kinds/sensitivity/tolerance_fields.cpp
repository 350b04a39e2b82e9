#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/nan.h"
#include "engine/files/result_parts.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/options.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/kinds/sensitivity/stored.h"
#include "engine/kinds/sensitivity/tolerance_files.h"

namespace poesy {
namespace {

/// /tolerances, for programs that know no other group.
struct ToleranceGroup {
  double conf_level = 0.0;
  std::vector<std::string> kind;            ///< [P] "linear" or "angular"
  std::vector<std::uint64_t> limb;          ///< [P]
  std::vector<std::string> unit;            ///< [P]
  std::vector<double> index;                ///< [R x P]
  std::vector<double> index_ci_low;         ///< [R x P]
  std::vector<double> index_ci_high;        ///< [R x P]
  std::vector<double> equal_effect;         ///< [R x P]
  std::vector<double> mean_square_share;    ///< [R x P]
  std::vector<double> rms_effect;           ///< [R x P]
  std::vector<double> background_rms;       ///< [R]
  std::vector<std::string> reference;       ///< [R] names; empty where there is none
  std::vector<double> reference_tolerance;  ///< [R] NaN where there is none
  std::vector<double> mean_square_bound;    ///< [R] Response::mean_square_bound
};

const std::vector<Attribute<ToleranceGroup>> kIndexLevel{{"conf_level", &ToleranceGroup::conf_level}};

/// What is read back.
const Fields<ToleranceGroup> kReadFields{
    {"limb", &ToleranceGroup::limb, kByFactor, "1", "Limb of the error, from 1"},
    {"reference_factor", &ToleranceGroup::reference, kByResponse, "1",
     "The error from which equal_effect is counted; empty when no error has an effect"},
    {"reference_tolerance", &ToleranceGroup::reference_tolerance, kByResponse, "SI: unit of reference_factor",
     "Tolerance of reference_factor"},
    {"mean_square_bound", &ToleranceGroup::mean_square_bound, kByResponse, "1",
     "To first order, the mean square of all errors together is at most this times the sum of those of each error "
     "alone; 1: they add exactly",
     "mean_square_bound"}};

/// What follows from other groups, and is for other programs alone.
const Group<ToleranceGroup> kToleranceGroup{
    "/tolerances",
    "Tolerances from the indices; a tolerance is the standard deviation of a normal error",
    {},
    {},
    {{"kind", &ToleranceGroup::kind, kByFactor, "1", "Kind of the error: linear or angular"},
     {"unit", &ToleranceGroup::unit, kByFactor, "1", "SI unit of the error and of its tolerance"},
     {"index", &ToleranceGroup::index, kByResponseFactor, kIndexUnit,
      "Global sensitivity index as published, /sensitivity/global: tolerances are counted from it"},
     {"index_ci_low", &ToleranceGroup::index_ci_low, kByResponseFactor, kIndexUnit,
      "Lower end of the interval of index", "", kIndexLevel},
     {"index_ci_high", &ToleranceGroup::index_ci_high, kByResponseFactor, kIndexUnit,
      "Upper end of the interval of index", "", kIndexLevel},
     {"equal_effect", &ToleranceGroup::equal_effect, kByResponseFactor, "SI: factor unit, see /tolerances/unit",
      "Tolerance that gives every error the reference's effect: index(reference) / index x reference_tolerance (Du et "
      "al. 2022, Section 6.3, Table 10); infinity: no effect on its own; NaN: unknown"},
     {"mean_square_share", &ToleranceGroup::mean_square_share, kByResponseFactor, "1",
      "Share of what all errors add to the response's mean square over samples and poses, with sigma as set in the "
      "study: (rms_effect x sigma)^2 over its sum; NaN: unknown"},
     {"rms_effect", &ToleranceGroup::rms_effect, kByResponseFactor, kIndexUnit,
      "Growth of the response's mean square over samples and poses per tolerance^2, square root of it: mean square = "
      "background_rms^2 + sum of (rms_effect x tolerance)^2"},
     {"background_rms", &ToleranceGroup::background_rms, kByResponse, kResponseUnit,
      "Root mean square over the poses of the response with all varied errors zero"}}};

/// The study's reference, or the error of smallest effect at one unit of those in which people read it.
std::optional<ReferenceError> reference_for(const Study& study, const SensitivityResult& found, std::size_t response) {
  const std::vector<FactorIndex>& factors = study.analysis.factors;
  if (const auto& chosen = asked_of<SensitivityOptions>(study.analysis).reference) {
    const auto at = std::ranges::find(factors, chosen->factor);
    return ReferenceError{static_cast<std::size_t>(at - factors.begin()), chosen->tolerance};
  }
  const std::vector<double> sigma = standard_deviations(study);
  const auto smallest = smallest_effect(response_study(found, sigma, response).index, sigma);
  if (!smallest) return std::nullopt;
  return ReferenceError{*smallest, display_unit(study.model().factors[factors[*smallest].value].dimension).si};
}

void append_response(ToleranceGroup& group, const Study& study, const SensitivityResult& found, std::size_t r) {
  const std::vector<double> sigma = standard_deviations(study);
  const Tolerances all = response_tolerances(found, sigma, r, reference_for(study, found, r));
  const auto append = [](std::vector<double>& list, const std::vector<double>& more) {
    list.insert(list.end(), more.begin(), more.end());
  };
  append(group.equal_effect, all.equal_effect);
  append(group.mean_square_share, all.mean_square_share);
  for (const double effect : all.mean_square.effects) group.rms_effect.push_back(std::sqrt(effect));
  group.background_rms.push_back(std::sqrt(all.mean_square.background));
  const auto& reference = all.reference;
  const auto& factors = study.analysis.factors;
  group.reference.push_back(reference ? study.model().factors[factors[reference->factor].value].name : "");
  group.reference_tolerance.push_back(reference ? reference->tolerance : kNaN);
  group.mean_square_bound.push_back(study.model().responses[r].mean_square_bound);
}

/// A list of tolerances in CSV.
struct ToleranceList {
  std::string name;
  std::vector<double> values;  ///< [P] SI
};

std::vector<ToleranceList> lists_of(const ResponseTolerances& tolerances) {
  std::vector<ToleranceList> all{{"equal_effect", tolerances.all.equal_effect}};
  if (tolerances.limit) {
    all.push_back({"limit_equal_effect", tolerances.limit->equal_effect});
    all.push_back({"limit_equal_tolerance", tolerances.limit->equal_tolerance});
  }
  return all;
}

/// The numbers of each error. heading(name, unit, suffix): of a column; the suffix is "_display" for the units people
/// read.
template <class Heading>
void append_tolerance_columns(CsvTable& table, const StoredResult& result, const ResponseTolerances& tolerances,
                              const Heading& heading) {
  const SensitivityResult& found = sensitivity_of(result);
  const std::size_t first = tolerances.response * found.factors;
  const std::string index_unit = csv_unit(kIndexUnit, result, &result.responses[tolerances.response]);
  table.columns.push_back(list_column(heading("index", index_unit, ""), found.global, first));
  table.columns.push_back(list_column(heading("index_ci_low", index_unit, ""), found.global_ci_low, first));
  table.columns.push_back(list_column(heading("index_ci_high", index_unit, ""), found.global_ci_high, first));
  table.columns.push_back(
      {"mean_square_share", [shares = tolerances.all.mean_square_share](std::size_t p) { return shares[p]; }});
  table.columns.push_back({"index_change", [&found, first](std::size_t p) {
                             return found.index_change.empty() ? kNaN : found.index_change[first + p];
                           }});
  const std::vector<ToleranceList> lists = lists_of(tolerances);
  for (const ToleranceList& list : lists) {
    table.columns.push_back({heading(list.name, si_units(result.factors), ""),
                             [values = list.values](std::size_t p) { return values[p]; }});
  }
  for (const ToleranceList& list : lists) {
    table.columns.push_back(
        {heading(list.name, display_units(result.factors), "_display"),
         [&result, values = list.values](std::size_t p) { return values[p] / display(result.factors[p]).si; }});
  }
}

}  // namespace

void add_tolerances(ResultBuilder& result, const Study& study, const SensitivityResult& found) {
  ToleranceGroup group;
  group.conf_level = found.conf_level;
  group.index = found.global;
  group.index_ci_low = found.global_ci_low;
  group.index_ci_high = found.global_ci_high;
  for (const FactorIndex index : study.analysis.factors) {
    const Factor& factor = study.model().factors[index.value];
    group.kind.emplace_back(error_kind(factor.dimension));
    group.unit.push_back(unit_of(factor));
    group.limb.push_back(factor.limb);
  }
  for (std::size_t r = 0; r < found.responses; ++r) append_response(group, study, found, r);
  write_group(result, kToleranceGroup, group);
  write_fields(result, "/tolerances", kReadFields, group);
}

void read_tolerances(const h5::File& file, const std::vector<NamedUnit>& factors, StoredSensitivity& found) {
  if (!file.exists("/tolerances")) return;
  ToleranceGroup group;
  read_fields(file, "/tolerances", kReadFields, group);
  found.factor_limb = group.limb;
  found.mean_square_bound = group.mean_square_bound;
  for (std::size_t r = 0; r < group.reference.size(); ++r) {
    const std::string& name = group.reference[r];
    const auto at = std::ranges::find(factors, name, &NamedUnit::name);
    const auto factor = static_cast<std::size_t>(at - factors.begin());
    if (at == factors.end() && !name.empty()) throw h5::Error("its reference error is none of its factors");
    const ReferenceError reference{factor, group.reference_tolerance[r]};
    found.tolerance_reference.push_back(name.empty() ? std::nullopt : std::optional(reference));
  }
}

bool has_tolerances(const StoredResult& result) {
  const StoredSensitivity& found = sensitivity_of(result);
  return !found.factor_limb.empty() && !found.background.empty();
}

ResponseTolerances stored_tolerances(const StoredResult& result, std::size_t response) {
  const StoredSensitivity& found = sensitivity_of(result);
  return {response, response_tolerances(found, result.factor_sigma, response, found.tolerance_reference[response]),
          std::nullopt};
}

void append_tolerance_tables(CsvTables& tables, const StoredResult& result) {
  if (!has_tolerances(result)) return;
  for (std::size_t r = 0; r < sensitivity_of(result).tolerance_reference.size(); ++r) {
    CsvTable table = lines_of_factors(result, "tolerances_" + result.responses[r].name);
    table.columns.push_back({"angular", [&](std::size_t p) {
                               return dimension_of(result.factors[p].unit) == Dimension::angle ? 1.0 : 0.0;
                             }});
    table.columns.push_back(list_column("limb", sensitivity_of(result).factor_limb));
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
  table.first.heading = "factor,kind,limb,unit,display_unit,index_unit,studied_as";
  table.first.text = [&](std::size_t p) {
    const NamedUnit& factor = result.factors[p];
    const std::string shape = result.factor_distribution.empty() ? "unknown" : result.factor_distribution[p];
    return fmt::format("{},{},{},{},{},{}/{},{}", factor.name, error_kind(dimension_of(factor.unit)),
                       sensitivity_of(result).factor_limb[p], factor.unit, display(factor).name,
                       result.responses[tolerances.response].unit, factor.unit, shape);
  };
  const auto heading = [](const std::string& name, const std::string&, const char* suffix) { return name + suffix; };
  append_tolerance_columns(table, result, tolerances, heading);
  return write_csv(folder, table);
}

}  // namespace poesy
