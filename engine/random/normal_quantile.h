#pragma once

#include <span>

namespace poesy {

/// The quantile of a normal with standard deviation sigma at the share u, to a few units in the last place. The values
/// at u and 1 - u differ only in sign; if 1 - u is exact, this holds to the last bit. Precondition: 0 < u < 1.
double normal_quantile(double sigma, double u);

/// Replaces each share by its normal_quantile(), with the same bits on every instruction set. Precondition: shares are
/// inside (0, 1). Shares below kSmallestUniform (stream.h) are slower.
void normal_quantiles(double sigma, std::span<double> shares);

/// The quantile of a normal of standard deviation sigma > 0 that is truncated at +-half_width > 0. It is the quantile
/// of the whole normal at 1/2 + (u - 1/2) p, where p is the share of the whole normal within +-half_width.
/// @{
double truncated_normal_quantile(double sigma, double half_width, double u);
void truncated_normal_quantiles(double sigma, double half_width, std::span<double> shares);
/// @}

}  // namespace poesy
