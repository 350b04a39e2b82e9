#include "engine/study/bare_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "engine/base/text.h"
#include "engine/study/mechanism_doubts.h"
#include "engine/study/outside_poses.h"

namespace poesy {
namespace {

/// A number is doubtful if its magnitude is more than this many times the size with which it is compared.
constexpr double kFarBeyond = 10.0;
constexpr double kRounding = 1e-9;  ///< tolerance at the ends of a workspace, as a share of its range
constexpr int kDigits = 6;

/// The warning about a column without a unit: "FILE: z has no unit, so its numbers are in m: FOUND; ...". found: what
/// is doubtful, as a clause.
std::string line(std::string_view file, std::string_view column, Dimension dimension, const std::string& found) {
  return fmt::format(
      "{}: {} has no unit, so its numbers are in {}: {}; if they are not, name their unit in the first line, e.g. '{} "
      "[{}]'",
      printable(file), printable(column), si_unit(dimension), found, printable(column), display_unit(dimension).name);
}

/// A clause that says that a value is more than kFarBeyond times the size `usual`, both in SI. whose: noun phrase for
/// `usual`, such as "the size of the workspace".
std::string beyond_text(double value, Dimension dimension, double usual, std::string_view whose) {
  return fmt::format("one is {}, more than {} times {} ({})", readable_text({value, dimension}, kDigits), kFarBeyond,
                     whose, readable_text({usual, dimension}, kDigits));
}

/// The size of the study's largest error of a dimension, SI; infinity if there is no such error.
double largest_error(Dimension dimension, const Study& study) {
  double largest = 0.0;
  for (std::size_t f = 0; f < study.model().factors.size(); ++f) {
    if (study.model().factors[f].dimension != dimension) continue;
    largest = std::max(largest, error_size(study.errors.by_factor[f]));
  }
  return largest > 0.0 ? largest : std::numeric_limits<double>::infinity();
}

/// The diagonal of the box of the pose coordinates that are lengths, m.
double size_of_workspace(const ModelDescription& model) {
  double squares = 0.0;
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    if (model.pose_coordinates[c].dimension != Dimension::length) continue;
    squares += std::pow(model.pose_upper[c] - model.pose_lower[c], 2);
  }
  return std::sqrt(squares);
}

/// The number to compare with errors, SI. For a measured coordinate, it is the difference from the pose's coordinate,
/// or none if the pose in the file lacks this coordinate; otherwise, it is the measured deviation or distance itself.
std::optional<double> departure(const MachineValue& value, const PoseTable& poses, const ModelDescription& model) {
  if (value.column != MachineColumn::actual) return value.value;
  const auto own = std::ranges::find(model.pose_coordinates, value.quantity, &PoseCoordinate::name);
  if (poses.chart || own == model.pose_coordinates.end()) return std::nullopt;
  return value.value -
         poses.points[PoseIndex(value.row)][static_cast<std::size_t>(own - model.pose_coordinates.begin())];
}

/// The first column without a unit on which this coordinate of a pose depends; empty if all have units. If the table
/// has the coordinates of a chart (PoseChart), a coordinate of the pose depends on all of them.
std::string bare_column_of(const PoseTable& table, const std::string& coordinate) {
  if (table.chart) return table.bare.empty() ? std::string() : table.bare.front();
  return std::ranges::find(table.bare, coordinate) == table.bare.end() ? std::string() : coordinate;
}

double largest_magnitude(std::span<const double> values) {
  return *std::ranges::max_element(values, {}, [](double value) { return std::abs(value); });
}

/// Warns of the first error that is more than ten times as large as the study's errors of this factor, if it is a
/// number without dimension or its column states no unit.
std::string bare_error_text(std::string_view file, const ErrorTable& table, const Study& study) {
  for (std::size_t v = 0; v < table.bare.size(); ++v) {
    const Factor& factor = study.model().factors[table.factors[v].value];
    const bool is_number = factor.dimension == Dimension::number;
    if (!table.bare[v] && !is_number) continue;
    const double usual = error_size(study.errors.by_factor[table.factors[v].value]);
    for (std::size_t row = 0; row < table.rows; ++row) {
      const double value = table.values[row * table.factors.size() + v];
      if (std::abs(value) <= kFarBeyond * usual) continue;
      const std::string found = beyond_text(value, factor.dimension, usual, "the size that the study gives this error");
      if (is_number) return fmt::format("{}: {}: {}; is that meant?", printable(file), printable(factor.name), found);
      return line(file, factor.name, factor.dimension, found);
    }
  }
  return {};
}

/// Warns of a row whose label says that it is no part: a statistic of the other rows, or, among parts, a limit.
std::string summary_row_text(std::string_view file, const RowLabels& labels) {
  constexpr std::array<std::string_view, 10> kStatistics{"mean",  "average", "avg",   "median", "std",
                                                         "stdev", "sd",      "sigma", "sum",    "total"};
  constexpr std::array<std::string_view, 10> kLimits{"min",     "minimum", "max", "maximum",   "range",
                                                     "nominal", "usl",     "lsl", "tolerance", "limit"};
  const bool are_parts = labels.column == "part";
  for (const std::string& label : labels.names) {
    const std::string word = lower_case(label);
    const bool is_limit = are_parts && std::ranges::find(kLimits, word) != kLimits.end();
    if (!is_limit && std::ranges::find(kStatistics, word) == kStatistics.end()) continue;
    return fmt::format("{}: the row {} counts as one more {}; is that meant? If not, delete it", printable(file),
                       printable(label), printable(labels.column));
  }
  return {};
}

/// The odd_value_text() of the first column that has an odd value.
std::string odd_error_text(std::string_view file, const ErrorTable& table, const Study& study) {
  for (const FactorIndex error : table.factors) {
    const Factor& factor = study.model().factors[error.value];
    std::string text = odd_value_text(file, factor.name, factor.dimension, table.column(error));
    if (!text.empty()) return text;
  }
  return {};
}

}  // namespace

