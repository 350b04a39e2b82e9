#include "engine/kinds/sensitivity/fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/sensitivity/figures.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/display.h"
#include "engine/stats/indices.h"

namespace poesy {
namespace {

/// A spread that solvers leave where there is none, SI; with errors of 1e-3, of kIndexRounding.
constexpr double kSpreadRounding = 1e-13;

/// Two results and what belongs to both.
struct BothFidelities {
  const SensitivityResult& first;
  const SensitivityResult& second;
  std::span<const Dimension> dimensions;
  std::span<const double> sigma;

  bool is_rounding(std::size_t factor, double index) const {
    return index < kIndexRounding || index * sigma[factor] < kSpreadRounding;
  }

  /// The error's largest index on a response of the same dimension; NaN when one is not known.
  double effect(const SensitivityResult& result, std::size_t response, std::size_t factor) const {
    double largest = 0.0;
    for (std::size_t r = 0; r < result.responses; ++r) {
      const double index = result.global[r * result.factors + factor];
      if (dimensions[r] != dimensions[response]) continue;
      if (std::isnan(index)) return kNaN;
      largest = std::max(largest, index);
    }
    return largest;
  }

  /// Of the mean, over what the background alone gives.
  static double growth(const SensitivityResult& result, std::size_t response, std::size_t pose, std::size_t cell) {
    return result.mean[cell] - result.background[response * result.poses + pose];
  }

  /// Root mean square over the poses of the change of mean and spread, over sigma.
  double change(std::size_t response, std::size_t factor) const {
    double sum = 0.0;
    for (std::size_t m = 0; m < first.poses; ++m) {
      const std::size_t cell = (response * first.factors + factor) * first.poses + m;
      const double of_mean = growth(first, response, m, cell) - growth(second, response, m, cell);
      const double of_std = first.std[cell] - second.std[cell];
      sum += of_mean * of_mean + of_std * of_std;
    }
    return std::sqrt(sum / static_cast<double>(first.poses)) / sigma[factor];
  }

