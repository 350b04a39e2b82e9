#include "engine/study/study_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/base/contract.h"
#include "engine/study/study_kind.h"

namespace poesy {

std::string points_text(std::span<const PlatformPoint> points, ValueText value) {
  std::vector<std::string> list;
  for (const PlatformPoint& point : points) {
    const auto coordinate = [&](std::size_t c) { return value(point[c], Dimension::length); };
    list.push_back(fmt::format("[{}, {}, {}]", coordinate(0), coordinate(1), coordinate(2)));
  }
  return fmt::format("[{}]", fmt::join(list, ", "));
}

std::string range_text(const Range& range, Dimension dimension, ValueText value) {
  return fmt::format("[{}, {}]", value(range.lower, dimension), value(range.upper, dimension));
}

std::string workspace_text(std::span<const Range> workspace, const ModelDescription& model, ValueText value) {
  std::string text;
  for (std::size_t c = 0; c < workspace.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    text += fmt::format("{}{} = {}", c == 0 ? "{ " : ", ", coordinate.name,
                        range_text(workspace[c], coordinate.dimension, value));
  }
  return text + " }";
}

std::string set_name(std::span<const FactorIndex> factors, const ModelDescription& model) {
  for (const FactorSet& set : model.factor_sets) {
    if (std::equal(factors.begin(), factors.end(), set.factors.begin(), set.factors.end())) return set.name;
  }
  if (model.find_set("all") != nullptr || factors.size() != model.factors.size()) return {};
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].value != f) return {};
  }
  return "all";
}

std::string factors_text(std::span<const FactorIndex> factors, const ModelDescription& model) {
  if (const std::string set = set_name(factors, model); !set.empty()) return in_quotes(set);
  std::string text = "[";
  for (const FactorIndex factor : factors) text += "\n  " + in_quotes(model.factors[factor.value].name) + ",";
  return text + "\n]";
}

namespace {

/// The keys that hold for the study's kind.
StudyRows analysis_keys_of(const Study& study) {
  const StudyKind& kind = *study.analysis.kind;
  StudyRows keys = analysis_keys(kind);
  std::erase_if(keys.rows, [&](const StudyRow& row) { return row.name != keys.chooser && !kind.has_key(row.name); });
  return keys;
}

}  // namespace

std::string resolved_text(const Study& study) {
  POESY_EXPECTS(study.analysis.kind != nullptr);
  return fmt::format("{}\n[mechanism]\n{}\n[poses]\n{}\n[errors]\n{}\n[analysis]\n{}\n[solver]\n{}\n[run]\n{}",
                     keys_text(file_keys(), study), keys_text(mechanism_keys(), study), keys_text(poses_keys(), study),
                     keys_text(errors_keys(), study), keys_text(analysis_keys_of(study), study),
                     keys_text(solver_keys(), study), keys_text(run_keys(), study));
}

}  // namespace poesy
