#pragma once

#include <string>
#include <string_view>

namespace poesy::app {

/// Returns true if a path has the ending of a PDF file.
bool is_pdf(const std::string& path);

/// Returns true if the file at a path may be replaced by a PDF report: this program wrote it, or it is empty.
bool is_pdf_report(const std::string& path);

/// Prints an HTML page to a PDF file. The page must need no other file. Chromium prints it: the first of "chromium",
/// "chromium-browser" and "google-chrome" on PATH. The PDF appears complete or not at all. Returns false if an
/// interrupt stopped the printing. Throws InputError with advice on printing by hand if PATH has no browser. Throws
/// FileError if the browser fails.
bool write_pdf(const std::string& path, std::string_view page);

}  // namespace poesy::app