  /// Whether as many samples of an error count in both, at every pose.
  bool same_samples(std::size_t factor) const {
    for (std::size_t r = 0; r < first.responses; ++r) {
      const auto begin = static_cast<std::ptrdiff_t>((r * first.factors + factor) * first.poses);
      const auto end = begin + static_cast<std::ptrdiff_t>(first.poses);
      if (!std::equal(first.count.begin() + begin, first.count.begin() + end, second.count.begin() + begin)) {
        return false;
      }
    }
    return true;
  }
};

/// What the ratios of one error and response are counted from: NaN where there is nothing, 0 where only the second
/// fidelity has anything.
double ratio_base(const BothFidelities& both, std::size_t response, std::size_t factor) {
  const double effect = both.effect(both.first, response, factor);
  if (!both.is_rounding(factor, effect)) return effect;
  return both.is_rounding(factor, both.effect(both.second, response, factor)) ? kNaN : 0.0;
}

using Fidelity = FidelityResult;

const Group<Fidelity> kFidelity{
    "/fidelity",
    "The model's second fidelity on the same draws, compared with the first, of which all other groups speak",
    {{"linearity", &Fidelity::linearity}},
    {},
    {{"global", &Fidelity::global, kByResponseFactor, kIndexUnit, "Global index by the second fidelity"},
     {"discrepancy", &Fidelity::discrepancy, kByResponseFactor, kIndexUnit,
      "Global index by the second fidelity - global index by the first (/sensitivity/global)"},
     {"relative_discrepancy", &Fidelity::relative_discrepancy, kByResponseFactor, "1",
      "discrepancy over the error's effect: its largest global index by the first fidelity on any response of the same "
      "dimension; infinity where only the second fidelity has an effect, NaN where neither has"},
     {"nonlinearity", &Fidelity::nonlinearity, kByResponseFactor, "1",
      "Root mean square over the poses of hypot(change of the mean over the background, change of the standard "
      "deviation) / sigma(error), over the error's effect as in relative_discrepancy"},
     {"linear", &Fidelity::linear, kByFactor, "1",
      "1: for errors of the study's size no response's nonlinearity or relative discrepancy is above the attribute "
      "linearity of /fidelity; 0: one is, or the comparison is incomplete"},
     {"not_converged", &Fidelity::not_converged, kByFactorPose, "1",
      "Samples that the second fidelity did not solve"}}};

/// The response where a measure [R x P] of an error has its largest magnitude; none where it has no value.
std::optional<std::size_t> largest(const std::vector<double>& measure, std::size_t factor, std::size_t factors) {
  std::optional<std::size_t> found;
  for (std::size_t r = 0; r * factors < measure.size(); ++r) {
    const double value = std::abs(measure[r * factors + factor]);
    if (!std::isnan(value) && (!found || value > std::abs(measure[*found * factors + factor]))) found = r;
  }
  return found;
}

/// The largest value in percent, and the response where it is. Refers to the result and the measure.
void add_largest(std::vector<FilledColumn>& columns, const StoredResult& result, const std::vector<double>& measure,
                 const std::string& name, int dispensable) {
  const auto value = [&result, &measure](std::size_t p) {
    const auto at = largest(measure, p, sensitivity_of(result).factors);
    return at ? measure[*at * sensitivity_of(result).factors + p] : kNaN;
  };
  columns.push_back({percent_column(name, name), [value](std::size_t p) {
                       return std::isinf(value(p)) ? text_cell("no effect") : percent_cell(value(p));
                     }});
  columns.push_back(
      {text_column(name + "_response", "largest for", dispensable), [&result, &measure, value](std::size_t p) {
         if (std::isinf(value(p))) return text_cell("by the first");
         const auto at = largest(measure, p, sensitivity_of(result).factors);
         return text_cell(at ? result.responses[*at].name : "");
       }});
}

std::string verdict(const FidelityResult& found, std::size_t factor) {
  const std::size_t factors = found.linear.size();
  if (found.linear[factor] == 0) return "not linear";
  return largest(found.nonlinearity, factor, factors) ? "linear" : "no effect";
}

std::vector<std::string> fidelity_notes(const StoredResult& result, const FidelityResult& found) {
  const auto not_linear = std::ranges::count(found.linear, std::uint8_t{0});
  std::vector<std::string> list{
      fmt::format("{} of {} errors are not linear: they differ by more than {:.3g} %, at the size the study sets",
                  not_linear, found.linear.size(), 100.0 * found.linearity),
      "discrepancy: of the index, in percent of the error's largest; nonlinearity: of mean and spread, in percent of "
      "its largest effect"};
  const auto failed = std::accumulate(found.not_converged.begin(), found.not_converged.end(), std::uint64_t{0});
  if (failed > 0) {
    list.push_back(fmt::format("{} at fidelity \"{}\" did not converge", counted(failed, "solve", "solves"),
                               sensitivity_of(result).fidelities[1]));
  }
  return list;
}

/// The largest magnitude over the responses of a measure [R x P] of each error; NaN where none is known.
std::vector<double> largest_magnitudes(const std::vector<double>& measure, std::size_t factors) {
  std::vector<double> list(factors, kNaN);
  for (std::size_t at = 0; at < measure.size(); ++at) {
    list[at % factors] = std::fmax(list[at % factors], std::abs(measure[at]));
  }
  return list;
}

}  // namespace

FidelityResult compare_fidelities(const SensitivityResult& first, const SensitivityResult& second,
                                  std::span<const Dimension> dimensions, std::span<const double> sigma,
                                  double linearity) {
  POESY_EXPECTS(first.global.size() == second.global.size() && first.mean.size() == second.mean.size());
  POESY_EXPECTS(dimensions.size() == first.responses && sigma.size() == first.factors);
  const BothFidelities both{first, second, dimensions, sigma};
  FidelityResult result;
  result.linearity = linearity;
  result.global = second.global;
  for (std::size_t p = 0; p < first.factors; ++p) result.linear.push_back(both.same_samples(p) ? 1 : 0);
  for (std::size_t r = 0; r < first.responses; ++r) {
    for (std::size_t p = 0; p < first.factors; ++p) {
      const std::size_t at = r * first.factors + p;
      const double base = ratio_base(both, r, p);
      result.discrepancy.push_back(second.global[at] - first.global[at]);
      result.relative_discrepancy.push_back(result.discrepancy.back() / base);
      result.nonlinearity.push_back(both.change(r, p) / base);
      const bool is_known = !std::isnan(result.discrepancy.back());
      const bool is_small =
          std::abs(result.relative_discrepancy.back()) <= linearity && result.nonlinearity.back() <= linearity;
      if (!is_known || (!std::isnan(base) && !is_small)) result.linear[p] = 0;
    }
  }
  for (const SolveCounts& counts : second.solves) result.not_converged.push_back(counts.not_converged());
  return result;
}

void write_fidelity(ResultBuilder& result, const Study& study, const std::optional<FidelityResult>& found) {
  if (!found) return;
  write_group(result, kFidelity, *found);
  const MechanismChoice& choice = study.mechanism;
  const std::array names{study.model().fidelities[choice.fidelity], study.model().fidelities[choice.compared.value()]};
  result.file().set_attribute("/fidelity", "fidelities", std::span<const std::string>(names));
}

void read_fidelity(const h5::File& file, StoredSensitivity& found) {
  if (!file.exists("/fidelity")) return;
  found.fidelities = file.attribute<std::string>("/fidelity", "fidelities");
  if (found.fidelities.size() != 2) throw h5::Error("it does not compare two fidelities");
  read_group(file, kFidelity, found.fidelity.emplace());
}

void append_fidelity_tables(CsvTables& tables, const StoredResult& result) {
  const StoredSensitivity& first = sensitivity_of(result);
  if (!first.fidelity) return;
  const Fidelity& found = *first.fidelity;
  CsvTable table = lines_of_factors(result, "fidelity");
  table.columns.push_back(list_column("linear", found.linear));
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    const std::size_t begin = r * first.factors;
    const std::string index_unit = csv_unit(kIndexUnit, result, &response);
    table.columns.push_back(
        list_column(with_unit(response.name + "_" + first.fidelities[0], index_unit), first.global, begin));
    for (const FieldRow<Fidelity>& field : kFidelity.fields) {
      if (field.axes != kByResponseFactor) continue;
      const std::string name = field.name == "global" ? first.fidelities[1] : field.name;
      const std::string heading = with_unit(response.name + "_" + name, csv_unit(field.unit, result, &response));
      table.columns.push_back(field_column(heading, field, found, begin));
    }
  }
  tables.push_back(std::move(table));
  for (const FieldRow<Fidelity>& field : kFidelity.fields) {
    if (field.axes == kByFactorPose) tables.push_back(cell_table(result, "fidelity_" + field.name, field, found));
  }
}

