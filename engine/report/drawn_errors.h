#pragma once

#include <string>
#include <vector>

#include "engine/report/report_kind.h"
#include "engine/result/result_file.h"

namespace poesy {

/// The distributions and sizes with which the errors of a result were drawn: "linear: distribution = normal, sigma =
/// 0.02 mm" where [errors] alone sets them, "24 normal with standard deviations of 0.002 to 0.02 mm" where zones,
/// overrides or measured parts do, and what the kind says where it chose the sizes itself. words: of the result's kind.
std::vector<std::string> drawn_sizes(const StoredResult& result, const StudyWords& words);

/// The seed of the samples that the result shows; empty if errors are not drawn.
std::string seed_text(const StoredResult& result, const StudyWords& words);

}  // namespace poesy
