#include "engine/kinds/sensitivity/fidelity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/sensitivity/figures.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/display.h"
#include "engine/stats/indices.h"

namespace poesy::sensitivity {
namespace {

/// A standard deviation of a response below this number, SI, may be rounding of the solver. It is kIndexRounding times
/// an error of 1e-3 (1 mm or 1 mrad).
constexpr double kSpreadRounding = 1e-13;

/// The results at two fidelities, with the dimensions of the responses and the standard deviations of the errors.
struct BothFidelities {
  const Result& first;
  const Result& second;
  std::span<const Dimension> dimensions;
  std::span<const double> sigma;

  bool is_rounding(std::size_t factor, double index) const {
    return index < kIndexRounding || index * sigma[factor] < kSpreadRounding;
  }

  /// The effect of an error: its largest index over all responses of the same dimension as `response`. NaN if an index
  /// is unknown.
  double effect(const Result& result, std::size_t response, std::size_t factor) const {
    double largest = 0.0;
    for (std::size_t r = 0; r < result.responses(); ++r) {
      const double index = result.global(r, factor);
      if (dimensions[r] != dimensions[response]) continue;
      if (std::isnan(index)) return kNaN;
      largest = std::max(largest, index);
    }
    return largest;
  }

  /// How much an error shifts a response: the mean of the response minus the response to the background alone.
  static double growth(const Result& result, std::size_t response, std::size_t factor, std::size_t pose) {
    return result.mean(response, factor, pose) - result.background(response, pose);
  }

  /// The root mean square over the poses of the change of mean and spread between the fidelities, divided by the
  /// error's standard deviation.
  double change(std::size_t response, std::size_t factor) const {
    double sum = 0.0;
    for (std::size_t m = 0; m < first.poses(); ++m) {
      const double of_mean = growth(first, response, factor, m) - growth(second, response, factor, m);
      const double of_std = first.std(response, factor, m) - second.std(response, factor, m);
      sum += of_mean * of_mean + of_std * of_std;
    }
    return std::sqrt(sum / static_cast<double>(first.poses())) / sigma[factor];
  }

  /// Whether both results have the same number of samples of the error that count in statistics, for each response at
  /// each pose.
  bool same_samples(std::size_t factor) const {
    for (std::size_t r = 0; r < first.responses(); ++r) {
      if (!std::ranges::equal(first.count.row(r, factor), second.count.row(r, factor))) return false;
    }
    return true;
  }
};

/// The denominator of the ratios for one error and response: the effect of the error at the first fidelity. If this
/// effect is rounding: NaN if the effect at the second fidelity is rounding too, otherwise 0.
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
    {{"global", &Fidelity::global, kIndexUnit, "Global index by the second fidelity"},
     {"discrepancy", &Fidelity::discrepancy, kIndexUnit,
      "Global index by the second fidelity - global index by the first (/sensitivity/global)"},
     {"relative_discrepancy", &Fidelity::relative_discrepancy, "1",
      "discrepancy over the error's effect: its largest global index by the first fidelity on any response of the same "
      "dimension; infinity where only the second fidelity has an effect, NaN where neither has"},
     {"nonlinearity", &Fidelity::nonlinearity, "1",
      "Root mean square over the poses of hypot(change of the mean over the background, change of the standard "
      "deviation) / sigma(error), over the error's effect as in relative_discrepancy"},
     {"linear", &Fidelity::linear, "1",
      "1: for errors of the study's size no response's nonlinearity or relative discrepancy is above the attribute "
      "linearity of /fidelity; 0: one is, or the comparison is incomplete"},
     {"not_converged", &Fidelity::not_converged, "1", "Samples that the second fidelity did not solve"}}};

using Measure = FidelityResult::Indices;

/// The response for which this measure of an error has the largest magnitude; none if no value is known.
std::optional<std::size_t> largest(const Measure& measure, std::size_t factor) {
  std::optional<std::size_t> found;
  for (std::size_t r = 0; r < measure.length<axis::Response>(); ++r) {
    const double value = std::abs(measure(r, factor));
    if (!std::isnan(value) && (!found || value > std::abs(measure(*found, factor)))) found = r;
  }
  return found;
}

/// Extends the list `columns` by two columns: the value of the measure with the largest magnitude over the responses,
/// in percent, and the response that has this value. Keeps references to the result and the measure.
void add_largest(std::vector<FilledColumn>& columns, const StoredResult& result, const Measure& measure,
                 const std::string& name, int dispensable) {
  const auto value = [&measure](std::size_t p) {
    const auto at = largest(measure, p);
    return at ? measure(*at, p) : kNaN;
  };
  columns.push_back({percent_column(name, name), [value](std::size_t p) {
                       return std::isinf(value(p)) ? text_cell("no effect") : percent_cell(value(p));
                     }});
  columns.push_back(
      {text_column(name + "_response", "largest for", dispensable), [&result, &measure, value](std::size_t p) {
         if (std::isinf(value(p))) return text_cell("by the first");
         const auto at = largest(measure, p);
         return text_cell(at ? result.responses[*at].name : "");
       }});
}

std::string verdict(const FidelityResult& found, std::size_t factor) {
  if (found.linear(factor) == 0) return "not linear";
  return largest(found.nonlinearity, factor) ? "linear" : "no effect";
}

std::vector<std::string> fidelity_notes(const FidelityResult& found) {
  const auto not_linear = std::ranges::count(found.linear, std::uint8_t{0});
  std::vector<std::string> list{
      fmt::format("{} of {} errors are not linear: they differ by more than {:.3g} %, at the size the study sets",
                  not_linear, found.linear.size(), 100.0 * found.linearity),
      "discrepancy: of the index, in percent of the error's largest; nonlinearity: of mean and spread, in percent of "
      "its largest effect"};
  const auto failed = std::accumulate(found.not_converged.begin(), found.not_converged.end(), std::uint64_t{0});
  if (failed > 0) {
    list.push_back(
        fmt::format("{} at fidelity \"{}\" did not converge", counted(failed, "solve", "solves"), found.fidelities[1]));
  }
  return list;
}

/// The largest magnitude of the measure over the responses, for each error; NaN if no value is known.
std::vector<double> largest_magnitudes(const Measure& measure) {
  std::vector<double> list;
  for (std::size_t p = 0; p < measure.length<axis::Factor>(); ++p) {
    const auto at = largest(measure, p);
    list.push_back(at ? std::abs(measure(*at, p)) : kNaN);
  }
  return list;
}

}  // namespace

