#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/report/html/page.h"
#include "engine/report/html/report.h"

namespace poesy {

/// A fact about a run with its label: the same labels in the same order for every result.
struct RunFact {
  std::string label;  ///< for people
  std::string text;   ///< "-" where it is not known or does not apply
};

/// How and where the result came into being.
std::vector<RunFact> run_facts(const ReportedResult& result);

/// The section that tells what was run, of one result, or of two side by side: what differs, and folded what does not.
Section what_was_run(std::span<const ReportedResult> results);

/// "A" and "B" of two results.
inline constexpr std::string_view kLetters[] = {"A", "B"};

}  // namespace poesy