std::string outside_pose_text(std::string_view file, const PoseTable& table, const PoseSet& poses,
                              const ModelDescription& model) {
  const auto outside = outside_pose(poses, model, kRounding);
  if (!outside) return {};
  const std::string bare = bare_column_of(table, model.pose_coordinates[outside->coordinate].name);
  if (bare.empty()) {
    const auto text = [](Quantity value) { return readable_text(value, kDigits); };
    return fmt::format("{}: {}; look at its sign and unit", printable(file),
                       outside_clause(*outside, poses, model, text));
  }
  const auto& columns = coordinates(model, table.chart);
  const Dimension dimension = std::ranges::find(columns, bare, &PoseCoordinate::name)->dimension;
  return line(file, bare, dimension, outside_clause(*outside, poses, model, to_text));
}

std::vector<std::string> doubts_of(const Study& study, const SelectedPoses& poses) {
  std::vector<std::string> doubts = study.doubts;
  std::string of_poses;
  if (study.poses.select == PoseSelection::Select::file) {
    of_poses = outside_pose_text(study.poses.file, study.poses.from_file, poses.poses, study.model());
  } else if (study.poses.trajectory && !study.poses.trajectory->curve) {
    const Trajectory& trajectory = *study.poses.trajectory;
    of_poses = outside_pose_text(trajectory.file, trajectory.from_file.table, poses.poses, study.model());
  }
  if (!of_poses.empty()) doubts.push_back(std::move(of_poses));
  std::ranges::move(workspace_doubts(study, poses.poses), std::back_inserter(doubts));
  return doubts;
}

std::vector<std::string> error_table_doubts(std::string_view file, const ErrorTable& table, const Study& study) {
  std::vector<std::string> list{summary_row_text(file, table.labels), bare_error_text(file, table, study)};
  if (list.front().empty() && list.back().empty()) list.push_back(odd_error_text(file, table, study));
  std::erase(list, "");
  return list;
}

std::string bare_measurement_text(std::string_view file, const MachineFile& measurements, const Study& study) {
  const ModelDescription& model = study.model();
  for (const MachineValue& value : measurements.values) {
    const bool is_distance = value.column == MachineColumn::distance;
    const bool is_angle = value.column == MachineColumn::deviation && value.quantity.starts_with("theta");
    const Dimension dimension = is_angle ? Dimension::angle : Dimension::length;
    const double of_errors = largest_error(dimension, study);
    const std::string errors = fmt::format("the largest {} error of the study", error_kind(dimension));
    const auto doubt = [&](const std::string& title, std::optional<double> number, double usual,
                           const std::string& whose) {
      const bool is_bare = std::ranges::find(measurements.bare, title) != measurements.bare.end();
      if (!is_bare || !number || std::abs(*number) <= kFarBeyond * usual) return std::string();
      return line(file, title, dimension, beyond_text(*number, dimension, usual, whose));
    };
    const std::string of_value =
        is_distance ? doubt(value.column_name(), value.value, size_of_workspace(model), "the size of the workspace")
                    : doubt(value.column_name(), departure(value, measurements.poses, model), of_errors, errors);
    if (!of_value.empty()) return of_value;
    std::string of_sd = doubt("sd_" + value.quantity, value.sd, of_errors, errors);
    if (!of_sd.empty()) return of_sd;
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

std::string odd_value_text(std::string_view file, std::string_view column, Dimension dimension,
                           std::span<const double> values) {
  constexpr double kOdd = 100.0;
  constexpr std::size_t kFew = 5;
  if (values.size() < kFew) return {};
  std::vector<double> magnitudes;
  for (const double value : values) magnitudes.push_back(std::abs(value));
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::ranges::nth_element(magnitudes, middle);
  const double median = *middle;
  const double largest = largest_magnitude(values);
  if (!(median > 0.0) || std::abs(largest) <= kOdd * median) return {};
  const auto text = [&](double value) { return readable_text({value, dimension}, kDigits); };
  return fmt::format("{}: {} has {}, more than {} times its median {}; is that meant, and in the column's unit?",
                     printable(file), printable(column), text(largest), kOdd, text(median));
}

}  // namespace poesy
