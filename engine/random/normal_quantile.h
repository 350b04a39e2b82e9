#pragma once

#include <span>

namespace poesy {

/// The value below which a share u of a normal with standard deviation sigma lies, to a few units in the last place.
/// Precondition: 0 < u < 1. Odd about u = 1/2, to the bit wherever 1 - u is exact.
double normal_quantile(double sigma, double u);

/// Replaces each share by its normal_quantile, bit for bit the same on every instruction set. Shares must be inside
/// (0, 1); the fewer of them below 2^-54, the faster.
void normal_quantiles(double sigma, std::span<double> shares);

}  // namespace poesy
