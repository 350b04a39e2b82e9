#pragma once

#include <string>
#include <string_view>

namespace poesy::app {

/// Whether a path ends in ".pdf".
bool is_pdf(const std::string& path);

/// Whether this program wrote the PDF at a path, or the file is empty, so that it may be replaced.
bool is_pdf_report(const std::string& path);

/// Prints an HTML page that needs no other file to a PDF with Chromium: the first of "chromium", "chromium-browser" and
/// "google-chrome" on PATH. The file appears complete or not at all. Returns whether it was printed; false after an
/// interrupt. Throws InputError, which says how to print by hand, if no browser is on PATH; FileError if the browser
/// fails.
bool write_pdf(const std::string& path, std::string_view page);

}  // namespace poesy::app
