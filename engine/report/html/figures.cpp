#include "engine/report/html/figures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/base/contract.h"

namespace poesy {

using Json = nlohmann::ordered_json;

// The JSON library finds these functions by argument-dependent lookup, also for the elements of lists.

static void to_json(Json& json, const Choice& choice) { json = {{"label", choice.label}, {"options", choice.options}}; }

static void to_json(Json& json, const Coordinate& coordinate) {
  json = {{"name", coordinate.name}, {"unit", coordinate.unit}, {"value", coordinate.value}};
}

static void to_json(Json& json, const BarQuantity& quantity) {
  const auto name_or_null = [](const ArrayName& name) { return name.empty() ? Json(nullptr) : Json(name); };
  Json units = Json::array();
  for (const std::vector<std::string>& unit : quantity.units) {
    units.push_back(unit.size() == 1 ? Json(unit.front()) : Json(unit));  // a list only if items have different units
  }
  json = {{"label", quantity.label},
          {"units", std::move(units)},
          {"value", quantity.value},
          {"low", name_or_null(quantity.low)},
          {"high", name_or_null(quantity.high)}};
}

static void to_json(Json& json, const HeatLayer& layer) {
  json = {{"label", layer.label}, {"unit", layer.unit}, {"value", layer.value}};
  if (layer.signed_values) json["signed"] = true;
}

static void to_json(Json& json, const Field& field) {
  json = {{"label", field.label}, {"unit", field.unit}, {"value", field.value}};
  if (!field.rows.empty()) json["rows"] = field.rows;
  if (field.signed_values) json["signed"] = true;
}

static void to_json(Json& json, const Series& series) {
  json = {{"label", series.label}, {"value", series.value}, {"style", series.style}};
  if (!series.low.empty()) json["low"] = series.low;
  if (!series.high.empty()) json["high"] = series.high;
}

static void to_json(Json& json, const Mark& mark) {
  json = {{"label", mark.label}, {"value", mark.value}};
  if (!mark.beyond.empty()) json["beyond"] = mark.beyond;
}

static void to_json(Json& json, const Panel& panel) {
  json = {{"label", panel.label}, {"unit", panel.unit}, {"series", panel.series}};
  if (!panel.marks.empty()) json["marks"] = panel.marks;
}

static void to_json(Json& json, const Bars& bars) {
  json = {{"type", "bars"},
          {"choices", bars.choices},
          {"quantities", bars.quantities},
          {"items", bars.items},
          {"sort", bars.by_first ? "first" : "value"}};
  if (!bars.series.empty()) json["series"] = bars.series;
}

static void to_json(Json& json, const HeatMap& map) {
  Json columns{{"label", map.column_label}, {"coordinates", map.coordinates}};
  if (!map.numbers.empty()) columns["numbers"] = map.numbers;
  if (!map.order.empty()) columns["order"] = map.order;
  json = {{"type", "heatmap"}, {"layers", map.layers}, {"rows", map.rows}, {"columns", std::move(columns)}};
}

static void to_json(Json& json, const WorkspaceMap& workspace) {
  json = {{"type", "workspace"}, {"coordinates", workspace.coordinates}, {"fields", workspace.fields}};
  if (!workspace.numbers.empty()) json["numbers"] = workspace.numbers;
}

static void to_json(Json& json, const Lines& lines) {
  json = {{"type", "lines"},
          {"x", {{"label", lines.x.name}, {"unit", lines.x.unit}, {"value", lines.x.value}, {"log", lines.log}}},
          {"panels", lines.panels},
          {"most", lines.most},
          {"marks", lines.marks}};
}

static void to_json(Json& json, const Scatter& scatter) {
  const auto axis = [](const auto& of) { return Json{{"label", of.first}, {"value", of.second}}; };
  json = {{"type", "scatter"},    {"choices", scatter.choices}, {"x", axis(scatter.x)},
          {"y", axis(scatter.y)}, {"units", scatter.units},     {"names", scatter.names}};
}

static void to_json(Json& json, const PicturedError& error) {
  json = {{"name", error.name},   {"words", error.words},  {"frame", error.frame}, {"axis", error.axis},
          {"turns", error.turns}, {"isOwn", error.is_own}, {"size", error.size},   {"share", error.share}};
}

static void to_json(Json& json, const Robot& robot) {
  json = {{"type", "robot"},
          {"yaw", robot.yaw},
          {"pitch", robot.pitch},
          {"scale", robot.scale},
          {"centre", robot.centre},
          {"down", robot.z_is_down},
          {"poses", robot.poses},
          {"errors", robot.errors},
          {"frames", robot.frames},
          {"limbs", robot.limbs},
          {"exaggeration", robot.exaggeration}};
  if (!robot.motions.empty()) json["motions"] = robot.motions;
}

static void to_json(Json& json, const WhatIfSize& size) {
  json = {{"label", size.label}, {"value", size.value}, {"unit", size.unit}};
}

static void to_json(Json& json, const WhatIfSlider& slider) {
  json = {{"name", slider.name}, {"sizes", slider.sizes}, {"errors", slider.errors}};
  if (!slider.costs.empty()) json["costs"] = slider.costs;
}

static void to_json(Json& json, const WhatIfLimit& limit) {  // JSON has no infinity, so an infinite end becomes null
  json = {{"components", limit.components}, {"low", limit.low}, {"high", limit.high}};
}

static void to_json(Json& json, const WhatIf& what_if) {
  json = {{"type", "whatIf"},
          {"factors", what_if.factors},
          {"sliders", what_if.sliders},
          {"limits", what_if.limits},
          {"machines", what_if.machines},
          {"poses", what_if.poses},
          {"components", what_if.components},
          {"deviations", what_if.deviations},
          {"slopes", what_if.slopes},
          {"yield", {what_if.yield, what_if.yield_low, what_if.yield_high}},
          {"quantile", what_if.quantile},
          {"linearError", what_if.linear_error},
          {"missed", what_if.missed},
          {"otherCosts", what_if.other_costs}};
}

namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

float shown(double value) {
  return std::isfinite(value) ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
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

/// Replaces "<" by its Unicode escape. In JSON the character occurs only inside strings.
std::string without_tags(std::string text) {
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace

ArrayName ArrayPool::add(const std::string& name, std::span<const double> values, double unit) {
  const auto [entry, added] = arrays_.try_emplace(name);
  if (added) {
    entry->second.reserve(values.size());
    for (const double value : values) entry->second.push_back(shown(value / unit));
  }
  POESY_EXPECTS(entry->second.size() == values.size());
  return name;
}

std::string base64(std::span<const std::byte> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t group = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      group = group << 8 | (n < count ? std::to_integer<std::uint32_t>(bytes[at + n]) : 0U);
    }
    for (std::size_t n = 0; n < 4; ++n) text += n <= count ? kDigits[group >> (18 - 6 * n) & 63] : '=';
  }
  return text;
}

std::string figures_json(const FigureSet& set) {
  Json figures = Json::object();
  for (const auto& [key, figure] : set.figures) {
    figures[key] = std::visit([](const auto& one) { return Json(one); }, figure);
  }
  Json arrays = Json::object();
  for (const auto& [name, values] : set.pool.arrays()) arrays[name] = base64_floats(values);
  const Json all{{"about", set.about}, {"figures", std::move(figures)}, {"arrays", std::move(arrays)}};
  return without_tags(all.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace poesy
