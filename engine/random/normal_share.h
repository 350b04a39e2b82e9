#pragma once

#include <span>

namespace poesy {

/// Replaces each value z by the share Phi(z) of a standard normal below it, with the same bits on every instruction
/// set. The relative error of the share is at most 1e-14 for |z| <= 8.2. Values beyond +-8.2 are clamped, which happens
/// about once in 4e15 draws. So each share is strictly inside (0, 1). Precondition: no NaN.
void normal_shares(std::span<double> values);

}  // namespace poesy
