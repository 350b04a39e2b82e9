#include "engine/app/pdf.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/plain_file.h"
#include "engine/base/text.h"
#include "engine/storage/file_writer.h"

namespace poesy::app {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kPatience(120);
constexpr std::chrono::milliseconds kLook(20);
constexpr std::string_view kPdfMark = "% poesy report\n";  ///< behind a PDF's end, where it is a comment
constexpr const char* kOtherWay = "write the report as REPORT.html, open it in a browser and print it to a PDF there";

/// A new folder for temporary files, removed with all that is in it.
class TemporaryFolder {
 public:
  /// Throws FileError, with the path that is to be written.
  explicit TemporaryFolder(const std::string& path) {
    std::string name = (fs::temp_directory_path() / "poesy-report-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw FileError(path, "cannot be printed: no temporary folder can be made", "set TMPDIR to a folder with room");
    }
    folder_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  std::string operator/(const char* name) const { return (folder_ / name).string(); }

 private:
  fs::path folder_;
};

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// A process of its own group, so that all it has started ends with it.
class Process {
 public:
  /// What it says goes to the file `log`. Throws FileError where no process can be started.
  Process(const std::string& path, std::vector<std::string> words, const std::string& log) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    id_ = ::fork();
    if (id_ < 0) throw FileError(path, "cannot be printed: no process can be started", kOtherWay);
    if (id_ != 0) return;
    ::setpgid(0, 0);
    const int to = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int from = ::open("/dev/null", O_RDONLY);
    ::dup2(from, STDIN_FILENO);
    ::dup2(to, STDOUT_FILENO);
    ::dup2(to, STDERR_FILENO);
    ::execv(arguments.front(), arguments.data());
    ::_exit(127);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    ::kill(-id_, SIGKILL);  // also what it left behind
    if (running_) ::waitpid(id_, nullptr, 0);
  }

  /// How it ended, as of waitpid; none while it runs.
  std::optional<int> ended() {
    int status = 0;
    const pid_t done = ::waitpid(id_, &status, WNOHANG);
    if (done == 0 || (done < 0 && errno == EINTR)) return std::nullopt;
    running_ = false;
    return status;
  }

 private:
  pid_t id_ = -1;
  bool running_ = true;
};

/// Whether a PDF is there from its first line to its last.
bool is_whole(std::string_view pdf) {
  return pdf.starts_with("%PDF-") &&
         pdf.substr(pdf.size() - std::min<std::size_t>(pdf.size(), 1024)).find("%%EOF") != std::string_view::npos;
}

/// The last line that says something.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \n") + 1;
  const std::size_t begin = end == 0 ? 0 : text.rfind('\n', end - 1) + 1;
  return end == 0 ? "nothing" : printable(std::string_view(text).substr(begin, end - begin), 300);
}

/// Of a file, for a browser (RFC 8089): a folder's name may hold # or %.
std::string address_of(const std::string& path) {
  std::string address = "file://";
  for (const char c : path) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                          std::string_view("/._~-").find(c) != std::string_view::npos;
    address += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return address;
}

std::vector<std::string> command(const std::string& browser, const TemporaryFolder& folder) {
  std::vector<std::string> words{browser,
                                 "--headless",
                                 "--disable-gpu",
                                 "--disable-dev-shm-usage",
                                 "--disable-extensions",
                                 "--no-first-run",
                                 "--no-default-browser-check",
                                 "--disable-background-networking",
                                 "--no-pdf-header-footer",
                                 "--print-to-pdf-no-header",
                                 "--user-data-dir=" + folder / "profile",
                                 "--print-to-pdf=" + folder / "report.pdf"};
  if (::geteuid() == 0) words.emplace_back("--no-sandbox");  // Chromium refuses to have one as root
  words.push_back(address_of(folder / "report.html"));
  return words;
}

}  // namespace

bool is_pdf(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; });
  return ending == ".pdf";
}

std::string printing_browser(const std::string& path) {
  const char* folders = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    std::string_view left = folders == nullptr ? "" : folders;
    while (!left.empty()) {
      const std::size_t end = std::min(left.find(':'), left.size());
      const std::string program = (fs::path(left.substr(0, end)) / name).string();
      std::error_code ignored;
      if (end > 0 && fs::is_regular_file(program, ignored) && ::access(program.c_str(), X_OK) == 0) return program;
      left.remove_prefix(std::min(end + 1, left.size()));
    }
  }
  throw InputError({.file = path},
                   "cannot be printed: neither chromium nor chromium-browser nor google-chrome is on PATH", kOtherWay);
}

bool is_pdf_report(const std::string& path) {
  constexpr std::string_view kBegin = "%PDF-";
  const PlainFile file(path);
  const auto has = [&](std::string_view text, std::uintmax_t at) {
    std::string there(text.size(), '\0');
    return file.read(at, std::as_writable_bytes(std::span(there))) && there == text;
  };
  if (!file.is_open()) return false;
  const std::uintmax_t size = file.size();
  return size == 0 ||
         (size >= kBegin.size() + kPdfMark.size() && has(kBegin, 0) && has(kPdfMark, size - kPdfMark.size()));
}

Printed write_pdf(const std::string& path, std::string_view page, const std::string& browser) {
  const std::atomic<bool>& interrupted = catch_interrupts();
  const TemporaryFolder folder(path);
  write_text(folder / "report.html", page);
  Process process(path, command(browser, folder), folder / "log");
  const auto end = std::chrono::steady_clock::now() + kPatience;
  std::optional<int> status;
  while (!(status = process.ended())) {
    if (interrupted) return Printed::interrupted;
    if (std::chrono::steady_clock::now() > end) {
      throw FileError(path, fmt::format("was not written: {} did not print it within {} s", browser, kPatience.count()),
                      kOtherWay);
    }
    std::this_thread::sleep_for(kLook);
  }
  const std::string pdf = contents(folder / "report.pdf");
  if (*status != 0 || !is_whole(pdf)) {
    throw FileError(
        path,
        fmt::format("was not written: {} did not print it and said: {}", browser, last_line(contents(folder / "log"))),
        kOtherWay);
  }
  write_text(path, pdf + std::string(kPdfMark));
  return Printed::whole;
}

}  // namespace poesy::app
