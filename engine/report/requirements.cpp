#include "engine/report/requirements.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "engine/base/nan.h"
#include "engine/report/display.h"
#include "engine/report/drawn_errors.h"
#include "engine/study/study.h"

namespace poesy {
namespace {

constexpr std::string_view kPoses = "poses";
constexpr std::string_view kDrawn = "draws";
constexpr std::string_view kMetrics = "metrics";

/// Returns true if `setting` is the setting or section `name`, or belongs to this section.
bool is_of(std::string_view setting, std::string_view name) {
  return setting.starts_with(name) && (setting.size() == name.size() || setting[name.size()] == '.');
}

/// Returns true if a figure of merit depends on limits by which machines are judged.
bool judges_machines(std::string_view merit) {
  return merit == kYieldMerit || merit == kCostMerit || merit.starts_with(kLimitMerit);
}

/// Returns true if a setting is a limit on which the figure of merit depends. Precondition: judges_machines(merit).
bool is_its_limit(std::string_view setting, std::string_view merit) {
  constexpr std::string_view kLimits = "analysis.limits";
  if (!merit.starts_with(kLimitMerit)) return is_of(setting, kLimits);
  return is_of(setting, fmt::format("{}.{}", kLimits, merit.substr(kLimitMerit.size())));
}

/// The value of a trajectory without its number of poses: "file = path.csv, time = [0 s, 2 s]".
std::string without_points(std::string value) {
  const std::size_t begin = value.find("points = ");
  if (begin == std::string::npos) return value;
  const std::size_t end = value.find(", ", begin);
  return value.erase(begin, end == std::string::npos ? end : end + 2 - begin);
}

/// The settings of a result on which the figure of merit depends, with their values. The metric, and how errors are
/// drawn, are left out, because the result itself states them.
std::map<std::string, std::string> required_settings(const StoredResult& result, std::string_view merit) {
  std::map<std::string, std::string> list;
  for (const auto& [name, value] : readable_settings(result.study_text)) {
    const std::string_view topic = required_by(name, merit);
    if (!topic.empty() && topic != kMetrics && !is_of(name, "errors")) list.emplace(name, value);
  }
  return list;
}

/// Returns true if a setting of the poses is a reason why the poses of two results differ. in_a, in_b: values of the
/// setting in the results.
bool explains_poses(const std::string& name, const std::string& in_a, const std::string& in_b) {
  if (required_value(name, in_a) != required_value(name, in_b)) return true;
  // The content of a file may have changed under the same name. If only the numbers of points differ, they are the
  // reason, but they are not a requirement.
  const bool is_of_file = name == "poses.file" || (name == "poses.trajectory" && in_a.find("file = ") != in_a.npos);
  return is_of_file && in_a == in_b;
}

/// Adds to `others` the errors that both results have, but that only one of the results draws anew at each pose.
void add_draws_of_errors(const StoredResult& a, const StoredResult& b, std::vector<OtherRequirement>& others) {
  std::vector<std::string> only_in_a;
  std::vector<std::string> only_in_b;
  for (const auto& [p, q] : common(names_of(a.factors), names_of(b.factors))) {
    if (is_drawn_per_pose(a, p) == is_drawn_per_pose(b, q)) continue;
    (is_drawn_per_pose(a, p) ? only_in_a : only_in_b).push_back(a.factors[p].name);
  }
  const auto add = [&](const std::vector<std::string>& errors, Draws in_a, Draws in_b) {
    if (errors.empty()) return;
    others.push_back({kDrawn, "draws of " + some_names(errors, 3), std::string(name(in_a)), std::string(name(in_b))});
  };
  add(only_in_a, Draws::per_pose, Draws::per_machine);
  add(only_in_b, Draws::per_machine, Draws::per_pose);
}

/// A requirement with its values: "analysis.limits.gap: 0.15 mm in A, 0.2 mm in B", or its name alone if a value is
/// long.
std::string other_text(const OtherRequirement& other, char letter) {
  constexpr std::size_t kLong = 40;
  if (std::max(other.in_a.size(), other.in_b.size()) > kLong) return other.name;
  if (other.in_a.empty() && other.in_b.empty()) return other.name;
  const auto text = [](const std::string& value) { return value.empty() ? "none" : value; };
  return fmt::format("{}: {} in A, {} in {}", other.name, text(other.in_a), text(other.in_b), letter);
}

std::string left_out_text(double share) { return std::isnan(share) ? "a part" : percent_text(share); }

}  // namespace

double left_out_share(const StoredResult& result) {
  if (readable_setting(result.study_text, "poses", "select") == "boundary") {
    return some_out_of_reach(result.rejected) ? kNaN : 0.0;
  }
  if (result.candidates == 0) return 0.0;
  std::size_t count = 0;
  for (const RejectedPoses& one : result.rejected) count += one.count;
  return static_cast<double>(count) / static_cast<double>(result.candidates);
}

bool leave_out_otherwise(double a, double b) {
  constexpr double kAlike = 0.05;
  return !(std::abs(a - b) <= kAlike);
}

std::string required_value(const std::string& setting, const std::string& value) {
  return setting == "poses.trajectory" ? without_points(value) : value;
}

std::string_view required_by(std::string_view setting, std::string_view merit) {
  if (setting == "solver.metric") return kMetrics;
  if (judges_machines(merit)) {
    if (is_its_limit(setting, merit)) return "limits";
    const bool is_of_error = is_of(setting, "errors") && setting.ends_with(".draws");
    if (setting == "analysis.draws" || is_of_error) return kDrawn;
  }
  if (merit == kCostMerit && (setting == "analysis.yield" || setting == "analysis.confidence")) return "wanted yields";
  const bool is_number = is_of(setting, "poses.count") || setting == "poses.trajectory.points";
  return is_of(setting, kPoses) && !is_number ? kPoses : std::string_view();
}

std::vector<OtherRequirement> other_requirements(const StoredResult& a, const StoredResult& b, std::string_view merit,
                                                 PosesFrom poses) {
  const std::map<std::string, std::string> of_a = required_settings(a, merit);
  const std::map<std::string, std::string> of_b = required_settings(b, merit);
  std::map<std::string, std::pair<std::string, std::string>> both;
  for (const auto& [name, value] : of_a) both[name].first = value;
  for (const auto& [name, value] : of_b) both[name].second = value;
  const bool same_poses = a.poses == b.poses;
  std::vector<OtherRequirement> others;
  for (const auto& [name, values] : both) {
    const auto& [in_a, in_b] = values;
    const std::string_view topic = required_by(name, merit);
    const bool differs = topic == kPoses ? !same_poses && explains_poses(name, in_a, in_b) : in_a != in_b;
    if (differs) others.push_back({topic, name, required_value(name, in_a), required_value(name, in_b)});
  }
  const bool explained = std::ranges::find(others, kPoses, &OtherRequirement::topic) != others.end();
  if (poses == PosesFrom::table && !same_poses && !explained) others.push_back({kPoses, "--poses", "", ""});
  const double left_out_a = left_out_share(a);
  const double left_out_b = left_out_share(b);
  if (!same_poses && !explained && leave_out_otherwise(left_out_a, left_out_b)) {
    others.push_back({kPoses, "left out of the workspace", left_out_text(left_out_a), left_out_text(left_out_b)});
  }
  if (judges_machines(merit)) add_draws_of_errors(a, b, others);
  return others;
}

std::string topics_text(const std::vector<OtherRequirement>& others) {
  std::vector<std::string_view> topics;
  for (const OtherRequirement& other : others) {
    if (std::ranges::find(topics, other.topic) == topics.end()) topics.push_back(other.topic);
  }
  return fmt::format("{}", fmt::join(topics, " and "));
}

std::string others_text(const std::vector<OtherRequirement>& others, char letter) {
  std::vector<std::string> list;
  for (const OtherRequirement& other : others) list.push_back(other_text(other, letter));
  return fmt::format("the {} differ ({})", topics_text(others), fmt::join(list, "; "));
}

}  // namespace poesy
