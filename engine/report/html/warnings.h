#pragma once

#include <string>
#include <vector>

#include "engine/report/html/report.h"

namespace poesy {

/// What a reader of this result must not miss, a sentence or two each: content that was changed, samples that did not
/// converge, where they are many (report/not_converged.h), and where they are, errors and poses without a solved
/// sample, intervals that are wide or were not reached, poses close to singular ones, a first-order fidelity, a commit
/// with changes of its own.
std::vector<std::string> warnings(const ReportedResult& result);

/// An interval that reaches further than this share of its index is called wide.
inline constexpr double kWideInterval = 0.10;

/// A pose with a larger condition number is called ill-conditioned; a study refuses those above 1e8.
inline constexpr double kIllConditioned = 1e4;

}  // namespace poesy
