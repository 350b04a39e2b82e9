#include "engine/report/html/robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <sstream>
#include <utility>

#include "engine/base/nan.h"
#include "engine/report/display.h"
#include "engine/report/sketch_picture.h"
#include "engine/report/sketch_words.h"

namespace poesy {
namespace {

constexpr std::size_t kMostPoses = 10;    // largest number of poses in a picture
constexpr std::size_t kShownAtOnce = 3;   // number of poses that are visible without scripts
constexpr std::size_t kMostErrors = 300;  // if a page has more errors, its picture shows no motions
constexpr std::size_t kOpenRows = 10;     // number of rows that the table of errors shows unfolded
constexpr double kMillimetres = 1e3;      // millimetres in a metre
// The largest motion is enlarged to at most this share of the height kSketchHeight; the factor of enlargement is
// rounded down.
constexpr double kShownMotion = 0.15;

/// A pose that the picture shows.
struct RobotPose {
  std::optional<std::size_t> pose;  ///< index among the poses of the result; none: home
  std::string why;                  ///< why the pose is shown
  Sketch sketch;
};

/// An error that the picture shows.
struct RobotError {
  std::size_t at;      ///< index among the errors of the result
  std::size_t factor;  ///< index among the factors of the model
  double share;        ///< share of the error (ErrorShares); NaN if it has none
};

bool finite(const Sketch& sketch) {
  const auto is_finite = [](const SketchVector& v) {
    return std::ranges::all_of(v, [](double c) { return std::isfinite(c); });
  };
  return is_finite(sketch.platform) && std::ranges::all_of(sketch.tool, is_finite) &&
         std::ranges::all_of(sketch.points, is_finite, &SketchedPoint::point) &&
         std::ranges::all_of(sketch.limbs, [&](const auto& limb) {
           return std::ranges::all_of(limb, is_finite, &SketchedJoint::point);
         });
}

/// The index of the largest number, or of the smallest if `sign` is -1; none if all numbers are unknown.
std::optional<std::size_t> extreme(std::span<const double> values, double sign) {
  std::optional<std::size_t> found;
  for (std::size_t m = 0; m < values.size(); ++m) {
    if (std::isfinite(values[m]) && (!found || sign * values[m] > sign * values[*found])) found = m;
  }
  return found;
}

/// Collects the poses for the picture: home, and poses where a quantity is largest or smallest. Each pose is taken
/// once, with all reasons.
class PoseChoice {
 public:
  PoseChoice(const StoredResult& result, const Model& model) : result_(&result), model_(&model) {
    add(std::nullopt, "home");
  }

  void add_extreme(std::span<const double> values, double sign, const std::string& why) {
    if (values.size() != result_->poses.size()) return;
    if (const std::optional<std::size_t> pose = extreme(values, sign)) add(pose, why);
  }

  std::vector<RobotPose> list;

 private:
  void add(std::optional<std::size_t> pose, const std::string& why) {
    const auto same = std::ranges::find(list, pose, &RobotPose::pose);
    if (same != list.end()) {
      same->why += "; " + why;
    } else if (list.size() < kMostPoses) {
      const std::span<const double> at = pose ? result_->poses[PoseIndex(*pose)] : std::span<const double>();
      if (std::optional<Sketch> sketch = sketch_at(*model_, at)) list.push_back({pose, why, std::move(*sketch)});
    }
  }

