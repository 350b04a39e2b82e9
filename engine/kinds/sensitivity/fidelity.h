#pragma once

#include <span>

#include "engine/base/units.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/html/page.h"
#include "engine/result/result_parts.h"

namespace poesy::sensitivity {

/// Compares two sensitivity results of the same draws at two fidelities of a model. dimensions: [responses] dimension
/// of each response. sigma: [errors] standard deviation of each error, SI. linearity: the largest nonlinearity and
/// relative discrepancy of an error that counts as linear, between 0 and 1.
///
/// The denominator of all ratios is the error's effect: its largest global index at the first fidelity, over all
/// responses of the same dimension. Therefore an error is not called nonlinear because of a response on which it hardly
/// acts.
///
///     discrepancy           global index at the second fidelity - global index at the first
///     relative_discrepancy  discrepancy / effect
///     nonlinearity          root mean square over the poses of hypot(m1 - m2, s1 - s2) / sigma, over effect
///
/// Here m is the mean of the response minus the response to the background alone, s is its standard deviation, and 1
/// and 2 are the fidelities. Nonlinearity includes the shift of the mean, because a second-order effect shifts the mean
/// but hardly changes the spread. It is at most the root mean square difference of the samples themselves.
///
/// An error is linear if its nonlinearity and the magnitude of its relative discrepancy are at most `linearity` for all
/// responses. An effect is rounding if it is below 1e-10 in SI, or if the spread that it causes (effect x sigma) is
/// below 1e-13 in SI. If the effect at the first fidelity is rounding, the ratios are NaN if the effect at the second
/// is rounding too, otherwise infinite. An error is not called linear if an index is unknown, or if the two fidelities
/// solved different numbers of samples, because linearity was not shown. A verdict holds for errors of the study's
/// size; larger errors may be nonlinear. The member `fidelities` of the result is left empty.
FidelityResult compare_fidelities(const Result& first, const Result& second, std::span<const Dimension> dimensions,
                                  std::span<const double> sigma, double linearity);

/// Writes and reads the comparison of two fidelities, the group /fidelity of a result file. Writes nothing, and reads
/// nothing, if the study compares no fidelities.
/// @{
void write_fidelity(ResultBuilder& result, const std::optional<FidelityResult>& found);
std::optional<FidelityResult> read_fidelity(const h5::File& file);
/// @}
/// Adds fidelity.csv and fidelity_not_converged.csv to `tables`, if the study compares two fidelities.
void append_fidelity_tables(CsvTables& tables, const StoredResult& result);

/// The table of the largest discrepancy and nonlinearity of each error between the two fidelities, with the verdict
/// whether the error is linear, in the order of `ranked`. Precondition: the study compares two fidelities.
Table fidelity_table(const StoredResult& result, const RankedErrors& ranked);
/// Adds to the page the section on fidelities, if the study compares two.
void add_fidelity_section(const StoredResult& result, std::span<const Table> tables, Page& page);

}  // namespace poesy::sensitivity
