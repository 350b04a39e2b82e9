#include "engine/study/mechanism_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "engine/base/units.h"
#include "engine/model/sketch.h"
#include "engine/study/calibration.h"
#include "engine/study/outside_poses.h"
#include "engine/study/poses/pose_sides.h"
#include "engine/study/poses/unusual_workspace.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

/// A value is far from the published one if it is more than this many times larger or smaller. Slightly below ten, so
/// that a decimal point in the wrong place is noticed.
constexpr double kFar = 9.99;

/// Points count as around a point p if their root mean square distance from p is at most this share of the distance
/// from p to the farthest joint.
constexpr double kAround = 0.05;

bool is_far(double value, double own) {
  if (own == 0.0) return false;
  const double ratio = value / own;
  return ratio < 1.0 / kFar || ratio > kFar;  // true also if the signs differ, because then ratio < 0
}

using Vector = std::array<double, 3>;

double distance(const Vector& a, const Vector& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// The position of a point in the platform's frame (m). point: its position at home in the base's frame.
Vector in_platform(const SketchVector& point, const Sketch& home, const SketchedFrame& platform) {
  Vector found{};
  for (std::size_t k = 0; k < found.size(); ++k) {
    for (std::size_t c = 0; c < found.size(); ++c) {
      found[k] += platform.axes[k][c] * (point[c] - home.platform[c]);
    }
  }
  return found;
}

/// The points of the platform whose displacement is a response: named points, and the tool as "tip".
std::vector<SketchedPoint> points_with_responses(const Sketch& home) {
  std::vector<SketchedPoint> points = home.points;
  for (const SketchVector& tool : home.tool) points.push_back({"tip", tool});
  return points;
}

/// Returns true if the response with this index is a displacement of this point of the platform, or if the study
/// defines the response from others, one of which is such a displacement.
bool depends_on(const std::string& point, std::size_t response, const Study& study) {
  const std::vector<Response>& responses = study.model().responses;
  const std::string& name = responses[response].name;
  const auto own = std::ranges::find(study.mechanism.responses, name, &OwnResponse::name);
  if (own != study.mechanism.responses.end()) {
    return std::ranges::any_of(own->terms,
                               [&](const ResponseTerm& term) { return depends_on(point, term.response, study); });
  }
  return name == point + "_x" || name == point + "_y" || name == point + "_z" || name == point + "_position";
}

/// The root mean square distance (m) of points of the platform from the point `from`, in the platform's frame.
double rms_distance(std::span<const PlatformPoint> points, const Vector& from) {
  double squares = 0.0;
  for (const PlatformPoint& point : points) squares += std::pow(distance(point, from), 2);
  return std::sqrt(squares / static_cast<double>(points.size()));
}

/// The distance (m) from a point to the farthest joint, at home.
double largest_distance(const Sketch& home, const SketchVector& from) {
  double largest = 0.0;
  for (const auto& limb : home.limbs) {
    for (const SketchedJoint& joint : limb) largest = std::max(largest, distance(joint.point, from));
  }
  return largest;
}

}  // namespace

std::string asked_back(std::string_view clause) { return fmt::format("{}; is that meant?", clause); }

std::vector<std::string> geometry_doubts(const MechanismChoice& mechanism) {
  std::vector<std::string> list;
  const std::vector<GeometryParameter>& parameters = mechanism.entry->description.geometry;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const double value = mechanism.geometry[p];
    if (!is_far(value, parameters[p].published)) continue;
    const auto text = [&](double si) { return readable_text({si, parameters[p].dimension}); };
    list.push_back(asked_back(fmt::format("{} = {}; {} {}", parameters[p].name, text(value),
                                          mechanism.file ? "the mechanism's file has" : "the published value is",
                                          text(parameters[p].published))));
  }
  return list;
}

std::vector<std::string> mechanism_doubts(const MechanismChoice& mechanism, const Model& model) {
  std::vector<std::string> list = geometry_doubts(mechanism);
  for (const std::string& unusual : model.unusual_geometry()) list.push_back(asked_back(unusual));
  return list;
}

/// A question about the first response of the study that is relative to a pose outside both the mechanism's and the
/// study's workspace; empty if there is none.
static std::string reference_doubt(const Study& study) {
  constexpr double kRounding = 1e-9;  // as a share of a coordinate's range
  const ModelDescription& model = study.model();
  for (const OwnResponse& own : study.mechanism.responses) {
    if (!own.relative_to || own.relative_to->is_previous()) continue;
    const std::vector<double>& pose = own.relative_to->pose;
    const auto outside = outside_pose(PoseSet(pose.size(), pose), model, kRounding);
    if (!outside) continue;
    const std::size_t c = outside->coordinate;
    const std::vector<Range>& box = study.poses.workspace;
    if (c < box.size() && box[c].lower <= pose[c] && pose[c] <= box[c].upper) continue;
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    const auto text = [&](double si) { return readable_text({si, coordinate.dimension}); };
    return asked_back(
        fmt::format("{} is relative to a pose with {} = {}, outside the mechanism's workspace from {} to {}", own.name,
                    coordinate.name, text(pose[c]), text(model.pose_lower[c]), text(model.pose_upper[c])));
  }
  return {};
}