  const StoredResult* result_;
  const Model* model_;
};

std::vector<RobotPose> poses_of(const StoredResult& result, const Model& model, const ErrorShares& shares) {
  PoseChoice choice(result, model);
  if (!shares.pose_what.empty()) {
    choice.add_extreme(shares.at_poses, 1.0, "where " + shares.pose_what + " is largest");
    choice.add_extreme(shares.at_poses, -1.0, "where it is smallest");
  }
  choice.add_extreme(result.condition, 1.0, "nearest to a singular pose, by the condition number");
  for (std::size_t c = 0; c < result.pose_coordinates.size(); ++c) {
    std::vector<double> values;
    for (std::size_t m = 0; m < result.poses.size(); ++m) values.push_back(result.poses[PoseIndex(m)][c]);
    const std::string& name = result.pose_coordinates[c].name;
    choice.add_extreme(values, -1.0, "smallest " + name);
    choice.add_extreme(values, 1.0, "largest " + name);
  }
  return std::move(choice.list);
}

/// The errors of the result that the model has. If shares are known, the error with the largest share comes first, and
/// errors without a share come last.
std::vector<RobotError> errors_of(const StoredResult& result, const Model& model, const ErrorShares& shares) {
  const bool known = !shares.what.empty() && shares.values.size() == result.factors.size();
  std::vector<RobotError> list;
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    const std::optional<FactorIndex> factor = model.description().find_factor(result.factors[p].name);
    if (!factor) continue;
    const bool has_own = known && !std::isnan(shares.values[p]);
    list.push_back({p, factor->value, has_own ? std::max(0.0, shares.values[p]) : kNaN});
  }
  const auto rank = [](const RobotError& one) { return std::isnan(one.share) ? -1.0 : one.share; };
  if (known) std::ranges::stable_sort(list, std::ranges::greater(), rank);
  return list;
}

bool has_shares(const std::vector<RobotError>& errors) {
  return !errors.empty() && !std::isnan(errors.front().share) && errors.front().share > 0.0;
}

PartShares part_shares(const Sketch& sketch, const std::vector<RobotError>& errors) {
  PartShares parts(sketch);
  if (!has_shares(errors)) return parts;
  for (const RobotError& one : errors) {
    const SketchedError& error = sketch.errors[one.factor];
    const bool inside = error.after == error.before;
    double& sum = inside ? parts.joints[error.limb][error.after - 1] : parts.links[error.limb][error.after];
    if (!std::isnan(one.share)) sum += one.share;
    parts.largest = std::max(parts.largest, sum);
  }
  return parts;
}

/// A part of a limb between the joints `after` and `before` (see SketchedError), with the sum of the shares of the
/// errors in this part.
struct RankedPart {
  std::size_t limb;
  std::size_t after;
  std::size_t before;
  double share;
};

std::vector<RankedPart> ranked_parts(const PartShares& parts) {
  std::vector<RankedPart> list;
  for (std::size_t i = 0; i < parts.links.size(); ++i) {
    for (std::size_t j = 0; j < parts.links[i].size(); ++j) list.push_back({i, j, j + 1, parts.links[i][j]});
    for (std::size_t j = 0; j < parts.joints[i].size(); ++j) list.push_back({i, j + 1, j + 1, parts.joints[i][j]});
  }
  std::erase_if(list, [](const RankedPart& part) { return !(part.share > 0.0); });
  std::ranges::stable_sort(list, std::ranges::greater(), &RankedPart::share);
  return list;
}

std::string part_words(const Sketch& sketch, const RankedPart& part) {
  return fmt::format("limb {} {}", part.limb + 1, between_words(sketch, part.limb, part.after, part.before));
}

std::string error_words(const Sketch& sketch, const SketchedError& error, const Factor& factor) {
  return fmt::format("limb {}, {}: {}", error.limb + 1, between_words(sketch, error.limb, error.after, error.before),
                     axis_words(sketch, error, factor.name, factor.description));
}

/// The description of a picture in words, for screen readers.
std::string description(const Sketch& sketch, const PartShares& parts, const std::string& what) {
  constexpr std::size_t kMost = 3;
  std::vector<std::string> kinds;
  for (const auto& limb : sketch.limbs) {
    std::string kind;
    for (const SketchedJoint& joint : limb) kind += joint.type;
    kinds.push_back(std::move(kind));
  }
  std::string text = fmt::format("{} {}, with joints", counted(kinds.size(), "limb", "limbs"),
                                 sketch.ends.empty() ? "from base to platform" : "between bodies");
  for (std::size_t i = 0; i < kinds.size(); ++i) text += (i == 0 ? " " : ", ") + kinds[i];
  text += ".";
  const std::vector<RankedPart> ranked = ranked_parts(parts);
  for (std::size_t n = 0; n < std::min(kMost, ranked.size()); ++n) {
    text += fmt::format("{} {}, {}", n == 0 ? " The most of the " + what + ":" : ";", percent_text(ranked[n].share),
                        part_words(sketch, ranked[n]));
  }
  return ranked.empty() ? text : text + ".";
}

std::string title_of(const StoredResult& result, const RobotPose& pose) {
  return pose.pose ? pose_title(result, *pose.pose, pose.why) : "At " + pose.why;
}

/// Appends the 12 numbers of a frame: origin in mm, then the x, y and z axes.
void add_frame(const SketchedFrame& frame, std::vector<double>& to) {
  for (const double c : frame.origin) to.push_back(kMillimetres * c);
  for (const SketchVector& axis : frame.axes) to.insert(to.end(), axis.begin(), axis.end());
}

/// Appends the numbers of the frames of all limbs, and of the errors' own frames.
void add_frames(const Sketch& sketch, const std::vector<RobotError>& errors, std::vector<double>& to) {
  for (const auto& limb : sketch.frames) {
    for (const SketchedFrame& frame : limb) add_frame(frame, to);
  }
  for (const RobotError& one : errors) {
    if (const auto& own = sketch.errors[one.factor].own) add_frame(own->frame, to);
  }
}

/// The index of an error's frame among the frames of all limbs.
std::size_t frame_number(const Sketch& sketch, const SketchedError& error) {
  std::size_t number = error.frame;
  for (std::size_t i = 0; i < error.limb; ++i) number += sketch.frames[i].size();
  return number;
}

/// The largest displacement (m) that a motion of the platform gives to its joints, its origin, the tool and the named
/// points.
double displacement(const Sketch& sketch, const SketchTwist& motion) {
  std::vector<SketchVector> points = sketch.tool;
  points.push_back(sketch.platform);
  for (const SketchedPoint& named : sketch.points) points.push_back(named.point);
  for (const auto& limb : sketch.limbs) points.push_back(limb.back().point);
  double largest = 0.0;
  for (const SketchVector& p : points) {
    largest = std::max(largest, std::hypot(motion[3] + motion[1] * p[2] - motion[2] * p[1],
                                           motion[4] + motion[2] * p[0] - motion[0] * p[2],
                                           motion[5] + motion[0] * p[1] - motion[1] * p[0]));
  }
  return largest;
}

/// Adds to `robot` the motions of the limbs' ends if an error has the size of one standard deviation, and the factor by
/// which the picture enlarges motions.
void add_motions(const StoredResult& result, const std::vector<RobotPose>& poses, const std::vector<RobotError>& errors,
                 Robot& robot, ArrayPool& pool) {
  if (result.factor_sigma.size() != result.factors.size() || errors.size() > kMostErrors) return;
  const std::size_t limbs = poses.front().sketch.limbs.size();
  std::vector<double> numbers;
  double largest = 0.0;
  for (const RobotPose& pose : poses) {
    for (const RobotError& one : errors) {
      const SketchedError& error = pose.sketch.errors[one.factor];
      for (std::size_t i = 0; i < limbs; ++i) {
        SketchTwist motion{};
        motion.fill(kNaN);
        if (!error.motions.empty()) motion = error.motions[error.motions.size() == 1 ? 0 : i];
        for (double& component : motion) component *= result.factor_sigma[one.at];
        const double moved = displacement(pose.sketch, motion);
        if (std::isfinite(moved)) largest = std::max(largest, moved);
        for (std::size_t c = 0; c < motion.size(); ++c) numbers.push_back((c < 3 ? 1.0 : kMillimetres) * motion[c]);
      }
    }
  }
  if (!(largest > 0.0)) return;
  robot.limbs = limbs;
  robot.motions = pool.add("robot_motions", numbers);
  robot.exaggeration = rounded_down(kShownMotion * kSketchHeight / (robot.scale * kMillimetres) / largest);
}

/// Returns true if each error has a share of its own. Errors that are ranked in groups or parts have none.
bool has_own_shares(std::span<const RobotError> errors, const ErrorShares& shares) {
  return shares.joined.empty() && has_shares({errors.begin(), errors.end()});
}

Robot robot_figure(const StoredResult& result, const Model& model, const std::vector<RobotPose>& poses,
                   const std::vector<RobotError>& errors, const ErrorShares& shares, const SketchView& view,
                   ArrayPool& pool) {
  Robot robot{.yaw = view.yaw,
              .pitch = view.pitch,
              .scale = view.scale / kMillimetres,
              .centre = {},
              .z_is_down = view.z_is_down};
  for (const double c : view.centre) robot.centre.push_back(kMillimetres * c);
  std::vector<double> frames;
  for (const RobotPose& pose : poses) {
    robot.poses.push_back(title_of(result, pose));
    add_frames(pose.sketch, errors, frames);
  }
  robot.frames = pool.add("robot_frames", frames);
  const Sketch& home = poses.front().sketch;
  std::size_t next_own = 0;  // index of the next own frame of an error
  for (const auto& limb : home.frames) next_own += limb.size();
  for (const RobotError& one : errors) {
    const Factor& factor = model.description().factors[one.factor];
    const SketchedError& error = home.errors[one.factor];
    const bool sized = result.factor_sigma.size() == result.factors.size();
    robot.errors.push_back({factor.name, error_words(home, error, factor),
                            error.own ? next_own++ : frame_number(home, error), error.own ? 2 : error.axis,
                            error.own ? error.own->turns : error.turns, error.own.has_value(),
                            sized ? response_text(result.factors[one.at], result.factor_sigma[one.at]) : "",
                            std::isnan(one.share) || !shares.joined.empty() ? "" : percent_text(one.share)});
  }
  add_motions(result, poses, errors, robot, pool);
  return robot;
}

/// The description that the mechanism's file gives to an error; empty if it gives none.
std::string own_words(const StoredResult& result, std::size_t error) {
  const std::string& words = result.factors[error].description;
  return result.mechanism_text.find(words) == std::string::npos ? std::string() : words;
}

/// A table of the errors with their places, with the descriptions that the mechanism's file gives them, and with their
/// shares if has_own_shares() is true.
Table errors_table(const StoredResult& result, const Sketch& sketch, std::span<const RobotError> errors,
                   const ErrorShares& shares) {
  Table table{.name = "where_errors_are",
              .caption = "Where each error is",
              .columns = {text_column("error", "error"), text_column("limb", "limb", 1), text_column("part", "part", 2),
                          text_column("axis", "motion", 3)}};
  const bool has_words =
      std::ranges::any_of(errors, [&](const RobotError& one) { return !own_words(result, one.at).empty(); });
  if (has_words) table.columns.insert(table.columns.begin() + 1, text_column("words", "what it is"));
  const bool shared = has_own_shares(errors, shares);
  if (shared) table.columns.push_back(percent_column("share", "share"));
  for (const RobotError& one : errors) {
    const SketchedError& error = sketch.errors[one.factor];
    std::vector<Cell>& row = table.rows.emplace_back();
    row.push_back(text_cell(result.factors[one.at].name));
    if (has_words) row.push_back(text_cell(own_words(result, one.at)));
    row.push_back(text_cell(std::to_string(error.limb + 1)));
    row.push_back(text_cell(between_words(sketch, error.limb, error.after, error.before)));
    row.push_back(
        text_cell(axis_words(sketch, error, result.factors[one.at].name, result.factors[one.at].description)));
    if (shared) row.push_back(percent_cell(one.share));
  }
  table.notes.emplace_back(
      "joints count from the base; frame j moves with the j-th axis of the limb, its z is about or along that axis");
  if (shared) table.notes.push_back("share: " + shares.what);
  return table;
}

Table parts_table(const Sketch& sketch, const PartShares& parts, const ErrorShares& shares) {
  Table table{.name = "shares_of_parts",
              .caption = "The shares of all errors of a part together, as they are coloured",
              .columns = {text_column("part", "part"), percent_column("share", shares.what)}};
  for (const RankedPart& part : ranked_parts(parts)) {
    table.rows.push_back({text_cell(part_words(sketch, part)), percent_cell(part.share)});
  }
  return table;
}

/// The legend of the colours, from a share of 0 to the largest share.
std::string legend(const PartShares& parts, const std::string& what) {
  return parts.largest > 0.0 ? colour_legend(what, "0 %", percent_text(parts.largest)) : std::string();
}

/// The pictures of all poses. The first kShownAtOnce pictures are visible without scripts.
std::string pictures(const StoredResult& result, const std::vector<RobotPose>& poses,
                     const std::vector<RobotError>& errors, const SketchView& view, const PartShares& parts,
                     const ErrorShares& shares) {
  std::string html = "<div class=\"robot-poses\">\n";
  const std::size_t none = poses.front().sketch.errors.size();
  const std::size_t mark = has_own_shares(errors, shares) ? errors.front().factor : none;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::string title = title_of(result, poses[k]);
    html += fmt::format("<div class=\"robot-pose\"{}>{}\n{}</div>\n", k < kShownAtOnce ? "" : " hidden",
                        element("p", title, "class=\"plot-title\""),
                        svg_picture(fmt::format("robot-{}", k), {kSketchWidth, view.height}, title,
                                    description(poses[k].sketch, parts, shares.what),
                                    turnable_sketch(poses[k].sketch, view, parts, mark)));
  }
  return html + "</div>\n";
}

