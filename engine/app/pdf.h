#pragma once

#include <string>
#include <string_view>

namespace poesy::app {

/// Whether a path ends in ".pdf", in any case of letters.
bool is_pdf(const std::string& path);

/// The browser that prints: "chromium", "chromium-browser" or "google-chrome" on PATH, the first of them. Throws
/// InputError, which says how to print without one, where there is none. path: of the PDF, for the message.
std::string printing_browser(const std::string& path);

/// Whether this program wrote the PDF at a path, or what stands there is empty: then it may be replaced.
bool is_pdf_report(const std::string& path);

/// How printing ended.
enum class Printed { whole, interrupted };

/// Prints an HTML page that needs no other file to a PDF, by a browser of printing_browser, without a window. The file
/// appears whole or not at all. An interrupt ends the browser. Throws FileError where the browser fails or takes more
/// than two minutes.
Printed write_pdf(const std::string& path, std::string_view page, const std::string& browser);

}  // namespace poesy::app
