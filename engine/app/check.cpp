#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/expected_time.h"
#include "engine/app/progress.h"
#include "engine/app/results.h"
#include "engine/app/terminal.h"
#include "engine/kinds/corner_machines.h"
#include "engine/kinds/study_file.h"
#include "engine/kinds/study_run.h"
#include "engine/run/run_options.h"
#include "engine/storage/content_hash.h"
#include "engine/storage/h5.h"
#include "engine/study/bare_numbers.h"
#include "engine/study/mechanism_doubts.h"
#include "engine/study/poses/corners.h"
#include "engine/study/study.h"
#include "engine/study/study_file.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

/// A line on a trajectory: its number of poses, its times, and the range of each coordinate; empty if the poses are not
/// on a trajectory.
std::string trajectory_line(const SelectedPoses& poses, const ModelDescription& model) {
  if (poses.time.empty()) return {};
  std::string text = fmt::format("# trajectory: {} poses from {:.6g} s to {:.6g} s", poses.poses.size(),
                                 poses.time.front(), poses.time.back());
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    const std::vector<double> values = poses.poses.column(c);
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    text += fmt::format(", {} {} to {}", coordinate.name, readable_text({*least, coordinate.dimension}, 6),
                        readable_text({*most, coordinate.dimension}, 6));
  }
  return text + "\n";
}

/// A line on the range of each drive's displacement at the poses of the study and at the corners of its workspace;
/// empty if the mechanism has no drives.
std::string travel_line(const Model& model, const PoseSet& poses, const PoseSet& corners) {
  const std::vector<JointDisplacement>& joints = model.description().joints;
  std::vector<Range> ranges(joints.size(),
                            {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
  const auto extend = [&](const PoseSet& set) {
    for (std::size_t m = 0; m < set.size(); ++m) {
      const std::vector<double> displacements = model.joint_displacements(set[PoseIndex(m)]);
      for (std::size_t j = 0; j < ranges.size(); ++j) {
        ranges[j].lower = std::min(ranges[j].lower, displacements[j]);
        ranges[j].upper = std::max(ranges[j].upper, displacements[j]);
      }
    }
  };
  extend(poses);
  extend(corners);
  std::vector<std::string> drives;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!joints[j].has_drive) continue;
    drives.push_back(fmt::format("{} from {} to {}", joints[j].name,
                                 readable_text({ranges[j].lower, joints[j].dimension}, 4),
                                 readable_text({ranges[j].upper, joints[j].dimension}, 4)));
  }
  if (drives.empty()) return {};
  return fmt::format("# travel of the drives from home, at these poses{}: {}\n",
                     corners.size() > 0 ? " and at the corners of the workspace" : "", fmt::join(drives, ", "));
}

/// A line on the machines that miss a limit only at a corner of the workspace (corners_text()); empty if these are not
/// known.
std::string corners_line(const Study& study, const Model& model, const PoseSet& poses, const PoseSet& corners) {
  const std::optional<CornerMachines> found = corner_machines(study, model, poses, corners);
  return found ? fmt::format("# corners: {}\n", corners_text(*found, study.model())) : std::string();
}

using Clock = std::chrono::steady_clock;

/// The time that one thread needs for this work, s. It is estimated from 1 to 64 pieces of the work. After about
/// `longest` seconds no further piece is begun.
double measured_seconds(const WorkOutlook& work, double longest) {
  constexpr std::size_t kPieces = 64;
  if (work.prepare) work.prepare();
  const Clock::time_point start = Clock::now();
  double done = 0.0;
  for (std::size_t n = 0; n < kPieces && (n == 0 || seconds_since(start) < longest); ++n) {
    // The first piece is in the middle of the work. Each further piece is a step of the golden ratio later (modulo 1),
    // which spreads any number of pieces evenly.
    const double at = 0.5 + static_cast<double>(n) * 0.6180339887498949;
    done += work.do_piece(at - std::floor(at));
  }
  return work.times * seconds_since(start) / done;
}

double measured_seconds(const std::vector<WorkOutlook>& all, double longest) {
  double sum = 0.0;
  for (const WorkOutlook& work : all) sum += measured_seconds(work, longest);
  return sum;
}

