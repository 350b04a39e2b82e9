#pragma once

#include <span>

#include "engine/base/units.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/html/page.h"
#include "engine/result/result_parts.h"

namespace poesy {

/// Compares two sensitivity results of the same draws at two fidelities of a model. dimensions: of the responses.
/// sigma: standard deviations of the errors, SI. linearity: between 0 and 1.
///
/// All ratios are of the error's effect: its largest global index, by the first fidelity, on any response of the same
/// dimension. So a component in which the error hardly shows does not make it nonlinear.
///   discrepancy           global of the second - global of the first
///   relative_discrepancy  discrepancy / effect
///   nonlinearity          root mean square over the poses of hypot(m1 - m2, s1 - s2) / sigma, over effect, with m
///                         and s the mean, less the response to the background alone, and the standard deviation of
///                         the response by each. It sees what the indices see, and besides a shift of the mean: that is
///                         where an even, second-order effect shows, which hardly changes the spread. It is never more
///                         than the root mean square difference of the samples themselves.
///
/// An error is linear when no response's nonlinearity or relative discrepancy, as a magnitude, is above `linearity`.
/// An effect below 1e-10 in SI, or which makes a spread below 1e-13 in SI, is rounding. Where the first fidelity has
/// no more, the ratios are NaN and say nothing if the second has no more either, and are infinite if it has.
/// An error with an index that is not known, or with different numbers of solved samples by each fidelity, is not
/// linear: that was not shown. A verdict holds for errors of the study's size; larger ones may be nonlinear. The names
/// of the fidelities are left out.
FidelityResult compare_fidelities(const SensitivityResult& first, const SensitivityResult& second,
                                  std::span<const Dimension> dimensions, std::span<const double> sigma,
                                  double linearity);

/// The second fidelity beside the first in result files: /fidelity, nothing where the study compares none.
/// @{
void write_fidelity(ResultBuilder& result, const std::optional<FidelityResult>& found);
std::optional<FidelityResult> read_fidelity(const h5::File& file);
/// @}
/// fidelity.csv and fidelity_not_converged.csv.
void append_fidelity_tables(CsvTables& tables, const StoredResult& result);

/// The largest discrepancy of the two fidelities and the verdict, with the errors in this order. Precondition: the
/// study compares two.
Table fidelity_table(const StoredResult& result, const RankedErrors& ranked);
/// The section of a report, where the study compares two.
void add_fidelity_section(const StoredResult& result, std::span<const Table> tables, Page& page);

}  // namespace poesy
