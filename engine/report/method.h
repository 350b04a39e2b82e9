#pragma once

#include <string>

#include "engine/report/report_kind.h"
#include "engine/result/result_file.h"

namespace poesy {

/// A paragraph on the method for a paper, with the numbers of this result: program, mechanism, errors, poses, samples,
/// metric, solves, limits, seed and hash. Facts that the study does not state are left out. kind: the result's kind.
std::string method_text(const ReportKind& kind, const StoredResult& result);

/// What a paper that uses this result should cite, as BibTeX: the program with its version and commit.
std::string method_references(const StoredResult& result);

}  // namespace poesy
