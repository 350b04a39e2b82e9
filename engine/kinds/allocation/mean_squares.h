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

/// The mean squares of the limited responses about the values from which their limits are counted (RelativeLimits), and
/// their derivatives by the variances of the errors. A row is a limit at
/// a pose, limit by limit: L rows, P errors that vary.
struct MeanSquares {
  std::vector<double> value;  ///< [L] SI squared
  std::vector<double> slope;  ///< [L x P] by the variance of each error, >= 0
  std::vector<double> room;   ///< [L] SI; the root mean square that would be the limit (RelativeLimits::room)
};

/// The number of draws that show what an error adds among the others.
inline constexpr std::size_t kDrawsAmongOthers = 64;

/// The mean squares at the plan's errors.
///
/// An error e of mean mu and standard deviation sigma adds y(mu + sigma)^2 / 2 + y(mu - sigma)^2 / 2 - y(c)^2 to a mean
/// square, where c is its centre: a stated mean, or 0. This is exact where y is linear in e, or the norm of a linear
/// function. With all other errors at their centres it adds o; among the first `draws` draws of the others it adds t on
/// average. Where errors interact in pairs, t - o is the error's part of these interactions, each of which is shared by
/// two errors. So
///
///     value = y(c)^2 + sum of (o + t) / 2,     slope = t / sigma^2,
///
/// without noise where errors do not interact, and with draws = 0, where t = o. Of a limit on a spread y is the
/// response less its mean over the poses, and t = o always. A sample that is not solved counts as ten times the limit
/// where the error is alone, and is left out among others. The result has the same bits for any number of threads and
/// on all ranks. Empty when stopped.
std::optional<MeanSquares> mean_squares(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                        std::size_t draws, const RunOptions& options);

/// The number of solves that mean_squares() makes.
std::uint64_t mean_square_solves(const Plan& plan, std::size_t draws);

}  // namespace poesy