/// The time that one thread needs to compose and hash one byte of a result file, s.
double composing_seconds() {
  constexpr std::size_t kNumbers = 1 << 17U;
  const std::vector<double> numbers(kNumbers, 1.0);
  const Clock::time_point start = Clock::now();
  h5::File file = h5::File::in_memory();
  file.write<double>("/numbers", {kNumbers}, numbers);
  static_cast<void>(content_sha256(file));
  return seconds_since(start) / static_cast<double>(kNumbers * sizeof(double));
}

std::string time_text(const ExpectedTime& time) {
  const std::string most = "about " + readable_duration(time.most);
  return time.least == time.most ? most : "at least about " + readable_duration(time.least) + ", at most " + most;
}

/// The peak memory of this process so far, bytes. It includes the model, the poses and a solver, as the peak of a run
/// does.
double own_peak() {
  constexpr double kUnit = 1024.0;  // unit of ru_maxrss, bytes
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return kUnit * static_cast<double>(usage.ru_maxrss);
}

std::string cost_text(const Outlook& expected) {
  const std::size_t threads = resolved_threads(0);
  // The time is measured before own_peak() is called, so that the peak includes the memory of a solver.
  const ExpectedTime time = expected_time(expected, threads, 0.25);
  return fmt::format(
      "# memory: about {:.3g} MB at the peak, when the result file of about {:.3g} MB is written\n"
      "# time: {} on {} threads of this machine{}\n",
      (own_peak() + static_cast<double>(expected.memory.peak())) / 1e6, static_cast<double>(expected.memory.file) / 1e6,
      time_text(time), threads, time.least > kLongRun ? "; poesy run asks before it starts, or wants --yes" : "");
}

/// One line for each of the most frequent reasons for which candidate poses were rejected, and one for all others.
std::string rejected_lines(std::span<const RejectedPoses> rejected) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (const RejectedPoses& one : rejected.first(std::min(kMost, rejected.size()))) {
    text += fmt::format("# rejected: {} candidate poses, {}\n", one.count, one.reason);
  }
  if (rejected.size() <= kMost) return text;
  std::size_t rest = 0;
  for (const RejectedPoses& one : rejected.subspan(kMost)) rest += one.count;
  return text + fmt::format("# rejected: {} candidate poses, for {} further reasons\n", rest, rejected.size() - kMost);
}

int check(const std::string& path) {
  const Study study = read_study(path, registry(), StudyUse::run);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const SelectedPoses poses = find_poses(study, *model, {}).value();
  for (const std::string& doubt : all_doubts(study, *model, poses)) say(Message::warning, doubt);
  print(resolved_text(study));
  const Outlook expected = outlook(study, *model, poses.poses);
  print(fmt::format("\n# valid: {}\n{}", expected.solves, cost_text(expected)));
  for (const std::string& note : study_notes(study)) print("# " + note + "\n");
  for (const std::string& line : model->mobility()) print("# mobility: " + line + "\n");
  for (const std::string& remark : model->remarks()) print("# " + remark + "\n");
  for (const std::string& unusual : model->unusual_errors()) print("# hint: " + asked_back(unusual) + "\n");
  print(trajectory_line(poses, study.model()));
  const PoseSet corners = feasible_corners(study.poses, *model);
  print(travel_line(*model, poses.poses, corners));
  print(corners_line(study, *model, poses.poses, corners));
  print(rejected_lines(poses.rejected));
  return kDone;
}

}  // namespace

ExpectedTime expected_time(const Outlook& expected, std::size_t threads, double seconds) {
  const WorkSeconds work{.shared = measured_seconds(expected.shared, seconds),
                         .merging = measured_seconds(expected.merging, seconds),
                         .by_one = measured_seconds(expected.by_one, 0.0) +
                                   static_cast<double>(expected.memory.file) * composing_seconds()};
  return {.least = work.on(threads, expected.least), .most = work.on(threads)};
}

Command& add_check(Command& program) {
  const auto [command, study] =
      program.add_command("check", "validate a study; print it resolved, with its solves, memory and time", check);
  command.add_value("study", study, "STUDY.toml", "study file (TOML)")->required();
  command.examples = {{"is it valid, and how long will it take?", "poesy check study.toml"}};
  return command;
}

}  // namespace poesy::app
