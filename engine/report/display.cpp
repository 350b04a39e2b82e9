#include "engine/report/display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/stats/indices.h"

namespace poesy {
namespace {

Cell cell(std::string text, double value) {
  return {std::move(text), std::isfinite(value) ? std::optional(value) : std::nullopt};
}

/// A number with its unit: "4.25 mm"; the number alone if the quantity has no unit.
std::string with_unit_text(const std::string& number, const NamedUnit& named) {
  const std::string unit = unit_text(named);
  return unit.empty() ? number : number + " " + unit;
}

std::string readable_quoted(std::string_view quoted) {
  try {
    return readable_text(parse_quantity(quoted), 6);
  } catch (const QuantityError&) {
    return std::string(quoted);
  }
}

/// A word of a setting; a number with so many digits that the last ones are rounding is rounded to 12 digits. So "50
/// um/m" is 5e-05, not 4.9999999999999996e-05.
std::string readable_bare(std::string_view word) {
  constexpr std::size_t kMany = 15;  // more characters are due to rounding of the last digits
  const bool has_rounding = word.size() > kMany && word.find('.') != std::string_view::npos;
  const std::optional<double> number = has_rounding ? parse_number(word) : std::nullopt;
  return number ? number_text(*number, 12) : std::string(word);
}

}  // namespace

std::size_t response_named(const StoredResult& result, std::string_view name) {
  const auto found = std::ranges::find(result.responses, name, &NamedUnit::name);
  return static_cast<std::size_t>(found - result.responses.begin());
}

std::string count_text(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, " ");
  return digits;
}

std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count_text(count), count == 1 ? one : many);
}

std::string number_text(double value, int digits) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}g}", value + 0.0, digits);  // adding 0.0 avoids "-0"
}

std::string percent_number(double share) {
  const double percent = 100.0 * share;
  if (!(percent > 90.0 && percent < 100.0)) return number_text(percent, 3);
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(100.0 - percent))), 1, 12);
  std::string text = fmt::format("{:.{}f}", percent, decimals);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::string percent_text(double share) { return std::isnan(share) ? "-" : percent_number(share) + " %"; }

std::string unit_text(const NamedUnit& named) {
  const std::string_view name = display(named).name;
  return std::string(name == "1" ? "" : name);
}

std::vector<std::string> names_of(const std::vector<NamedUnit>& things) {
  std::vector<std::string> list;
  for (const NamedUnit& thing : things) list.push_back(thing.name);
  return list;
}

std::string some_names(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t n = 0; n < std::min(names.size(), most); ++n) text += (n == 0 ? "" : ", ") + names[n];
  return names.size() > most ? text + fmt::format(" and {} more", names.size() - most) : text;
}

Common common(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  Common both;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const auto at = std::ranges::find(b, a[n]);
    if (at != b.end()) both.emplace_back(n, static_cast<std::size_t>(at - b.begin()));
  }
  return both;
}

std::vector<std::string> only_in(const std::vector<std::string>& these, const std::vector<std::string>& others) {
  std::vector<std::string> list = these;
  std::erase_if(list, [&](const std::string& name) { return std::ranges::find(others, name) != others.end(); });
  return list;
}

std::string verdict_words(const YieldVerdict& yield) {
  switch (yield.decision) {
    case YieldVerdict::Decision::not_asked:
      return "";
    case YieldVerdict::Decision::kept:
      return yield.parts_leave_open() ? "PASS for these measured parts" : "PASS";
    case YieldVerdict::Decision::not_kept:
      return "FAIL";
    case YieldVerdict::Decision::undecided:
      return "UNDECIDED";
  }
  throw std::logic_error("unknown decision on a yield");
}

std::string metric_text(const StoredResult& result) {
  if (result.metric == "platform") {
    return fmt::format("platform, by displacement of {}", counted(result.metric_points.size(), "point", "points"));
  }
  if (result.metric == "stiffness") {
    return std::string(
               "stiffness: equilibrium of the bodies, without masses of limbs and without geometric stiffness") +
           (is_first_order(result) ? "" : "; forces of exact solves are good to two digits");
  }
  if (result.metric == "published") return "published, radians against metres at the base's origin";
  return result.metric;
}

std::string response_text(const NamedUnit& response, double si) {
  return with_unit_text(fmt::format("{:.4g}", si / display(response).si), response);
}

