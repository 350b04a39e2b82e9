#include "engine/app/pdf.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/storage/file_writer.h"

namespace poesy::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPdfMark = "% poesy report\n";  ///< after a PDF's end, where it is a comment
constexpr const char* kOtherWay = "write the report as REPORT.html, open it in a browser and print it to a PDF there";
constexpr int kNoBrowser = 127;  ///< as shells say that a command is not found
/// What a shell does in a folder with the page.
constexpr const char* kPrint = R"sh(
  cd "$POESY_PRINTED" && exec 2>&1 </dev/null || exit 1
  [ "$(id -u)" = 0 ] && sandbox=--no-sandbox  # Chromium refuses to have one as root
  for browser in chromium chromium-browser google-chrome; do
    command -v $browser >/dev/null && exec $browser --headless --disable-gpu --disable-dev-shm-usage --no-first-run \
      $sandbox --user-data-dir=profile --no-pdf-header-footer --print-to-pdf=report.pdf report.html
  done
  exit 127)sh";

/// A new folder for temporary files, removed with all that is in it.
struct TemporaryFolder {
  std::string path = (fs::temp_directory_path() / "poesy-report-XXXXXX").string();
  bool made = ::mkdtemp(path.data()) != nullptr;
  ~TemporaryFolder() {
    std::error_code ignored;
    if (made) fs::remove_all(path, ignored);
  }
};

/// Empty where it cannot be read.
std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

bool is_pdf(const std::string& path) { return path.ends_with(".pdf") || path.ends_with(".PDF"); }

bool is_pdf_report(const std::string& path) {
  std::error_code unknown;
  return fs::is_empty(path, unknown) || contents(path).ends_with(kPdfMark);
}

bool write_pdf(const std::string& path, std::string_view page) {
  const std::atomic<bool>& interrupted = catch_interrupts();
  const TemporaryFolder folder;
  if (!folder.made) throw FileError(path, "was not printed: no temporary folder can be made", "set TMPDIR to another");
  write_text(folder.path + "/report.html", page);
  ::setenv("POESY_PRINTED", folder.path.c_str(), 1);
  std::FILE* browser = ::popen(kPrint, "r");
  if (browser == nullptr) throw FileError(path, "was not printed: no process can be started", kOtherWay);
  std::string said;
  for (int c = std::fgetc(browser); c != EOF; c = std::fgetc(browser)) said += static_cast<char>(c);
  const int status = ::pclose(browser);
  if (interrupted) return false;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNoBrowser) {
    throw InputError({.file = path}, "neither chromium nor chromium-browser nor google-chrome is on PATH", kOtherWay);
  }
  const std::string pdf = contents(folder.path + "/report.pdf");
  if (status != 0 || pdf.find("%%EOF") == std::string::npos) {
    said.resize(said.find_last_not_of(" \n") + 1);
    const std::string last = said.empty() ? "nothing" : printable(said.substr(said.rfind('\n') + 1), 300);
    throw FileError(path, "was not printed: the browser said: " + last, kOtherWay);
  }
  write_text(path, pdf + std::string(kPdfMark));
  return true;
}

}  // namespace poesy::app
