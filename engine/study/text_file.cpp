#include "engine/study/text_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "engine/base/text.h"

namespace poesy {
namespace {

[[noreturn]] void unreadable(const std::string& path, int reason) {
  throw FileError(path, "cannot be read: " + std::generic_category().message(reason),
                  "check the path and its permissions");
}

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

constexpr std::size_t kMostCsvBytes = std::size_t{1} << 31;

/// What a mode says; empty for a plain file.
std::string_view other_of(mode_t mode) {
  switch (mode & S_IFMT) {
    case S_IFDIR:
      return "a folder";
    case S_IFIFO:
      return "a FIFO";
    case S_IFCHR:
    case S_IFBLK:
      return "a device";
    case S_IFSOCK:
      return "a socket";
    default:
      return {};
  }
}

void expect_plain(const std::string& path, std::string_view what, std::string_view other) {
  if (other.empty()) return;
  throw InputError({path}, "is " + std::string(other) + ", not a " + std::string(what), "name a file");
}

/// Opens without waiting, and looks at what was opened: the path may have become another file's. Reading does not wait
/// either, as for the next message of /proc/kmsg, which looks like a plain file.
File open_plain(const std::string& path, std::string_view what) {
  expect_plain(path, what, other_than_file(path));
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) unreadable(path, errno);
  File file(::fdopen(descriptor, "rb"));
  if (!file) {
    const int reason = errno;
    ::close(descriptor);
    unreadable(path, reason);
  }
  struct stat opened {};
  if (::fstat(descriptor, &opened) != 0) unreadable(path, errno);
  expect_plain(path, what, other_of(opened.st_mode));
  return file;
}

}  // namespace

std::string_view other_than_file(const std::string& path) {
  struct stat there {};
  return ::stat(path.c_str(), &there) == 0 ? other_of(there.st_mode) : std::string_view();
}

std::string read_text(const std::string& path, std::string_view what, std::size_t most_bytes) {
  const File file = open_plain(path, what);
  std::string text;
  std::array<char, 65536> part{};
  while (const std::size_t bytes = std::fread(part.data(), 1, part.size(), file.get())) {
    text.append(part.data(), bytes);
    if (text.size() > most_bytes) {
      throw InputError(
          {path}, "has more than the " + std::to_string(most_bytes) + " bytes a " + std::string(what) + " may have",
          "name another file");
    }
  }
  if (std::ferror(file.get()) != 0) unreadable(path, errno);
  return text;
}

CsvLines::CsvLines(const std::string& path, std::string_view what)
    : path_(path), text_(read_text(path, what, kMostCsvBytes)), rest_(text_) {
  if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  rest_.remove_suffix(rest_.size() - (rest_.find_last_not_of(" \t\r\n") + 1));
  if (rest_.empty()) throw InputError({path_, 1, 1}, "the file is empty", "write the column names in the first line");
}

std::vector<CsvCell> CsvLines::next() {
  const std::size_t line_end = std::min(rest_.find('\n'), rest_.size());
  std::string_view line = rest_.substr(0, line_end);
  rest_.remove_prefix(std::min(line_end + 1, rest_.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  ++line_;
  if (const std::size_t semicolon = line.find(';'); semicolon != std::string_view::npos) {
    throw InputError({path_, line_, semicolon + 1},
                     "columns are separated by semicolons, but poesy reads commas and decimal points",
                     "save the table with commas between columns and points in numbers");
  }
  std::vector<CsvCell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::string_view text = trimmed(line.substr(begin, end - begin));
    const auto column = text.empty() ? begin : static_cast<std::size_t>(text.data() - line.data());
    cells.push_back({text, {path_, line_, column + 1}});
    begin = end + 1;
  }
  return cells;
}

}  // namespace poesy