std::string coordinates_text(const StoredResult& result, std::size_t pose) {
  constexpr double kRounding = 1e-12;  // mm or deg; a coordinate below this is rounding error, and is shown as 0
  if (pose >= result.poses.size()) return {};  // a result file may name a pose that does not exist
  std::string text = result.time.empty() ? std::string() : fmt::format("t {} s", number_text(result.time[pose], 4));
  for (std::size_t c = 0; c < result.pose_coordinates.size(); ++c) {
    const NamedUnit& named = result.pose_coordinates[c];
    const double value = result.poses[PoseIndex(pose)][c] / display(named).si;
    const bool is_large = std::abs(value) >= 999.5;  // with three digits, the text would have an exponent
    const std::string number =
        is_large ? fmt::format("{:.0f}", value) : number_text(std::abs(value) < kRounding ? 0.0 : value, 3);
    text += (text.empty() ? "" : ", ") + named.name + " " + with_unit_text(number, named);
  }
  return text;
}

std::string place_text(const StoredResult& result, std::size_t pose) {
  const std::string coordinates = coordinates_text(result, pose);
  return coordinates.empty() ? fmt::format("pose {}", pose) : fmt::format("pose {} ({})", pose, coordinates);
}

Column text_column(std::string name, std::string heading, int dispensable) {
  return {std::move(name), std::move(heading), "", Column::Kind::text, dispensable};
}

Column number_column(std::string name, std::string heading, std::string_view unit, int dispensable) {
  return {std::move(name), std::move(heading), std::string(unit), Column::Kind::number, dispensable};
}

Column percent_column(std::string name, std::string heading, int dispensable) {
  return number_column(std::move(name), std::move(heading), "%", dispensable);
}

Column main_column(Column column) {
  column.main = true;
  return column;
}

void fill(Table& table, const std::vector<std::size_t>& positions, const std::vector<FilledColumn>& columns) {
  for (const FilledColumn& one : columns) table.columns.push_back(one.column);
  for (const std::size_t position : positions) {
    std::vector<Cell>& row = table.rows.emplace_back();
    for (const FilledColumn& one : columns) row.push_back(one.cell(position));
  }
}

FilledColumn name_column(const std::vector<NamedUnit>& things, const std::string& word) {
  return {text_column(word, word), [&things](std::size_t n) { return text_cell(things[n].name); }};
}

FilledColumn unit_column(const std::vector<NamedUnit>& things) {
  return {text_column("unit", "unit"), [&things](std::size_t n) { return text_cell(display(things[n]).name); }};
}

std::vector<std::size_t> positions(std::size_t count) {
  std::vector<std::size_t> list(count);
  std::iota(list.begin(), list.end(), std::size_t{0});
  return list;
}

Cell text_cell(std::string_view text) { return {text.empty() ? "-" : std::string(text), std::nullopt}; }

Cell number_cell(double value, int digits) { return cell(number_text(value, digits), value); }

Cell value_cell(double si, const NamedUnit& named, int digits) { return number_cell(si / display(named).si, digits); }

Cell count_cell(std::uint64_t count) { return {count_text(count), static_cast<double>(count), count}; }

Cell percent_cell(double share) { return cell(percent_number(share), 100.0 * share); }

Cell index_cell(double index, double scale, double rounding) {
  if (is_too_small_to_tell(index, rounding)) return text_cell(kTooSmall);
  return cell(std::abs(index) < rounding ? "0" : number_text(index * scale), index * scale);
}

std::string readable_setting(std::string_view value) {
  constexpr std::string_view kMarks = "\"{}[], ";  // characters at which a word ends
  std::string text;
  while (!value.empty()) {
    const char first = value.front();
    const std::size_t end = first == '"' ? value.find('"', 1) : std::string_view::npos;
    if (end != std::string_view::npos) {
      text += readable_quoted(value.substr(1, end - 1));
      value.remove_prefix(end + 1);
      continue;
    }
    const std::size_t word = std::clamp(value.find_first_of(kMarks), std::size_t{1}, value.size());
    if (first != '{' && first != '}') text += readable_bare(value.substr(0, word));
    value.remove_prefix(word);
  }
  const std::size_t begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? std::string() : text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

std::vector<std::pair<std::string, std::string>> readable_settings(std::string_view study_text) {
  std::vector<std::pair<std::string, std::string>> list;
  for (const StudySetting& one : study_settings(study_text)) {
    if (!one.section.empty()) list.emplace_back(one.section + "." + one.key, readable_setting(one.value));
  }
  return list;
}

std::string readable_setting(std::string_view study_text, std::string_view section, std::string_view key) {
  return readable_setting(study_setting(study_text, section, key));
}

bool is_first_order(const StoredResult& result) {
  return readable_setting(result.study_text, "mechanism", "fidelity") == "first-order";
}

}  // namespace poesy
