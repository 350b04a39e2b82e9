#pragma once

#include <span>

#include "engine/base/units.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/result.h"

namespace poesy {

/// Compares two sensitivity results of the same draws at two fidelities of a model. dimensions: [R] of the responses.
/// sigma: [P] standard deviations of the errors, SI. linearity: between 0 and 1.
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
/// linear: that was not shown. A verdict holds for errors of the study's size; larger ones may be nonlinear.
FidelityResult compare_fidelities(const SensitivityResult& first, const SensitivityResult& second,
                                  std::span<const Dimension> dimensions, std::span<const double> sigma,
                                  double linearity);

}  // namespace poesy