FidelityResult compare_fidelities(const Result& first, const Result& second, std::span<const Dimension> dimensions,
                                  std::span<const double> sigma, double linearity) {
  POESY_EXPECTS(first.mean.lengths() == second.mean.lengths());
  POESY_EXPECTS(dimensions.size() == first.responses() && sigma.size() == first.factors());
  const BothFidelities both{first, second, dimensions, sigma};
  FidelityResult result;
  result.linearity = linearity;
  result.global = second.global;
  for (Measure* measure : {&result.discrepancy, &result.relative_discrepancy, &result.nonlinearity}) {
    *measure = Measure(first.global.lengths());
  }
  result.linear = Array<std::uint8_t, axis::Factor>({first.factors()});
  for (std::size_t p = 0; p < first.factors(); ++p) result.linear(p) = both.same_samples(p) ? 1 : 0;
  for (std::size_t r = 0; r < first.responses(); ++r) {
    for (std::size_t p = 0; p < first.factors(); ++p) {
      const double base = ratio_base(both, r, p);
      const double discrepancy = second.global(r, p) - first.global(r, p);
      const double relative = discrepancy / base;
      const double nonlinearity = both.change(r, p) / base;
      result.discrepancy(r, p) = discrepancy;
      result.relative_discrepancy(r, p) = relative;
      result.nonlinearity(r, p) = nonlinearity;
      const bool is_small = std::abs(relative) <= linearity && nonlinearity <= linearity;
      if (std::isnan(discrepancy) || (!std::isnan(base) && !is_small)) result.linear(p) = 0;
    }
  }
  result.not_converged = Array<std::uint64_t, axis::Factor, axis::Pose>(second.solves.lengths());
  std::ranges::transform(second.solves, result.not_converged.begin(), &SolveCounts::not_converged);
  return result;
}

void write_fidelity(ResultBuilder& result, const std::optional<FidelityResult>& found) {
  if (!found) return;
  write_group(result, kFidelity, *found);
  result.file().set_attribute("/fidelity", "fidelities", std::span(found->fidelities));
}

std::optional<FidelityResult> read_fidelity(const h5::File& file) {
  if (!file.exists("/fidelity")) return std::nullopt;
  FidelityResult found;
  found.fidelities = file.attribute<std::string>("/fidelity", "fidelities");
  if (found.fidelities.size() != 2) throw h5::Error("it does not compare two fidelities");
  read_group(file, kFidelity, found);
  return found;
}

void append_fidelity_tables(CsvTables& tables, const StoredResult& result) {
  const Result& first = sensitivity_of(result);
  if (!first.fidelity) return;
  const Fidelity& found = *first.fidelity;
  CsvTable table = lines_of_factors(result, "fidelity");
  table.columns.push_back(list_column("linear", found.linear));
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    const auto heading = [&](const std::string& name, const std::string& unit) {
      return with_unit(response.name + "_" + name, csv_unit(unit, result, &response));
    };
    table.columns.push_back(list_column(heading(found.fidelities[0], kIndexUnit), first.global.row(r)));
    for (const FieldRow<Fidelity>& field : kFidelity.fields) {
      if (field.axes != Measure::axis_names()) continue;
      const std::string& name = field.name == "global" ? found.fidelities[1] : field.name;
      table.columns.push_back(field_row_column(heading(name, field.unit), field, found, r));
    }
  }
  tables.push_back(std::move(table));
  const FieldRow<Fidelity>& failed = kFidelity.fields.back();
  tables.push_back(cell_table(result, "fidelity_" + failed.name, failed, found));
}

Table fidelity_table(const StoredResult& result, const RankedErrors& ranked) {
  const FidelityResult& found = *sensitivity_of(result).fidelity;
  Table table{.name = "fidelity",
              .caption = fmt::format("Fidelity \"{}\" against \"{}\" on the same draws", found.fidelities[1],
                                     found.fidelities[0]),
              .columns = {},
              .notes = fidelity_notes(found),
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
                  found.fidelities[0], found.fidelities[1], 100.0 * found.linearity));
  ArrayPool& pool = page.figures.pool;
  add_figure(
      page, section, "fidelity",
      error_bars(result, {share_quantity("nonlinearity: change of mean and scatter", "nonlinearity",
                                         largest_magnitudes(found.nonlinearity), pool),
                          share_quantity("discrepancy of the indices", "discrepancy",
                                         largest_magnitudes(found.relative_discrepancy), pool)}),
      "How far the fidelities are apart, the largest of all responses, in percent of the error's largest effect.");
  section.table(tables, "fidelity");
}

}  // namespace poesy::sensitivity
