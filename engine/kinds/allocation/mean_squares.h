#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/run_options.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy {

/// What the mean squares of limited responses are at some errors, and how they change with the errors' variances. A row
/// is a limit at a pose, limit by limit: L rows, P errors that vary.
struct MeanSquares {
  std::vector<double> value;  ///< [L] SI squared
  std::vector<double> slope;  ///< [L x P] by the variance of each error, >= 0
};

/// How many draws of all errors tell what an error does among the others.
inline constexpr std::size_t kDrawsAmongOthers = 64;

/// The mean squares at the plan's errors.
///
/// An error e of mean mu and standard deviation sigma adds y(mu + sigma)^2 / 2 + y(mu - sigma)^2 / 2 - y(0)^2 to a mean
/// square, which is exact where y is linear in e, or the norm of something linear. Alone, with all others zero, it adds
/// its own effect o; among the first `draws` draws of the others it adds t on average. Where errors work together in
/// pairs, t - o is its part in these pairs, each of which belongs to two errors. So
///
///     value = y(0)^2 + sum of (o + t) / 2,     slope = t / sigma^2,
///
/// without noise where errors do not work together, and with draws = 0, where t = o. A sample that is not solved counts
/// as ten times the limit where the error is alone, and is left out among others. On all ranks of a team, the same bits
/// for any number of threads. Empty when stopped.
std::optional<MeanSquares> mean_squares(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                        std::size_t draws, const RunOptions& options);

/// Solves that mean_squares makes.
std::uint64_t mean_square_solves(const Plan& plan, std::size_t draws);

}  // namespace poesy