std::vector<std::string> workspace_doubts(const Study& study, const PoseSet& poses) {
  std::vector<std::string> list;
  const auto add = [&](std::string_view table, const PoseSelection& selection, const PoseSet& selected) {
    const std::string clause = unusual_workspace(selection, selected, study.model());
    if (!clause.empty()) list.push_back(asked_back(fmt::format("[{}] workspace: {}", table, clause)));
  };
  add("poses", study.poses, poses);
  if (std::string doubt = reference_doubt(study); !doubt.empty()) list.push_back(std::move(doubt));
  if (!study.analysis.calibration) return list;
  const CalibrationTable& calibration = *study.analysis.calibration;
  if (calibration.poses) add("analysis.calibration.poses", *calibration.poses, {});
  if (calibration.candidates) add("analysis.calibration.candidates", *calibration.candidates, {});
  return list;
}

/// A question about the first error of which given machines (ErrorModel::machines) have a value above half of
/// Model::error_bound(), because it may be a size instead of a deviation from the nominal size. Empty if there is none.
static std::string given_size_doubt(const Study& study, const Model& model) {
  constexpr double kShare = 0.5;
  if (!study.errors.machines) return {};
  for (const FactorIndex error : study.errors.machines->factors) {
    const ErrorBound bound = model.error_bound(error);
    for (const double value : study.errors.machines->column(error)) {
      if (std::abs(value) <= kShare * bound.size) continue;
      const Factor& factor = study.model().factors[error.value];
      return fmt::format(
          "errors.machines has {} = {}, more than half of {} ({}), but its values are deviations from the nominal "
          "size; are these sizes?",
          factor.name, readable_text({value, factor.dimension}), bound.part,
          readable_text({bound.size, factor.dimension}));
    }
  }
  return {};
}

std::vector<std::string> size_doubts(const Study& study, const Model& model) {
  const StudyKind& kind = *study.analysis.kind;
  if (kind.varies == Varies::none || kind.finds_sizes) return {};
  std::vector<std::string> list;
  if (std::string given = given_size_doubt(study, model); !given.empty()) list.push_back(std::move(given));
  for (const auto& [dimension, share] : {std::pair(Dimension::length, 1.0 / 10.0), {Dimension::angle, 1.0 / 18.0}}) {
    for (const FactorIndex error : study.analysis.factors) {
      const Factor& factor = study.model().factors[error.value];
      const Distribution& distribution = study.errors.by_factor[error.value];
      if (factor.dimension != dimension || distribution.shape() == Distribution::Shape::given) continue;
      const ErrorBound bound = model.error_bound(error);
      const double sigma = distribution.standard_deviation();
      if (sigma <= share * bound.size) continue;
      list.push_back(asked_back(fmt::format("the error {} has a standard deviation of {}, {} is {}", factor.name,
                                            readable_text({sigma, dimension}), bound.part,
                                            readable_text({bound.size, dimension}))));
      break;
    }
  }
  return list;
}

std::string sides_doubt(const Model& model, const PoseSet& poses) {
  const std::optional<std::size_t> beyond = pose_beyond_singularity(model, poses);
  if (!beyond) return {};
  return asked_back(fmt::format(
      "poses 0 and {} are on different sides of singular poses, so that a machine cannot move from one to the other "
      "without passing a singular pose",
      *beyond));
}

std::string zones_doubt(const Study& study) {
  if (study.errors.unused_zone.empty()) return {};
  return fmt::format(
      "errors.zones is missing, so zones of the drawing, such as that of {}, are not used, and the errors of features "
      "have the size errors.linear; is that meant? If not, write errors.zones = {{ distribution = \"normal\", sigmas = "
      "3 }}",
      study.errors.unused_zone);
}

std::string correction_doubt(const Study& study, const Model& model) {
  // If the platform has six degrees of freedom, a correction of the drives moves each of its points back, to first
  // order.
  constexpr std::size_t kAllFreedoms = 6;
  if (study.model().pose_coordinates.size() == kAllFreedoms) return {};
  const std::vector<PlatformPoint> corrected = model.metric_points();
  if (!study.mechanism.calibrated || !study.mechanism.file || corrected.empty()) return {};
  const std::optional<Sketch> home = model.sketch({});
  const SketchedFrame* const platform = home ? home->platform_frame() : nullptr;
  if (platform == nullptr) return {};
  for (const SketchedPoint& point : points_with_responses(*home)) {
    const double away = rms_distance(corrected, in_platform(point.point, *home, *platform));
    if (away <= kAround * largest_distance(*home, point.point)) continue;
    for (const ResponseLimit& limit : study.analysis.limits) {
      if (!depends_on(point.name, limit.response, study)) continue;
      return fmt::format(
          "calibrated = true corrects the drives so that the platform's points (metric_points) are best, but the limit "
          "of {} is on a point that they are not around, for which a calibration can be better; "
          "put metric_points around {}",
          study.model().responses[limit.response].name, point.name == "tip" ? "the tool" : "'" + point.name + "'");
    }
  }
  return {};
}

}  // namespace poesy
