#pragma once

#include <string>
#include <vector>

#include "engine/report/report_kind.h"
#include "engine/result/result_file.h"

namespace poesy {

/// The distributions and sizes with which the errors of a result were drawn. Examples: "linear: distribution = normal,
/// sigma = 0.02 mm" if the study sets sizes only by dimension, "24 normal with standard deviations of 0.002 to 0.02 mm"
/// if zones, overrides or measured parts set some of them. If the kind of study chose the sizes itself, the result is
/// StudyWords::drawn. words: the texts of the result's kind.
std::vector<std::string> drawn_sizes(const StoredResult& result, const StudyWords& words);

/// How many errors the table of given machines states, and how many are drawn; empty if there is no such table.
std::string given_errors_text(const StoredResult& result);

/// The seed of the samples that the result shows; empty if no errors are drawn.
std::string seed_text(const StoredResult& result, const StudyWords& words);

}  // namespace poesy