std::string caption(const StoredResult& result, const Sketch& home, const std::vector<RobotError>& errors,
                    const ErrorShares& shares) {
  std::string text =
      "The mechanism in the frames of the model that is solved: the base is dashed, the platform has a plain outline, "
      "joints are drawn by their kind (circle R, square P, circle with a cross U, circle in a circle S, diamond H, "
      "circle in a square C), filled where a drive holds them; a limb's number is beside its first joint.";
  if (!home.features.empty()) {
    text += " Features of the drawing are bars along axes, plates in planes, and dots, with their zones as tooltips.";
  }
  if (!has_shares(errors)) return text;
  text += fmt::format(" Links and joints are coloured by the sum over their errors of the {}.", shares.what);
  if (std::isnan(errors.back().share)) text += " Errors without a share of their own have no colour.";
  if (!shares.joined.empty()) {
    text += fmt::format(" That of a {0} is divided evenly among its errors, because the {0} is ranked as a whole.",
                        shares.joined);
  }
  if (has_own_shares(errors, shares)) {
    text += fmt::format(" The strong line is the axis of {}; a displacement is drawn at the frame to which it belongs.",
                        result.factors[errors.front().at].name);
  }
  if (!readable_setting(result.study_text, "analysis", "calibrated").empty()) {
    text += " Displacements are shown before the actuators are corrected.";
  }
  return text;
}

}  // namespace

