#pragma once

#include <span>

#include "engine/base/units.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/html/page.h"
#include "engine/result/result_parts.h"

namespace poesy {

/// Compares two sensitivity results of the same draws at two fidelities of a model. dimensions: [R] of the responses.
/// sigma: [P] standard deviations of the errors, SI. linearity: between 0 and 1.
///
/// All ratios have the error's effect as denominator: its largest global index by the first fidelity, on any response
/// of the same dimension. So an error is not called nonlinear because of a component on which it hardly acts.
///
///     discrepancy           global of the second - global of the first
///     relative_discrepancy  discrepancy / effect
///     nonlinearity          root mean square over the poses of hypot(m1 - m2, s1 - s2) / sigma, over effect
///
/// with m the mean, less the response to the background alone, and s the standard deviation of the response.
/// Nonlinearity includes a shift of the mean, where a second-order effect shows that hardly changes the spread. It is
/// at most the root mean square difference of the samples themselves.
///
/// An error is linear if no response has a nonlinearity or a magnitude of relative discrepancy above `linearity`. An
/// effect below 1e-10 in SI, or one with a spread below 1e-13 in SI, is rounding. If the first fidelity has only
/// rounding, the ratios are NaN if the second has only rounding too, and infinite otherwise. An error is also called
/// nonlinear if an index is not known, or if the two fidelities solved different numbers of samples, because linearity
/// was not shown. A verdict holds for errors of the study's size; larger ones may be nonlinear. The names of the
/// fidelities are left empty.
FidelityResult compare_fidelities(const SensitivityResult& first, const SensitivityResult& second,
                                  std::span<const Dimension> dimensions, std::span<const double> sigma,
                                  double linearity);

/// Writes the second fidelity of a result, /fidelity; nothing if the study compares none.
/// @{
void write_fidelity(ResultBuilder& result, const std::optional<FidelityResult>& found);
std::optional<FidelityResult> read_fidelity(const h5::File& file);
/// @}
/// Adds fidelity.csv and fidelity_not_converged.csv.
void append_fidelity_tables(CsvTables& tables, const StoredResult& result);

/// The table of the largest discrepancy of the two fidelities and the verdict, with the errors in this order.
/// Precondition: the study compares two.
Table fidelity_table(const StoredResult& result, const RankedErrors& ranked);
/// Adds the section of a report if the study compares two fidelities.
void add_fidelity_section(const StoredResult& result, std::span<const Table> tables, Page& page);

}  // namespace poesy
