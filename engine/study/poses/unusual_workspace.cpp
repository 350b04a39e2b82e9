#include "engine/study/poses/unusual_workspace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/contract.h"
#include "engine/base/units.h"

namespace poesy {
namespace {

constexpr int kDigits = 6;
constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr double kRounding = 1e-9;  ///< tolerance at the ends of a workspace, as a share of the coordinate's range

/// The range of coordinate c in the workspace that the mechanism states, SI.
Range own_range(const ModelDescription& model, std::size_t c) {
  POESY_EXPECTS(c < model.pose_lower.size() && c < model.pose_upper.size());
  return {model.pose_lower[c], model.pose_upper[c]};
}

std::string range_text(const Range& range, Dimension dimension) {
  return fmt::format("from {} to {}", readable_text({range.lower, dimension}, kDigits),
                     readable_text({range.upper, dimension}, kDigits));
}

/// The clause "z is from 380 mm to 500 mm, in the mechanism's workspace from -500 mm to -380 mm".
std::string both_ranges(std::span<const Range> box, const ModelDescription& model, std::size_t c) {
  const PoseCoordinate& coordinate = model.pose_coordinates[c];
  return fmt::format("{} is {}, in the mechanism's workspace {}", coordinate.name,
                     range_text(box[c], coordinate.dimension), range_text(own_range(model, c), coordinate.dimension));
}

/// The length of the overlap of two ranges; zero or less if they do not overlap.
double common_length(const Range& a, const Range& b) { return std::min(a.upper, b.upper) - std::max(a.lower, b.lower); }

double largest_magnitude(const Range& range) { return std::max(std::abs(range.lower), std::abs(range.upper)); }

/// A clause that names the first coordinate in which most of the box and most of the poses are outside the mechanism's
/// workspace; empty if there is none.
std::string mostly_outside_clause(std::span<const Range> box, const PoseSet& poses, const ModelDescription& model) {
  for (std::size_t c = 0; c < box.size(); ++c) {
    const Range own = own_range(model, c);
    if (2.0 * common_length(box[c], own) >= box[c].upper - box[c].lower) continue;
    const double margin = kRounding * (own.upper - own.lower);
    const auto outside = std::ranges::count_if(
        poses.column(c), [&](double value) { return value < own.lower - margin || value > own.upper + margin; });
    if (2 * static_cast<std::size_t>(outside) <= poses.size()) continue;
    return both_ranges(box, model, c) + "; most poses are outside it";
  }
  return {};
}

/// A clause that names the first angle that goes beyond +-360 deg in the box, but not in the mechanism's workspace;
/// empty if there is none.
std::string full_turn_clause(std::span<const Range> box, const ModelDescription& model) {
  for (std::size_t c = 0; c < box.size(); ++c) {
    if (model.pose_coordinates[c].dimension != Dimension::angle) continue;
    if (largest_magnitude(box[c]) <= kFullTurn || largest_magnitude(own_range(model, c)) > kFullTurn) continue;
    return both_ranges(box, model, c) + "; that is more than a full turn";
  }
  return {};
}

/// A clause that names the first coordinate whose range is far smaller than in the mechanism's workspace; empty if
/// there is none.
std::string tiny_clause(std::span<const Range> box, const ModelDescription& model) {
  constexpr double kTiny = 0.01;  // as a share of the mechanism's range
  for (std::size_t c = 0; c < box.size(); ++c) {
    const Range own = own_range(model, c);
    const double length = box[c].upper - box[c].lower;
    if (length >= kTiny * (own.upper - own.lower)) continue;
    return both_ranges(box, model, c) + "; that is less than a hundredth of it";
  }
  return {};
}

}  // namespace

std::string apart_clause(std::span<const Range> box, const ModelDescription& model) {
  for (std::size_t c = 0; c < box.size(); ++c) {
    if (common_length(box[c], own_range(model, c)) <= 0.0) return both_ranges(box, model, c);
  }
  return {};
}

std::string unusual_workspace(const PoseSelection& selection, const PoseSet& poses, const ModelDescription& model) {
  const std::span<const Range> box = selection.workspace;
  std::string clause = apart_clause(box, model);
  if (clause.empty()) clause = full_turn_clause(box, model);
  if (clause.empty()) clause = tiny_clause(box, model);
  if (clause.empty() && poses.size() > 0) clause = mostly_outside_clause(box, poses, model);
  return clause;
}

}  // namespace poesy
