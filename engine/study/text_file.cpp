#include "engine/study/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <functional>
#include <span>
#include <system_error>

#include "engine/base/plain_file.h"
#include "engine/base/text.h"

namespace poesy {
namespace {

[[noreturn]] void unreadable(const std::string& path, int reason) {
  throw FileError(path, "cannot be read: " + std::generic_category().message(reason),
                  "check the path and its permissions");
}

constexpr std::size_t kMostCsvBytes = std::size_t{1} << 31;

/// Throws InputError if the first part of a file is that of an HDF5 file. what: the kind of file for messages.
void refuse_hdf5(const std::string& path, std::string_view first_part, std::string_view what) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  if (!first_part.starts_with(kSignature)) return;
  throw InputError({path}, fmt::format("is an HDF5 file, such as a result of poesy, not a {}", what),
                   fmt::format("give the {} itself", what));
}

/// Throws InputError if a file begins like a spreadsheet or like a text in UTF-16, which spreadsheets also write.
void refuse_other_formats(const std::string& path, std::string_view text) {
  if (text.starts_with("PK\x03\x04")) {
    throw InputError({path}, "is a spreadsheet or another archive, not a CSV file", "export the sheet as CSV");
  }
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    throw InputError({path}, "is a text in UTF-16, which poesy does not read", "save it as CSV in UTF-8");
  }
}

/// The position in the line after a cell in quotes and the blanks that follow it. first: position of the opening quote.
/// Throws InputError at `place` if the quotes are not closed on this line, or if text follows them.
std::size_t quoted_end(std::string_view line, std::size_t first, const Place& place) {
  for (std::size_t at = line.find('"', first + 1); at != std::string_view::npos; at = line.find('"', at + 2)) {
    if (line.substr(at).starts_with("\"\"")) continue;
    const std::size_t next = std::min(line.find_first_not_of(" \t", at + 1), line.size());
    if (next == line.size() || line[next] == ',' || line[next] == ';') return next;
    break;
  }
  throw InputError(place, "this cell begins with a quote, but does not end with one before the next comma or line",
                   "close the quotes, or remove them");
}

/// Throws InputError if the line has a semicolon at the position `begin` or later. place: the beginning of the line.
void refuse_semicolon(std::string_view line, std::size_t begin, const Place& place) {
  const std::size_t semicolon = line.find(';', begin);
  if (semicolon == std::string_view::npos) return;
  throw InputError({place.file, place.line, semicolon + 1},
                   "columns are separated by semicolons, but poesy reads commas and decimal points",
                   "save the table with commas between columns and points in numbers");
}

}  // namespace

std::string read_text(const std::string& path, std::string_view what, std::size_t most_bytes) {
  const PlainFile file(path);
  if (!file.other().empty()) {
    throw InputError({path}, "is " + std::string(file.other()) + ", not a " + std::string(what), "name a file");
  }
  if (!file.is_open()) unreadable(path, file.error());
  std::string text;
  const auto take = [&](std::span<const std::byte> part) {
    const bool is_first = text.empty();
    text.append(reinterpret_cast<const char*>(part.data()), part.size());
    if (is_first) refuse_hdf5(path, text, what);
    if (text.size() > most_bytes) {
      throw InputError(
          {path}, "has more than the " + std::to_string(most_bytes) + " bytes a " + std::string(what) + " may have",
          "name another file");
    }
  };
  if (!file.read_parts(std::ref(take))) unreadable(path, errno);
  return text;
}

CsvLines::CsvLines(const std::string& path, std::string_view what)
    : path_(path), text_(read_text(path, what, kMostCsvBytes)), rest_(text_) {
  refuse_other_formats(path, rest_);
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
  const bool has_tab = trimmed(line).find('\t') != std::string_view::npos;
  if (has_tab && line.find(',') == std::string_view::npos) {
    throw InputError({path_, line_, 1}, "columns are separated by tabs, but poesy reads commas",
                     "save the table with commas between columns");
  }
  std::vector<CsvCell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t first = std::min(line.find_first_not_of(" \t", begin), line.size());
    const bool is_quoted = first < line.size() && line[first] == '"';
    const std::size_t after = is_quoted ? quoted_end(line, first, {path_, line_, first + 1}) : begin;
    const std::size_t end = std::min(line.find(',', after), line.size());
    refuse_semicolon(line.substr(0, end), after, {path_, line_, 1});
    const std::string_view text = trimmed(line.substr(begin, end - begin));
    const auto column = text.empty() ? begin : static_cast<std::size_t>(text.data() - line.data());
    cells.push_back({is_quoted ? unquoted(text) : text, {path_, line_, column + 1}});
    begin = end + 1;
  }
  return cells;
}

std::string_view CsvLines::unquoted(std::string_view cell) {
  cell = cell.substr(1, cell.size() - 2);
  if (cell.find('"') == std::string_view::npos) return cell;
  const auto begin = text_.begin() + (cell.data() - text_.data());
  auto end = begin;
  for (std::size_t n = 0; n < cell.size(); ++n) {
    *end++ = begin[static_cast<std::ptrdiff_t>(n)];
    if (begin[static_cast<std::ptrdiff_t>(n)] == '"') ++n;  // skips the second one of two quotes
  }
  return {cell.data(), static_cast<std::size_t>(end - begin)};
}

}  // namespace poesy
