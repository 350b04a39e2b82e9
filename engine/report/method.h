#pragma once

#include <string>

#include "engine/report/report_kind.h"
#include "engine/result/result_file.h"

namespace poesy {

/// A paragraph on the method for a paper, with the numbers of this result: program, mechanism, geometry, errors, poses,
/// samples, fidelity, the method of the kind, metric, solves, limits, seed and hash. Facts that the study does not
/// state are left out. kind: the kind of the result. study: the study of the result, by which the text tells where the
/// geometry differs from that of the mechanism; null if the study cannot be read again.
std::string method_text(const ReportKind& kind, const StoredResult& result, const Study* study);

/// What a paper that uses this result should cite, as BibTeX: the program with its version and commit, and the
/// publications behind the method of this kind.
std::string method_references(const ReportKind& kind, const StoredResult& result);

}  // namespace poesy
