#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/run_options.h"
#include "engine/study/plan.h"

namespace poesy {

/// Draws of a cell that are solved at both sizes, and as many with the opposite sign: the first ones of the study,
/// or all if it has fewer.
inline constexpr std::size_t kLinearityDraws = 16;

/// The second size, as a multiple of the study's.
inline constexpr double kSmallerSize = 0.1;

/// How the global indices of a sensitivity study change when its errors are a tenth as large, [R x P]: index at a tenth
/// over index at the study's sizes, less 1. Both are of the same draws, the first of the study and their mirror images,
/// over the same poses (run/evaluate_unit.h), and by the published estimator: 0 to rounding where a response is linear
/// in the error or the norm of something linear, -0.9 where it is quadratic. Mirror images, because without them a term
/// of second order beside one of first order changes the index of a few draws by chance; errors are symmetric
/// (random/distribution.h). The errors of the background keep their sizes. A draw that does not count at one size
/// counts at neither. An index that is rounding (stats/rounding.h) is 0; NaN where both are, or one is not known.
///
/// On all ranks of a team, as the run functions do it, with the same result on each; the same bits for any number of
/// threads. Keeps no state of its own: a run that was stopped here and is continued begins this again. Empty when
/// stopped. Precondition: a plan of a sensitivity study.
std::optional<std::vector<double>> index_changes(const Plan& plan, const Model& model, const RunOptions& options);

/// Solves that index_changes makes.
double index_change_solves(const Plan& plan);

}  // namespace poesy