std::vector<double> divided_shares(const StoredResult& result, const std::vector<std::string>& members,
                                   std::span<const double> shares) {
  std::vector<double> values(result.factors.size(), 0.0);
  for (std::size_t n = 0; n < members.size(); ++n) {
    std::vector<std::size_t> found;
    std::istringstream list(members[n]);
    for (std::string name; list >> name;) {
      const auto at = std::ranges::find(result.factors, name, &NamedUnit::name);
      if (at != result.factors.end()) found.push_back(static_cast<std::size_t>(at - result.factors.begin()));
    }
    for (const std::size_t p : found) values[p] += shares[n] / static_cast<double>(found.size());
  }
  return values;
}

bool has_pictures(const ReportedResult& reported) {
  return reported.model != nullptr &&
         reported.model->description().pose_coordinates.size() == reported.stored.pose_coordinates.size();
}

std::optional<Sketch> sketch_at(const Model& model, std::span<const double> pose) {
  if (!pose.empty() && model.unreachable(pose)) return std::nullopt;
  std::optional<Sketch> sketch = model.sketch(pose);
  return sketch && finite(*sketch) ? sketch : std::nullopt;
}

std::string pose_title(const StoredResult& result, std::size_t pose, const std::string& why) {
  return fmt::format("P{}: {}", place_text(result, pose).substr(1), why);
}

