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

/// Checks whether the indices of a sensitivity study also hold for errors of other sizes. Each run of a sensitivity
/// study makes this check, and its result states the outcome.
namespace poesy::sensitivity {

/// The number of draws of each error that are solved again to check linearity, at up to kSomePoses poses
/// (run/evaluate_unit.h), at the study's size and at a tenth of it. They are the first draws of the study, or all if
/// there are fewer. Their mirror images, with opposite signs, are solved as well.
inline constexpr std::size_t kLinearityDraws = 16;

/// The smaller size at which draws are solved again, as a multiple of the study's size.
inline constexpr double kSmallerSize = 0.1;

/// The relative change of each global index if the errors are a tenth as large: the index at a tenth of the size,
/// divided by the index at the study's size, minus 1. Both indices are by the published estimator, over the same poses
/// (run/evaluate_unit.h), and from the same draws: the first of the study and their mirror images. Mirror images are
/// used because errors are symmetric (random/distribution.h); without them, a second-order term in addition to a
/// first-order one would change the index of a few draws by chance. The change is 0 up to rounding if the response is
/// linear in the error, or the norm of a linear function. It is -0.9 if the response is quadratic. Errors of the
/// background keep their sizes. A draw that does not count in statistics (counts()) at one size is left out at both. An
/// index that is rounding (stats/indices.h) counts as 0. The change is NaN if both indices are rounding, or if one is
/// unknown.
///
/// All ranks run this function and have the same result, with the same bits for any number of threads. It has no
/// checkpoint: if a run is stopped during this function, a continued run calls it again from the start. Returns nothing
/// if the run was stopped. Precondition: the plan is that of a sensitivity study.
std::optional<Result::Indices> index_changes(const Plan& plan, const Model& model, const RunOptions& options);

/// The number of solves that index_changes() makes.
double index_change_solves(const Plan& plan);

/// A table cell with the relative change of an index if the error is a tenth as large (index_changes()), for a
/// percent_column().
Cell change_cell(double change);

/// The errors that have an effect on the response and whose index changes with size, the largest change first.
std::vector<std::size_t> changing_errors(const StoredResult& result, std::size_t response);

/// The text that replaces a statement on other sizes if the samples were solved to first order.
inline constexpr std::string_view kSizesNotTested =
    "solved to first order in the errors, so it is not tested whether indices hold at other sizes";

/// A text on the errors with an effect. It states for how many of them the index on the response holds at a tenth of
/// the size, and names those for which it does not hold, the largest change first: "the index on gap holds at a tenth
/// of the size, within 2 %: 15 of 25 errors with an effect; not for epsilon_3_4_z (-99.1 %), ...". unnamed: errors that
/// are counted but not named. If the samples were solved to first order, the text is kSizesNotTested, followed by the
/// names.
std::string index_change_text(const StoredResult& result, std::size_t response,
                              std::span<const std::size_t> unnamed = {});

/// The largest share of a mean square that all negligible errors together may cause.
inline constexpr double kNegligible = 1e-3;

/// The errors whose index on the response changes with size, but whose effect is negligible: at the studied size, such
/// an error adds at most kNegligible / P of `added` to the response's mean square, where P is the number of all errors.
/// added: how much all errors together may add to it. A negligible error may have the studied size as its tolerance, so
/// its index at other sizes is not needed.
std::vector<std::size_t> negligible_errors(const StoredResult& result, std::size_t response,
                                           const MeanSquare& mean_square, double added);

/// A note that names the negligible errors, which get the studied size as tolerance; empty if there are none.
std::string negligible_text(const StoredResult& result, const ResponseTolerances& tolerances);

/// A tolerance differs much from the studied size if their ratio is above this number or below its inverse.
inline constexpr double kSameSize = 2.0;

/// A text on the errors whose index changes with size and that get a tolerance which differs much from the studied size
/// (kSameSize). With a limit, an error has two tolerances, one of equal effect and one equal to those of other errors.
/// The text names for each error the size at which to study it: "2 errors have an index on gap that changes with size,
/// by so much at a tenth of it, and a tolerance of another size than was studied: epsilon_3_4_z (-99.1 %; study it at
/// 0.02 deg), ...". At most ten errors are named, the largest change first. If the index is a power of the size, a
/// study at the named size proposes about that size as the tolerance. Empty if there are no such errors.
std::string wrong_sizes_text(const StoredResult& result, const ResponseTolerances& tolerances);

}  // namespace poesy::sensitivity