Table fidelity_table(const StoredResult& result, const RankedErrors& ranked) {
  const FidelityResult& found = *sensitivity_of(result).fidelity;
  Table table{.name = "fidelity",
              .caption = fmt::format("Fidelity \"{}\" against \"{}\" on the same draws",
                                     sensitivity_of(result).fidelities[1], sensitivity_of(result).fidelities[0]),
              .columns = {},
              .notes = fidelity_notes(result, found),
              .ranked = true};
  std::vector<FilledColumn> columns{rank_column(result, ranked, 3), name_column(result.factors, "error")};
  add_largest(columns, result, found.relative_discrepancy, "discrepancy", 1);
  add_largest(columns, result, found.nonlinearity, "nonlinearity", 2);
  columns.push_back({text_column("verdict", "verdict"), [&](std::size_t p) { return text_cell(verdict(found, p)); }});
  fill(table, ranked.rows, columns);
  return table;
}

void add_fidelity_section(const StoredResult& result, std::span<const Table> tables, Page& page) {
  if (!sensitivity_of(result).fidelity) return;
  const FidelityResult& found = *sensitivity_of(result).fidelity;
  Section& section = page.add_section("linearity", "Is first order enough");
  section.paragraph(
      fmt::format("The study was solved at fidelity \"{}\" and, on the same draws, at \"{}\". An error is linear where "
                  "they differ by no more than {:.3g} % of its largest effect, at the size the study sets.",
                  sensitivity_of(result).fidelities[0], sensitivity_of(result).fidelities[1], 100.0 * found.linearity));
  ArrayPool& pool = page.figures.pool;
  const std::size_t factors = result.factors.size();
  add_figure(
      page, section, "fidelity",
      error_bars(result, {share_quantity("nonlinearity: change of mean and scatter", "nonlinearity",
                                         largest_magnitudes(found.nonlinearity, factors), pool),
                          share_quantity("discrepancy of the indices", "discrepancy",
                                         largest_magnitudes(found.relative_discrepancy, factors), pool)}),
      "How far the fidelities are apart, the largest of all responses, in percent of the error's largest effect.");
  section.table(tables, "fidelity");
}

}  // namespace poesy
