#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/report/report_kind.h"
#include "engine/result/result_file.h"

namespace poesy {

/// The distributions and sizes with which the errors of a result were drawn. Examples: "linear: distribution = normal,
/// sigma = 0.02 mm" if the study sets sizes only by dimension, "24 normal with standard deviations of 0.002 to 0.02 mm"
/// if zones, overrides or measured parts set some of them. Returns StudyWords::drawn if the kind of study chose the
/// sizes itself. words: the texts of the kind of study.
std::vector<std::string> drawn_sizes(const StoredResult& result, const StudyWords& words);

/// A text with the number of errors that errors.machines gives, and the number that is drawn; empty if the study has no
/// errors.machines.
std::string given_errors_text(const StoredResult& result);

/// Returns true if a machine draws this error anew at each pose. error: index of the error in the result.
bool is_drawn_per_pose(const StoredResult& result, std::size_t error);

/// The seed with which the errors of the result were drawn, as text; empty if no errors are drawn.
std::string seed_text(const StoredResult& result, const StudyWords& words);

}  // namespace poesy
