#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/kinds/machine_calibration.h"
#include "engine/model/model.h"
#include "engine/run/run_options.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy {

/// The mean squares of limited responses about their centres (RelativeLimits), and their derivatives with respect to
/// the variances of the errors. L rows: one for each limit at each pose, limit by limit. P errors vary.
struct MeanSquares {
  std::vector<double> value;  ///< [L] mean squares, SI squared
  std::vector<double> slope;  ///< [L x P] derivative with respect to the variance of each error, >= 0
  std::vector<double> room;   ///< [L] RelativeLimits::room, SI; the root mean square is compared with it
};

/// The usual number of draws of the other errors, in which the effect of each error is measured.
inline constexpr std::size_t kDrawsAmongOthers = 64;

/// Measures the mean squares at the plan's errors.
///
/// An error e of mean mu and standard deviation sigma adds y(mu + sigma)^2 / 2 + y(mu - sigma)^2 / 2 - y(c)^2 to the
/// mean square of a response y. Its centre c is a stated mean, or 0. The formula is exact if y is linear in e, or the
/// norm of a linear function. Let o be this sum with all other errors at their centres, and t its average over the
/// first `draws` draws of the other errors. If errors interact in pairs, t - o is what the interactions of this error
/// add. Each interaction belongs to two errors, so half of it is counted for each:
///
///     value = y(c)^2 + sum of (o + t) / 2,     slope = t / sigma^2,
///
/// without noise where errors do not interact, and with draws = 0, where t = o. Of a limit on a spread y is the
/// response less its mean over the poses, and t = o always. A sample that is not solved counts as ten times the limit
/// where the error is alone, and is left out among others. The result has the same bits for any number of threads and
/// on all ranks. Empty when stopped.
///
/// With a calibration, y is what it leaves of these errors when it measures without noise, and draws must be 0. The
/// noise of each measured value adds to a mean square as an error of its standard deviation does, without a slope.
std::optional<MeanSquares> mean_squares(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                        std::size_t draws, const RunOptions& options,
                                        const MachineCalibration* calibration = nullptr);

/// The number of solves that mean_squares() makes.
std::uint64_t mean_square_solves(const Plan& plan, std::size_t draws);

}  // namespace poesy
