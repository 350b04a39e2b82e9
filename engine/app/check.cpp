#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>

#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/duration.h"
#include "engine/app/exit_code.h"
#include "engine/app/outlook.h"
#include "engine/io/error_words.h"
#include "engine/io/study_file.h"
#include "engine/run/runner.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

/// What a trajectory asks of the mechanism; empty for other poses.
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

std::string time_text(const Outlook& expected, std::size_t threads) {
  const double solves = expected.thread_seconds / static_cast<double>(threads);
  const std::string most = "about " + readable_duration(solves + expected.serial_seconds);
  if (expected.least == 1.0) return most;
  return "at least about " + readable_duration(expected.least * solves + expected.serial_seconds) + ", at most " + most;
}

/// Bytes that this process has had in memory at its peak: with the model, the poses and a solver, as a run has them.
double own_peak() {
  constexpr double kUnit = 1024.0;  // of ru_maxrss
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return kUnit * static_cast<double>(usage.ru_maxrss);
}

std::string cost_text(const Outlook& expected) {
  const std::size_t threads = resolved_threads(0);
  return fmt::format(
      "# memory: about {:.3g} MB at the peak, when the result file of about {:.3g} MB is written\n"
      "# time: {} on {} threads of this machine\n",
      (own_peak() + static_cast<double>(expected.memory.peak())) / 1e6, static_cast<double>(expected.memory.file) / 1e6,
      time_text(expected, threads), threads);
}

int check(const std::string& path) {
  const Study study = read_study(path, registry(), StudyUse::run);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const SelectedPoses poses = select_poses(study.poses, *model);
  std::fputs(resolved_text(study).c_str(), stdout);
  const Outlook expected = outlook(study, *model, poses.poses);
  std::fputs(fmt::format("\n# valid: {}\n{}", expected.solves, cost_text(expected)).c_str(), stdout);
  if (const std::string held = held_errors_text(study); !held.empty()) std::fputs(("# " + held + "\n").c_str(), stdout);
  for (const std::string& unusual : model->unusual_geometry()) {
    std::fputs(("# hint: " + unusual + "; is that meant?\n").c_str(), stdout);
  }
  std::fputs(trajectory_line(poses, study.model()).c_str(), stdout);
  for (const RejectedPoses& rejected : poses.rejected) {
    std::fputs(fmt::format("# rejected: {} candidate poses, {}\n", rejected.count, rejected.reason).c_str(), stdout);
  }
  return kDone;
}

}  // namespace

void add_check(CLI::App& program, Action& action) {
  auto study = std::make_shared<std::string>();
  CLI::App* command =
      program.add_subcommand("check", "validate a study; print it resolved, with its solves, memory and time");
  command->add_option("study", *study, "study file (TOML)")->required()->type_name("STUDY.toml");
  command->footer(footer("", {{"is it valid, and how long will it take?", "poesy check study.toml"}}));
  command->callback([study, &action] { action = [study] { return check(*study); }; });
}

}  // namespace poesy::app
