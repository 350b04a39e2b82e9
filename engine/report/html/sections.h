#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/report/report_kind.h"

/// The sections that results of all kinds have; `kind` is that of the result, or of both.
namespace poesy {

/// What a reader of this result must not miss, a sentence or two each: content that was changed, samples that did not
/// converge, where they are many (report/solves.h), and where they are, errors and poses without a solved sample,
/// intervals that are wide or were not reached, poses close to singular ones, a first-order fidelity, a commit with
/// changes of its own.
std::vector<std::string> warnings(const ReportKind& kind, const ReportedResult& result);

/// A pose with a larger condition number is called ill-conditioned; a study refuses those above 1e8.
inline constexpr double kIllConditioned = 1e4;

/// The section that comes first: what the responses are, in words. Files of older versions do not say it; then nothing
/// is added.
void add_responses(const StoredResult& result, Page& page);

/// The section that has every error and every pose coordinate with its unit and what it is, where the file says it;
/// figures say it as well, where a reader points at a name.
void add_glossary(const StoredResult& result, Page& page);

/// The section that tells what was not solved: how solves ended, which rows and poses have how many that did not
/// converge, and the listed failures with the commands that replay them.
void add_outcomes(const ReportKind& kind, const ReportedResult& result, Page& page);

/// The section that tells what was run, of one result, or of two side by side: what differs, and folded what does not.
void add_what_was_run(const ReportKind& kind, std::span<const ReportedResult> results, Page& page);

/// "A" and "B" of two results.
inline constexpr std::string_view kLetters[] = {"A", "B"};

}  // namespace poesy
