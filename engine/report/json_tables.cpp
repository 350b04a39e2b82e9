#include "engine/report/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/nan.h"
#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/report/display.h"

namespace poesy {

using Json = nlohmann::ordered_json;

// The JSON library finds these functions by argument-dependent lookup, also for the elements of lists.

static void to_json(Json& json, const NamedUnit& thing) {
  json = {{"name", thing.name}, {"unit", thing.unit}, {"description", thing.description}};
}

static void to_json(Json& json, const RejectedPoses& poses) {
  json = {{"reason", poses.reason}, {"count", poses.count}};
}

static void to_json(Json& json, const Column& column) {
  json = {{"name", column.name},
          {"heading", column.heading},
          {"unit", column.unit},
          {"kind", column.kind == Column::Kind::number ? "number" : "text"}};
}

static Json number_of(const Cell& cell) {
  if (cell.whole) return *cell.whole;
  return cell.value ? Json(*cell.value) : Json(nullptr);
}

static void to_json(Json& json, const Table& table) {
  Json rows = Json::array();
  Json shown = Json::array();
  for (const std::vector<Cell>& row : table.rows) {
    Json& values = rows.emplace_back(Json::object());
    Json& texts = shown.emplace_back(Json::array());
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool number = table.columns[c].kind == Column::Kind::number;
      values[table.columns[c].name] = number ? number_of(row[c]) : Json(row[c].text);
      texts.push_back(row[c].text);
    }
  }
  json = {{"name", table.name},      {"caption", table.caption},  {"columns", table.columns},
          {"rows", std::move(rows)}, {"shown", std::move(shown)}, {"notes", table.notes}};
}

static void to_json(Json& json, const SolveCounts& solves) {
  Json by_status = Json::object();
  for (std::size_t s = 0; s < kStatusNames.size(); ++s) {
    by_status[std::string(kStatusNames[s])] = solves.by_status[s];
  }
  json = {{"total", solves.total()}, {"not_converged", solves.not_converged()}, {"by_status", std::move(by_status)}};
}

namespace {

/// The seed in the study of the result; null if the study states none.
Json seed_of(const StoredResult& result) {
  const Json seed = Json::parse(study_setting(result.study_text, "run", "seed"), nullptr, false);
  return seed.is_number_unsigned() ? seed : Json(nullptr);
}

/// The summary of a result, without its tables.
Json summary_json(const StoredResult& result, const SolveCounts& solves) {
  return {{"kind", result.kind},
          {"model", result.model},
          {"metric", result.metric.empty() ? Json(nullptr) : Json(result.metric)},
          {"metric_points", result.metric_points.empty() ? Json(nullptr) : Json(result.metric_points)},
          {"title", result.title},
          {"poesy_version", result.poesy_version},
          {"git_commit", result.git_commit},
          {"content_sha256", result.content_sha256},
          {"seed", seed_of(result)},
          {"poses", result.poses.size()},
          {"candidate_poses", result.candidates == 0 ? Json(nullptr) : Json(result.candidates)},
          {"rejected_poses", result.rejected},
          {"errors", result.factors},
          {"responses", result.responses},
          {"solves", solves},
          {"run",
           {{"created", result.facts.created},
            {"threads", result.facts.threads},
            {"wall_seconds", result.facts.wall_seconds}}}};
}

Json ranked_json(const RankedResult& ranked) {
  Json all{{"path", ranked.path}, {"response", ranked.response}};
  all.update(summary_json(ranked.result, ranked.solves));
  return all;
}

/// JSON as text. The library escapes only control characters below U+0020, so this function escapes the other control
/// characters.
std::string text_of(const Json& all) {
  const std::string json = all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  std::string text;
  text.reserve(json.size());
  for (std::string_view rest = json; !rest.empty();) {
    const std::string_view character = rest.substr(0, std::max<std::size_t>(character_length(rest), 1));
    const std::uint32_t code = code_point(character);
    if (code != '\n' && is_control(code)) {
      text += fmt::format("\\u{:04x}", code);
    } else {
      text += character;
    }
    rest.remove_prefix(character.size());
  }
  return text;
}

}  // namespace

std::string json_of(const StoredResult& result, const SolveCounts& solves, std::span<const Table> tables) {
  Json all = summary_json(result, solves);
  all["tables"] = Json::array();
  for (const Table& table : tables) all["tables"].push_back(table);
  return text_of(all);
}

std::string json_of(const Table& table) { return text_of(Json(table)); }

std::string json_of(std::span<const RankedResult> results, const ComparedResults& compared) {
  Json all{{"results", Json::array()}, {"remarks", compared.remarks}, {"tables", compared.tables}};
  for (const RankedResult& result : results) all["results"].push_back(ranked_json(result));
  const double tau = compared.tau.value_or(kNaN);
  all["kendall_tau"] = std::isnan(tau) ? Json(nullptr) : Json(tau);
  return text_of(all);
}

}  // namespace poesy
