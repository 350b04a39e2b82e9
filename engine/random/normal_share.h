#pragma once

#include <span>

namespace poesy {

/// Replaces each value z by the share Phi(z) of a standard normal that lies below it, bit for bit the same on every
/// instruction set. Within 1e-14 of the share, and as exact of what is beyond it, for |z| <= 8.2; others are taken for
/// +-8.2, beyond which no share is drawn. So each is strictly inside (0, 1). Precondition: no NaN.
void normal_shares(std::span<double> values);

}  // namespace poesy
