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

namespace poesy::allocation {

/// The mean squares of the limited responses about their centres (RelativeLimits), and their derivatives with respect
/// to the variances of the errors. A row is a limit at a pose; the poses of the first limit come first.
struct MeanSquares {
  std::vector<double> value;  ///< [rows] mean squares, SI squared
  std::vector<double> slope;  ///< [rows x errors] derivative with respect to the variance of each error, >= 0
  std::vector<double> room;   ///< [rows] RelativeLimits::room, SI; the root mean square is compared with it
};

/// The number of draws of all other errors over which the effect of one error is averaged (`draws` of mean_squares()).
/// The first linearisation, and studies that calibrate machines, use 0 draws instead.
inline constexpr std::size_t kDrawsAmongOthers = 64;

/// Measures the mean squares at the plan's errors.
///
/// Let y be a response minus the centre of its limit (RelativeLimits::centre()). An error e of mean mu and standard
/// deviation sigma adds y(mu + sigma)^2 / 2 + y(mu - sigma)^2 / 2 - y(c)^2 to the mean square of y, where the argument
/// of y is e, and all other errors are fixed. The centre c of the error (Distribution::centre()) is mu, but 0 if the
/// values of the error are measured or given in a table. The formula is exact if y is linear in e, or the norm of a
/// linear function. Let o be the value of the formula with all other errors at their centres, and t its average over
/// the first `draws` draws of the other errors. If errors interact in pairs, the interactions of this error add the
/// difference `t - o`. Each interaction belongs to two errors, so half of it is counted for each. Below, y_0 is y with
/// all errors at their centres, and the sum is over the errors:
///
///     value = y_0^2 + sum of (o + t) / 2,     slope = max(0, t) / sigma^2.
///
/// If errors do not interact, or if draws = 0, t = o, so the value has no sampling noise. For a limit on a spread, y is
/// the response minus its mean over the poses, and t equals o. If the mechanism is not solved at one of the three
/// values of e, o is (10 x MeanSquares::room)^2; draws of the other errors for which this happens are left out of t.
/// The result has the same bits for any number of threads and on all ranks. None if the run was stopped.
///
/// With a calibration, y is what remains of the response after a calibration without measurement noise, and `draws`
/// must be 0. The noise of each measured value then adds to MeanSquares::value as an error with the same standard
/// deviation would, but MeanSquares::slope has no entry for it.
std::optional<MeanSquares> mean_squares(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                        std::size_t draws, const RunOptions& options,
                                        const MachineCalibration* calibration = nullptr);

/// The number of solves that mean_squares() makes, without those for the measurement noise of a calibration.
std::uint64_t mean_square_solves(const Plan& plan, std::size_t draws);

}  // namespace poesy::allocation
