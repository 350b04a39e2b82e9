#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/files/result_file.h"

namespace poesy {

/// What tells a report from other pages; it stands in the first kilobyte of its file.
inline constexpr std::string_view kReportMark = "<meta name=\"generator\" content=\"poesy report\">";

/// A result and the file where it was found, as the reader may name it.
struct ReportedResult {
  StoredResult stored;  ///< what it says
  std::string path;     ///< where it was read from
};

/// The report of one result, or the comparison of two, as one HTML document that needs no other file: what was run,
/// warnings, figures with their numbers, tables. It reads without JavaScript, which draws the figures alone. Whatever
/// comes from a file is escaped. Throws InputError for two results that have nothing to be compared: different kinds,
/// mechanisms, or neither errors, cases or sources, nor responses in common.
/// Precondition: one result or two.
std::string html_report(std::span<const ReportedResult> results);

}  // namespace poesy
