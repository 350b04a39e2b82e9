#include "engine/result/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/storage/file_writer.h"

namespace poesy {
namespace {

std::string cell(double value) {
  constexpr double kLongest = 1e15;
  if (std::isnan(value)) return "NaN";
  return std::abs(value) < kLongest && value == std::trunc(value) ? fmt::format("{:.0f}", value) : shortest(value);
}
std::string cell(std::int64_t value) { return std::to_string(value); }
std::string cell(std::uint64_t value) { return std::to_string(value); }
std::string cell(const Number& number) {
  return std::visit([](auto value) { return cell(value); }, number);
}

/// The units of these things, each unit once, in the order of the things, joined by "or".
template <class UnitName>
std::string units_of(const std::vector<NamedUnit>& things, const UnitName& unit_name) {
  std::vector<std::string> seen;
  std::string text;
  for (const NamedUnit& thing : things) {
    const std::string unit(unit_name(thing));
    if (std::ranges::find(seen, unit) != seen.end()) continue;
    text += (seen.empty() ? "" : " or ") + unit;
    seen.push_back(unit);
  }
  return text;
}

std::string line_of_names(const CsvTable& table) {
  std::string text = csv_cell(table.first.heading);
  for (const CsvText& more : table.more) text += "," + csv_cell(more.heading);
  for (const CsvColumn& column : table.columns) text += "," + csv_cell(column.heading);
  for (std::size_t m = 0; m < table.at_poses.poses; ++m) {
    text += "," + csv_cell(with_unit("pose_" + std::to_string(m), table.at_poses.unit));
  }
  if (!table.last.heading.empty()) text += "," + csv_cell(table.last.heading);
  for (const CsvText& one : table.rest) text += "," + csv_cell(one.heading);
  return text + "\n";
}

std::string line_text(const CsvTable& table, std::size_t line) {
  std::string text = csv_cell(table.first.text(line));
  for (const CsvText& more : table.more) text += "," + csv_cell(more.text(line));
  for (const CsvColumn& column : table.columns) text += "," + cell(column.number(line));
  for (std::size_t m = 0; m < table.at_poses.poses; ++m) text += "," + cell(table.at_poses.number(line, m));
  if (!table.last.heading.empty()) text += "," + csv_cell(table.last.text(line));
  for (const CsvText& one : table.rest) text += "," + csv_cell(one.text(line));
  return text + "\n";
}

}  // namespace

std::string csv_cell(std::string_view text) {
  std::string cell = printable_line(text);
  if (!formula_sign(cell).empty() && !parse_number(cell)) cell.insert(0, 1, '\'');
  if (cell.find_first_of(",;\"") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit == "1" ? name : name + " [" + unit + "]";
}

std::string write_csv(const std::string& folder, const CsvTable& table) {
  constexpr std::size_t kChunk = 1 << 20;
  const std::string path = (std::filesystem::path(folder) / (table.name + ".csv")).string();
  FileWriter writer(path);
  std::string text = line_of_names(table);
  for (std::size_t line = 0; line < table.lines; ++line) {
    if (table.has && !table.has(line)) continue;
    text += line_text(table, line);
    if (text.size() < kChunk) continue;
    writer.write(text);
    text.clear();
  }
  writer.write(text);
  writer.commit();
  return path;
}

std::string si_units(const std::vector<NamedUnit>& things) {
  return units_of(things, [](const NamedUnit& thing) { return thing.unit; });
}

std::string display_units(const std::vector<NamedUnit>& things) {
  return units_of(things, [](const NamedUnit& thing) { return display(thing).name; });
}

std::string csv_unit(const std::string& unit, const StoredResult& result, const NamedUnit* response) {
  if (unit == kFactorUnit) return si_units(result.factors);
  if (unit == kLengthPerFactorUnit) return "m per " + si_units(result.factors);
  if (response == nullptr) return unit;
  if (unit == kIndexUnit) return response->unit + " per " + si_units(result.factors);
  return unit == kResponseUnit ? response->unit : unit;
}

CsvTable lines_of_factors(const StoredResult& result, std::string name) {
  const auto text = [&result](std::size_t p) { return result.factors[p].name; };
  return {std::move(name), {"factor", text}, result.factors.size()};
}

CsvTable lines_of_poses(const StoredResult& result, std::string name) {
  const auto text = [](std::size_t m) { return std::to_string(m); };
  return {std::move(name), {"pose", text}, result.poses.size()};
}

}  // namespace poesy
