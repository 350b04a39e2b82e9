#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "engine/report/html/figures.h"

namespace poesy {
namespace {

using Json = nlohmann::ordered_json;

Json name_or_null(const ArrayName& name) { return name.empty() ? Json(nullptr) : Json(name); }

Json json(const Choice& choice) { return {{"label", choice.label}, {"options", choice.options}}; }

Json json(const Coordinate& coordinate) {
  return {{"name", coordinate.name}, {"unit", coordinate.unit}, {"value", coordinate.value}};
}

// Declared before the list of any of them.
Json json(const BarQuantity& quantity);
Json json(const HeatLayer& layer);
Json json(const Field& field);
Json json(const Series& series);
Json json(const Panel& panel);
Json json(const Mark& mark);

template <class Part>
Json list(const std::vector<Part>& parts) {
  Json all = Json::array();
  for (const Part& part : parts) all.push_back(json(part));
  return all;
}

/// A unit for each option, which is a list where items differ.
Json units(const std::vector<std::vector<std::string>>& by_option) {
  Json all = Json::array();
  for (const std::vector<std::string>& unit : by_option) {
    all.push_back(unit.size() == 1 ? Json(unit.front()) : Json(unit));
  }
  return all;
}

Json json(const BarQuantity& quantity) {
  return {{"label", quantity.label},
          {"units", units(quantity.units)},
          {"value", quantity.value},
          {"low", name_or_null(quantity.low)},
          {"high", name_or_null(quantity.high)}};
}

Json json(const HeatLayer& layer) {
  Json all{{"label", layer.label}, {"unit", layer.unit}, {"value", layer.value}};
  if (layer.signed_values) all["signed"] = true;
  return all;
}

Json json(const Field& field) {
  Json all{{"label", field.label}, {"unit", field.unit}, {"value", field.value}};
  if (!field.rows.empty()) all["rows"] = field.rows;
  if (field.signed_values) all["signed"] = true;
  return all;
}

Json json(const Series& series) {
  Json all{{"label", series.label}, {"value", series.value}, {"style", series.style}};
  if (!series.low.empty()) all["low"] = series.low;
  if (!series.high.empty()) all["high"] = series.high;
  return all;
}

Json json(const Panel& panel) { return {{"label", panel.label}, {"unit", panel.unit}, {"series", list(panel.series)}}; }

Json json(const Mark& mark) { return {{"label", mark.label}, {"value", mark.value}}; }

Json json(const Bars& bars) {
  Json all{{"type", "bars"},
           {"choices", list(bars.choices)},
           {"quantities", list(bars.quantities)},
           {"items", bars.items},
           {"sort", bars.sorted ? "value" : "none"}};
  if (!bars.series.empty()) all["series"] = bars.series;
  return all;
}

Json json(const HeatMap& map) {
  Json columns{{"label", map.column_label}, {"coordinates", list(map.coordinates)}};
  if (!map.numbers.empty()) columns["numbers"] = map.numbers;
  if (!map.order.empty()) columns["order"] = map.order;
  return {{"type", "heatmap"}, {"layers", list(map.layers)}, {"rows", map.rows}, {"columns", std::move(columns)}};
}

Json json(const WorkspaceMap& workspace) {
  Json all{{"type", "workspace"}, {"coordinates", list(workspace.coordinates)}, {"fields", list(workspace.fields)}};
  if (!workspace.numbers.empty()) all["numbers"] = workspace.numbers;
  return all;
}

Json json(const Lines& lines) {
  return {{"type", "lines"},
          {"x", {{"label", lines.x.name}, {"unit", lines.x.unit}, {"value", lines.x.value}, {"log", lines.log}}},
          {"panels", list(lines.panels)},
          {"most", lines.most},
          {"marks", list(lines.marks)}};
}

Json json(const Scatter& scatter) {
  const auto axis = [](const auto& of) { return Json{{"label", of.first}, {"value", of.second}}; };
  return {{"type", "scatter"},    {"choices", list(scatter.choices)}, {"x", axis(scatter.x)},
          {"y", axis(scatter.y)}, {"units", scatter.units},           {"names", scatter.names}};
}

std::string base64_floats(const std::vector<float>& values) {
  std::vector<std::byte> bytes;
  bytes.reserve(4 * values.size());
  for (const float value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::byte>(bits >> shift));
  }
  return base64(bytes);
}

/// In JSON "<" stands in strings alone, where it may be written by its number.
std::string without_tags(const std::string& text) {
  std::string safe;
  safe.reserve(text.size());
  for (const char character : text) {
    if (character == '<') {
      safe += "\\u003c";
    } else {
      safe += character;
    }
  }
  return safe;
}

}  // namespace

std::string figures_json(const FigureSet& set) {
  Json figures = Json::object();
  for (const auto& [key, figure] : set.figures) {
    figures[key] = std::visit([](const auto& one) { return json(one); }, figure);
  }
  Json arrays = Json::object();
  for (const auto& [name, values] : set.pool.arrays()) arrays[name] = base64_floats(values);
  const Json all{{"about", set.about}, {"figures", std::move(figures)}, {"arrays", std::move(arrays)}};
  return without_tags(all.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace poesy
