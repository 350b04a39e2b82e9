#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/sensitivity/tolerances.h"
#include "engine/model/model.h"
#include "engine/report/table.h"
#include "engine/result/result_file.h"
#include "engine/run/run_options.h"
#include "engine/study/plan.h"

/// Whether the indices of a sensitivity study hold for errors of other sizes: each run finds it, its result says it.
namespace poesy {

/// Draws of a cell that are solved at both sizes, and as many with the opposite sign: the first ones of the study,
/// or all if it has fewer.
inline constexpr std::size_t kLinearityDraws = 16;

/// The second size, as a multiple of the study's.
inline constexpr double kSmallerSize = 0.1;

/// How the global indices of a sensitivity study change when its errors are a tenth as large: index at a tenth over
/// index at the study's sizes, less 1. Both are of the same draws, the first of the study and their mirror images, over
/// the same poses (run/evaluate_unit.h), and by the published estimator: 0 to rounding where a response is linear in
/// the error or the norm of something linear, -0.9 where it is quadratic. Mirror images, because without them a term of
/// second order beside one of first order changes the index of a few draws by chance; errors are symmetric
/// (random/distribution.h). The errors of the background keep their sizes. A draw that does not count at one size
/// counts at neither. An index that is rounding (stats/indices.h) is 0; NaN where both are, or one is not known.
///
/// On all ranks of a team, as the run functions do it, with the same result on each; the same bits for any number of
/// threads. Keeps no state of its own: a run that was stopped here and is continued begins this again. Empty when
/// stopped. Precondition: a plan of a sensitivity study.
std::optional<SensitivityResult::Indices> index_changes(const Plan& plan, const Model& model,
                                                        const RunOptions& options);

/// Solves that index_changes makes.
double index_change_solves(const Plan& plan);

/// By which share the index changes where the error is a tenth as large, for a percent_column.
Cell change_cell(double change);

/// The errors that have an effect on the response and whose index changes with size, the largest change first.
std::vector<std::size_t> changing_errors(const StoredResult& result, std::size_t response);

/// For how many of the errors that have an effect the response's index holds, and for which not, the largest change
/// first: "the index on gap holds at a tenth of the size, within 2 %: 15 of 25 errors with an effect; not for
/// epsilon_3_4_z (-99.1 %), ...". unnamed: errors that are counted there and not named.
std::string index_change_text(const StoredResult& result, std::size_t response,
                              std::span<const std::size_t> unnamed = {});

/// What negligible errors add to a mean square together is at most this share of it.
inline constexpr double kNegligible = 1e-3;

/// The errors whose index on the response changes with size although it does not matter: at the size studied each adds
/// at most kNegligible / P of `added` to the response's mean square, with P the number of all errors. So their
/// tolerance may be the size studied, and their index at other sizes is not needed.
std::vector<std::size_t> negligible_errors(const StoredResult& result, std::size_t response,
                                           const MeanSquare& mean_square, double added);

/// Which errors are negligible and have the size studied, for a note; empty where none are.
std::string negligible_text(const StoredResult& result, const ResponseTolerances& tolerances);

/// Beyond this ratio to the size studied, in either direction, a tolerance is of another size.
inline constexpr double kSameSize = 2.0;

/// Which errors have an index that changes with size and a tolerance of another size than what was studied, by either
/// way to share a limit, and at which size to study them: "2 errors have an index on gap that changes with size, by so
/// much at a tenth of it, and a tolerance of another size than was studied: epsilon_3_4_z (-99.1 %; study it at 0.02
/// deg), ...", the largest change first, ten at the most. The size is where the tolerance will be about the size, if
/// the index grows with a power of it. Empty where there is none.
std::string wrong_sizes_text(const StoredResult& result, const ResponseTolerances& tolerances);

}  // namespace poesy
