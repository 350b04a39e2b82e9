#include "engine/study/bare_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "engine/base/text.h"

namespace poesy {
namespace {

constexpr double kFarBeyond = 10.0;  ///< over the size of an error
constexpr double kRounding = 1e-9;   ///< over a workspace's range
constexpr int kDigits = 6;

/// A line that asks about a number: "FILE: z has no unit, so its numbers are in m: FOUND; ...".
std::string line(std::string_view file, std::string_view column, Dimension dimension, const std::string& found) {
  return fmt::format(
      "{}: {} has no unit, so its numbers are in {}: {}; if they are not, name their unit in the first line, e.g. '{} "
      "[{}]'",
      printable(file), printable(column), si_unit(dimension), found, printable(column), display_unit(dimension).name);
}

/// Describes a magnitude that is too large; empty if it is not.
std::string beyond_text(double value, Dimension dimension, double usual, std::string_view whose) {
  return fmt::format("one is {}, more than {} times {} ({})", readable_text({value, dimension}, kDigits), kFarBeyond,
                     whose, readable_text({usual, dimension}, kDigits));
}

double largest_magnitude(std::span<const double> values) {
  return *std::ranges::max_element(values, {}, [](double value) { return std::abs(value); });
}

}  // namespace

std::string bare_pose_text(std::string_view file, const PoseTable& table, const PoseSet& poses,
                           const ModelDescription& model) {
  if (table.bare.empty()) return {};
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    // The coordinates of a chart determine the pose only together.
    const auto own = std::ranges::find(table.bare, coordinate.name);
    if (!table.chart && own == table.bare.end()) continue;
    const double lower = model.pose_lower[c];
    const double upper = model.pose_upper[c];
    const double margin = kRounding * (upper - lower);
    const std::vector<double> values = poses.column(c);
    const auto outside =
        std::ranges::find_if(values, [&](double value) { return value < lower - margin || value > upper + margin; });
    if (outside == values.end()) continue;
    const auto& columns = coordinates(model, table.chart);
    const std::string& column = table.chart ? table.bare.front() : coordinate.name;
    const Dimension dimension = std::ranges::find(columns, column, &PoseCoordinate::name)->dimension;
    const auto text = [&](double value) { return to_text({value, coordinate.dimension}); };
    return line(file, column, dimension,
                fmt::format("pose {} has {} = {}, outside the workspace from {} to {}", outside - values.begin() + 1,
                            coordinate.name, text(*outside), text(lower), text(upper)));
  }
  return {};
}

std::vector<std::string> doubts_of(const Study& study, const SelectedPoses& poses) {
  std::vector<std::string> doubts = study.doubts;
  std::string of_poses;
  if (study.poses.select == PoseSelection::Select::file) {
    of_poses = bare_pose_text(study.poses.file, study.poses.from_file, poses.poses, study.model());
  } else if (study.poses.trajectory && !study.poses.trajectory->curve) {
    const Trajectory& trajectory = *study.poses.trajectory;
    of_poses = bare_pose_text(trajectory.file, trajectory.from_file.table, poses.poses, study.model());
  }
  if (!of_poses.empty()) doubts.push_back(std::move(of_poses));
  return doubts;
}

std::string bare_error_text(std::string_view file, const ErrorTable& table, const Study& study) {
  for (std::size_t v = 0; v < table.bare.size(); ++v) {
    if (!table.bare[v]) continue;
    const Factor& factor = study.model().factors[table.factors[v].value];
    const double usual = error_size(study.errors.by_factor[table.factors[v].value]);
    for (std::size_t row = 0; row < table.rows; ++row) {
      const double value = table.values[row * table.factors.size() + v];
      if (std::abs(value) <= kFarBeyond * usual) continue;
      return line(file, factor.name, factor.dimension,
                  beyond_text(value, factor.dimension, usual, "the size that the study gives this error"));
    }
  }
  return {};
}

std::string bare_column_text(std::string_view file, const MeasuredColumn& column, Dimension dimension,
                             const Distribution& usual) {
  if (!column.bare || column.values.empty()) return {};
  const double largest = largest_magnitude(column.values);
  const double size = error_size(usual);
  if (std::abs(largest) <= kFarBeyond * size) return {};
  return line(file, column.name, dimension,
              beyond_text(largest, dimension, size, fmt::format("the size of other {} errors", error_kind(dimension))));
}

}  // namespace poesy
