#include "engine/app/pdf.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/storage/file_writer.h"

namespace poesy::app {
namespace {

constexpr std::string_view kPdfMark =
    "% poesy report\n";  ///< comment at the end of the PDF by which poesy recognises it
constexpr const char* kOtherWay = "write the report as REPORT.html, open it in a browser and print it to a PDF there";
/// A shell script that prints report.html in the folder $POESY_PRINTED to report.pdf there. Its exit code is 127 if
/// PATH has no browser.
constexpr const char* kPrint = R"sh(
  cd "$POESY_PRINTED" && exec 2>&1 </dev/null || exit 1
  [ "$(id -u)" = 0 ] && sandbox=--no-sandbox  # Chromium refuses to have one as root
  for browser in chromium chromium-browser google-chrome; do
    command -v $browser >/dev/null && exec $browser --headless --disable-gpu --disable-dev-shm-usage --no-first-run \
      $sandbox --user-data-dir=profile --no-pdf-header-footer --print-to-pdf=report.pdf report.html
  done
  exit 127)sh";

/// A new folder for temporary files, which is removed with its content.
struct TemporaryFolder {
  std::error_code error;
  std::string path = (std::filesystem::temp_directory_path(error) / "poesy-report-XXXXXX").string();
  bool made = !error && ::mkdtemp(path.data()) != nullptr;
  ~TemporaryFolder() {
    if (made) std::filesystem::remove_all(path, error);
  }
};

/// Returns true if a PDF is complete: it has the first line and the end mark.
bool is_whole(const std::string& pdf) {
  constexpr std::size_t kEnd = 1024;  // number of last bytes in which readers of a PDF look for the end mark
  return pdf.starts_with("%PDF-") && pdf.find("%%EOF", std::max(pdf.size(), kEnd) - kEnd) != std::string::npos;
}

}  // namespace

bool is_pdf(const std::string& path) { return path.ends_with(".pdf") || path.ends_with(".PDF"); }

bool is_pdf_report(const std::string& path) {
  const std::optional<std::string> file = content_of(path);
  return file && (file->empty() || (is_whole(*file) && file->ends_with(kPdfMark)));
}

bool write_pdf(const std::string& path, std::string_view page) {
  const std::atomic<bool>& interrupted = catch_interrupts();
  const TemporaryFolder folder;
  if (!folder.made) throw FileError(path, "was not printed: no temporary folder can be made", "set TMPDIR to another");
  write_text(folder.path + "/report.html", page);
  ::setenv("POESY_PRINTED", folder.path.c_str(), 1);
  std::FILE* browser = ::popen(kPrint, "r");
  if (browser == nullptr) throw FileError(path, "was not printed: no process can be started", kOtherWay);
  std::string said = "nothing";
  for (std::array<char, 300> line; std::fgets(line.data(), line.size(), browser) != nullptr;) said = line.data();
  const int status = ::pclose(browser);
  if (interrupted) return false;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    throw InputError({.file = path}, "cannot be printed: neither Chromium nor Chrome is on PATH", kOtherWay);
  }
  const std::string pdf = content_of(folder.path + "/report.pdf").value_or("");
  if (status != 0 || !is_whole(pdf)) {
    throw FileError(path, "was not printed: the browser said: " + said.substr(0, said.find('\n')), kOtherWay);
  }
  write_text(path, pdf + std::string(kPdfMark));
  return true;
}

}  // namespace poesy::app