std::string colour_legend(const std::string& what, const std::string& least, const std::string& largest) {
  return fmt::format(
      "<p class=\"robot-legend\"><span>{}:</span> <span class=\"robot-scale\">{}<i "
      "class=\"robot-ramp\"></i>{}</span></p>\n",
      escaped("Colour and thickness, " + what), escaped(least), escaped(largest));
}

void add_robot(const ReportedResult& reported, const ErrorShares& shares, Page& page, Section& section) {
  if (!has_pictures(reported)) return;
  const StoredResult& result = reported.stored;
  const Model& model = *reported.model;
  const std::vector<RobotPose> poses = poses_of(result, model, shares);
  if (poses.empty() || poses.front().pose) return;
  const Sketch& home = poses.front().sketch;
  const std::vector<RobotError> errors = errors_of(result, model, shares);
  std::vector<Sketch> sketches;
  for (const RobotPose& pose : poses) sketches.push_back(pose.sketch);
  const SketchView view = sketch_view(sketches, kSketchYaw, kSketchPitch, kTallHeight);
  const PartShares parts = part_shares(home, errors);
  page.figures.figures["robot"] = robot_figure(result, model, poses, errors, shares, view, page.figures.pool);
  section.figure("robot", caption(result, home, errors, shares),
                 legend(parts, shares.what) + pictures(result, poses, errors, view, parts, shares));
  if (errors.empty()) return;
  const std::size_t open = std::min(kOpenRows, errors.size());
  section.table(errors_table(result, home, std::span(errors).first(open), shares));
  if (open < errors.size()) {
    Table others = errors_table(result, home, std::span(errors).subspan(open), shares);
    others.name = "where_other_errors_are";
    section.folded("The other errors", others);
  }
  if (has_shares(errors)) section.folded("The shares of the parts", parts_table(home, parts, shares));
}

}  // namespace poesy
