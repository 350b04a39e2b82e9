#include "engine/report/html/forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/report/display.h"
#include "engine/report/report_kind.h"
#include "engine/report/sketch_picture.h"

namespace poesy {
namespace {

// A force below this share of the largest force of a limb is rounding error, and is shown as zero.
constexpr double kRounding = 1e-12;

/// The force of a limb or of a drive at each pose of the result.
struct Force {
  std::size_t limb;
  /// Index of the driven joint in the limb; none: the force is that of the whole limb.
  std::optional<std::size_t> drive;
  std::size_t response;     ///< index of the response that is this force
  std::vector<double> rms;  ///< [poses] root mean square over the errors, SI
};

void add_force(const ReportKind& kind, const StoredResult& result, const std::string& name, std::size_t limb,
               std::optional<std::size_t> drive, std::vector<Force>& list) {
  const auto at = std::ranges::find(result.responses, name, &NamedUnit::name);
  if (at == result.responses.end()) return;
  const auto response = static_cast<std::size_t>(at - result.responses.begin());
  list.push_back({limb, drive, response, kind.rms_at_poses(result, response)});
}

/// The forces of limbs and of prismatic drives, ordered by limb.
std::vector<Force> forces_of(const ReportKind& kind, const StoredResult& result, const Sketch& home) {
  std::vector<Force> list;
  for (std::size_t i = 0; i < home.labels.size(); ++i) {
    add_force(kind, result, "force_" + home.labels[i], i, std::nullopt, list);
    for (std::size_t j = 0; j < home.limbs[i].size(); ++j) {
      const SketchedJoint& joint = home.limbs[i][j];
      if (!joint.actuated || joint.type != 'P') continue;
      add_force(kind, result, "actuator_" + joint.name + "_" + home.labels[i], i, j, list);
    }
  }
  return list;
}

/// The largest force at a pose: that of a drive if `of_drives` is true, otherwise that of a limb. SI.
double largest_at(std::span<const Force> forces, bool of_drives, std::size_t pose) {
  double largest = 0.0;
  for (const Force& force : forces) {
    if (force.drive.has_value() == of_drives) largest = std::max(largest, force.rms[pose]);
  }
  return largest;
}

/// A pose that is shown with its forces.
struct ForcePose {
  std::size_t pose;
  std::string why;
  Sketch sketch;
};

std::vector<ForcePose> poses_of(const StoredResult& result, const Model& model, std::span<const Force> forces) {
  std::vector<double> largest;
  for (std::size_t m = 0; m < result.poses.size(); ++m) largest.push_back(largest_at(forces, false, m));
  const auto [least, most] = std::ranges::minmax_element(largest);
  std::vector<ForcePose> list;
  const auto add = [&](auto at, const char* why) {
    const auto m = static_cast<std::size_t>(at - largest.begin());
    std::optional<Sketch> sketch = sketch_at(model, result.poses[PoseIndex(m)]);
    if (sketch) list.push_back({m, why, *std::move(sketch)});
  };
  add(most, "where the largest force of a limb is largest");
  if (*least < *most) add(least, "where it is smallest");
  return list;
}

/// The forces at a pose as PartShares: for limbs in SI, for drives as lengths of arrows relative to the longest one.
/// of_limbs, of_drives: the largest force of a limb and of a drive in all pictures, SI.
PartShares shares_at(const Sketch& sketch, std::size_t pose, std::span<const Force> forces, double of_limbs,
                     double of_drives) {
  PartShares parts(sketch);
  parts.largest = of_limbs;
  for (const Force& force : forces) {
    if (force.drive) {
      parts.arrows[force.limb][*force.drive] = of_drives > 0.0 ? force.rms[pose] / of_drives : 0.0;
      continue;
    }
    std::ranges::fill(parts.links[force.limb], force.rms[pose]);
    std::ranges::fill(parts.joints[force.limb], force.rms[pose]);
  }
  return parts;
}

/// The forces of limbs at a pose in words: "limb 1 12.3 N, limb 2 0 N". A force that is only rounding error compared
/// with the largest force of a limb is shown as zero.
std::string forces_text(const StoredResult& result, std::span<const Force> forces, std::size_t pose) {
  const double rounding = kRounding * largest_at(forces, false, pose);
  std::string text;
  for (const Force& force : forces) {
    if (force.drive) continue;
    text += fmt::format(
        "{}limb {} {}", text.empty() ? "" : ", ", force.limb + 1,
        response_text(result.responses[force.response], force.rms[pose] > rounding ? force.rms[pose] : 0.0));
  }
  return text;
}

}  // namespace

void add_forces(const ReportKind& kind, const ReportedResult& reported, Section& section) {
  const StoredResult& result = reported.stored;
  if (!has_pictures(reported) || kind.rms_at_poses == nullptr || result.poses.size() == 0) return;
  const std::optional<Sketch> home = sketch_at(*reported.model, {});
  if (!home) return;
  const std::vector<Force> forces = forces_of(kind, result, *home);
  const auto of_limb = std::ranges::find(forces, false, [](const Force& force) { return force.drive.has_value(); });
  if (of_limb == forces.end()) return;
  const std::vector<ForcePose> poses = poses_of(result, *reported.model, forces);
  double of_limbs = 0.0;
  double of_drives = 0.0;
  std::vector<Sketch> sketches;
  for (const ForcePose& one : poses) {
    of_limbs = std::max(of_limbs, largest_at(forces, false, one.pose));
    of_drives = std::max(of_drives, largest_at(forces, true, one.pose));
    sketches.push_back(one.sketch);
  }
  if (!(of_limbs > 0.0) || !std::isfinite(of_limbs)) return;
  if (of_drives < kRounding * of_limbs) of_drives = 0.0;
  const NamedUnit& unit = result.responses[of_limb->response];
  const SketchView view = sketch_view(sketches, kSketchYaw, kSketchPitch, kTallHeight);
  std::string html =
      colour_legend("force of a limb", "0 N", response_text(unit, of_limbs)) + "<div class=\"robot-poses\">\n";
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Sketch& sketch = poses[k].sketch;
    const std::string title = pose_title(result, poses[k].pose, poses[k].why);
    const PartShares shares = shares_at(sketch, poses[k].pose, forces, of_limbs, of_drives);
    html +=
        fmt::format("<div class=\"force-pose robot-pose\">{}\n{}</div>\n", element("p", title, "class=\"plot-title\""),
                    svg_picture(fmt::format("forces-{}", k), {kSketchWidth, view.height}, title,
                                "Forces of the limbs: " + forces_text(result, forces, poses[k].pose) + ".",
                                turnable_sketch(sketch, view, shares, sketch.errors.size())));
  }
  std::string caption =
      "The forces that the errors cause, root mean squares over all of them together: limbs by their colour";
  if (of_drives > 0.0) {
    caption += fmt::format(", drives by lines along their axes that end in a dot, the longest {}",
                           response_text(unit, of_drives));
  }
  for (const ForcePose& one : poses) {
    caption += fmt::format("; at {}: {}", place_text(result, one.pose), forces_text(result, forces, one.pose));
  }
  section.picture(caption + ".", html + "</div>\n");
}

}  // namespace poesy
