#pragma once

#include <span>
#include <string>

#include "engine/report/report_kind.h"

namespace poesy {

/// The report of one result, or the comparison of two, as one HTML document that needs no other file: what was run,
/// warnings, figures with their numbers, tables. It reads without JavaScript, which draws the figures alone. Whatever
/// comes from a file is escaped. Throws InputError for two results that have nothing to be compared: different kinds,
/// mechanisms, or neither errors, cases or sources, nor responses in common.
/// Precondition: one result or two; kind is that of the first.
std::string html_report(const ReportKind& kind, std::span<const ReportedResult> results);

}  // namespace poesy
