#include "engine/report/json_tables.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/units.h"
#include "engine/report/display.h"
#include "engine/report/study_settings.h"

namespace poesy {
namespace {

using Json = nlohmann::ordered_json;

/// Null where the study's text does not say it.
Json seed_of(const StoredResult& result) {
  const Json seed = Json::parse(study_setting(result.study_text, "run", "seed"), nullptr, false);
  return seed.is_number_unsigned() ? seed : Json(nullptr);
}

Json solves_json(const SolveCounts& solves) {
  Json by_status = Json::object();
  for (std::size_t s = 0; s < kStatusNames.size(); ++s) {
    by_status[std::string(kStatusNames[s])] = solves.by_status[s];
  }
  return {{"total", solves.total()}, {"not_converged", solves.not_converged()}, {"by_status", by_status}};
}

Json column_json(const Column& column) {
  return {{"name", column.name},
          {"heading", column.heading},
          {"unit", column.unit},
          {"kind", column.kind == Column::Kind::number ? "number" : "text"}};
}

Json value_json(const Column& column, const Cell& cell) {
  if (column.kind == Column::Kind::text) return cell.text;
  return cell.value ? Json(*cell.value) : Json(nullptr);
}

Json table_json(const Table& table) {
  Json columns = Json::array();
  for (const Column& column : table.columns) columns.push_back(column_json(column));
  Json rows = Json::array();
  Json shown = Json::array();
  for (const std::vector<Cell>& row : table.rows) {
    Json values = Json::object();
    Json texts = Json::array();
    for (std::size_t c = 0; c < row.size(); ++c) {
      values[table.columns[c].name] = value_json(table.columns[c], row[c]);
      texts.push_back(row[c].text);
    }
    rows.push_back(std::move(values));
    shown.push_back(std::move(texts));
  }
  return {{"name", table.name}, {"caption", table.caption}, {"columns", columns},
          {"rows", rows},       {"shown", shown},           {"notes", table.notes}};
}

/// Names with their SI units and what they mean.
Json named_json(const std::vector<NamedUnit>& things) {
  Json list = Json::array();
  for (const NamedUnit& thing : things) {
    list.push_back({{"name", thing.name}, {"unit", thing.unit}, {"description", thing.description}});
  }
  return list;
}

Json tables_json(std::span<const Table> tables) {
  Json list = Json::array();
  for (const Table& table : tables) list.push_back(table_json(table));
  return list;
}

/// A result without its tables.
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
          {"errors", named_json(result.factors)},
          {"responses", named_json(result.responses)},
          {"solves", solves_json(solves)},
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

std::string text_of(const Json& all) { return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace

std::string json_of(const StoredResult& result, const SolveCounts& solves, std::span<const Table> tables) {
  Json all = summary_json(result, solves);
  all["tables"] = tables_json(tables);
  return text_of(all);
}

std::string json_of(const RankedResult& a, const RankedResult& b, const TwoRankings& rankings) {
  return text_of({{"results", Json::array({ranked_json(a), ranked_json(b)})},
                  {"kendall_tau", std::isnan(rankings.tau) ? Json(nullptr) : Json(rankings.tau)},
                  {"remarks", rankings.remarks},
                  {"tables", tables_json({&rankings.table, 1})}});
}

}  // namespace poesy
