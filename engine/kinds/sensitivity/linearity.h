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

/// Whether the indices of a sensitivity study hold for errors of other sizes. Each run finds this and its result says
/// it.
namespace poesy {

/// The number of draws of a cell, the first of the study or all if it has fewer, that are solved at both sizes. As many
/// draws with opposite signs are solved too.
inline constexpr std::size_t kLinearityDraws = 16;

/// The second size, as a multiple of the study's.
inline constexpr double kSmallerSize = 0.1;

/// How the global indices of a sensitivity study change if its errors are a tenth as large: the index at a tenth over
/// the index at the study's sizes, less 1. Both are of the same draws, the first of the study and their mirror images,
/// over the same poses (run/evaluate_unit.h), and by the published estimator. The change is 0 to rounding if a response
/// is linear in the error or the norm of a linear function, and -0.9 if it is quadratic. Without mirror images, a term
/// of second order beside one of first order would change the index of a few draws by chance; errors are symmetric
/// (random/distribution.h). The errors of the background keep their sizes. A draw that does not count at one size
/// counts at neither. An index that is rounding (stats/indices.h) is 0; the change is NaN if both are, or if one is not
/// known.
///
/// All ranks run it and have the same result, with the same bits for any number of threads. It keeps no checkpoint, so
/// a run that was stopped here begins it again. Empty when stopped. Precondition: a plan of a sensitivity study.
std::optional<SensitivityResult::Indices> index_changes(const Plan& plan, const Model& model,
                                                        const RunOptions& options);

/// The number of solves that index_changes() makes.
double index_change_solves(const Plan& plan);

/// The relative change of the index if the error is a tenth as large, for a percent_column().
Cell change_cell(double change);

/// The errors that have an effect on the response and an index that changes with size, the largest change first.
std::vector<std::size_t> changing_errors(const StoredResult& result, std::size_t response);

/// For how many of the errors with an effect the response's index holds, and for which it does not, the largest change
/// first: "the index on gap holds at a tenth of the size, within 2 %: 15 of 25 errors with an effect; not for
/// epsilon_3_4_z (-99.1 %), ...". unnamed: errors that are counted but not named.
std::string index_change_text(const StoredResult& result, std::size_t response,
                              std::span<const std::size_t> unnamed = {});

/// The largest share of a mean square that all negligible errors together may add.
inline constexpr double kNegligible = 1e-3;

/// The errors whose index on the response changes with size but is negligible: at the size studied each adds at most
/// kNegligible / P of `added` to the response's mean square, where P is the number of all errors. So their tolerance
/// may be the size studied, and their index at other sizes is not needed.
std::vector<std::size_t> negligible_errors(const StoredResult& result, std::size_t response,
                                           const MeanSquare& mean_square, double added);

/// A note that names the negligible errors, which have the size studied; empty if there are none.
std::string negligible_text(const StoredResult& result, const ResponseTolerances& tolerances);

/// A tolerance whose ratio to the size studied is larger than this, or smaller than its inverse, is of another size.
inline constexpr double kSameSize = 2.0;

/// The errors whose index changes with size and whose tolerance is of another size than was studied, by either way to
/// share a limit, and at which size to study them: "2 errors have an index on gap that changes with size, by so much at
/// a tenth of it, and a tolerance of another size than was studied: epsilon_3_4_z (-99.1 %; study it at 0.02 deg),
/// ...". At most ten, the largest change first. At the named size the tolerance will be about that size, if the index
/// grows with a power of it. Empty if there are none.
std::string wrong_sizes_text(const StoredResult& result, const ResponseTolerances& tolerances);

}  // namespace poesy
