#include "engine/app/resumable.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "engine/app/ending.h"
#include "engine/app/progress.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"

namespace poesy::app {
namespace {

/// A checkpoint that took a time to write is followed by another after so many of these at the earliest: under 1 %,
/// also when the last one is much the longest.
constexpr double kLeastRatio = 200.0;

/// A time that no run lasts stands for all that are longer, and for "never".
std::chrono::steady_clock::duration duration_of(double seconds) {
  constexpr double kCentury = 3.2e9;
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(std::min(seconds, kCentury)));
}

}  // namespace

void ResumeOptions::add_to(Command& command) {
  constexpr const char* kGroup = "Long runs";
  command.add_flag("--resume", resume, "continue the run that was stopped, from RESULT.h5.part")->group(kGroup);
  command.add_value("--checkpoint-every", every, "TIME", "time between checkpoints of the run; default: 10 s")
      ->group(kGroup);
  command
      .add_value("--max-wall", max_wall, "TIME", "stop after this time, to be resumed: \"90 s\", \"30 min\", \"2 h\"")
      ->group(kGroup);
  command
      .add_flag("--keep-checkpoint", keep_checkpoint, "keep RESULT.h5.part when done, so that --resume can add samples")
      ->group(kGroup);
}

ResumableRun::ResumableRun(const ResumeOptions& options, const std::string& result_path, std::string resume_command)
    : lock_(result_path),
      resume_(options.resume),
      keep_checkpoint_(options.keep_checkpoint),
      command_(std::move(resume_command)),
      files_(result_path),
      every_(duration_of(parse_duration(options.every, "--checkpoint-every"))) {
  if (!options.max_wall.empty()) end_ = Clock::now() + duration_of(parse_duration(options.max_wall, "--max-wall"));
  if (resume_ && !files_.exist()) {
    std::error_code ignored;
    const bool done = std::filesystem::exists(result_path, ignored);
    throw InputError({.file = files_.newer()},
                     done ? "there is no such checkpoint, and " + result_path + " is there: that run is complete"
                          : std::string("there is no such checkpoint to resume from"),
                     "leave --resume out to run the study from the beginning");
  }
  if (!resume_ && files_.exist()) {
    throw InputError({.file = files_.newer()}, "holds an earlier run of this result, finished or not",
                     "continue it with --resume, or remove it and " + files_.newer() + ".1 to start afresh");
  }
}

void ResumableRun::start(const CheckpointIdentity& run, bool quiet) {
  identity_ = run;
  std::vector<Bytes> stages;
  if (auto found = files_.find()) {
    check_continues(run, found->checkpoint.identity, found->path);
    if (!found->passed_over.empty()) {
      say(Message::note,
          files_.newer() + " " + found->passed_over + "; continuing from the one before, " + found->path);
    } else if (!quiet) {
      say(Message::note, "continuing from " + found->path);
    }
    taken_ = found->path;
    before_ = found->checkpoint.time;
    stages = std::move(found->checkpoint.stages);
  }
  checkpoints_.emplace([this] { return due(); }, [this](std::span<const Bytes> all) { save(all); }, std::move(stages));
  start_ = Clock::now();
  next_ = start_ + every_;
}

RunTime ResumableRun::time() const {
  return {before_.wall + std::chrono::duration<double>(Clock::now() - start_).count(),
          before_.checkpoints + checkpoint_seconds_};
}

void ResumableRun::check_time() const {
  if (end_ && Clock::now() >= *end_) interrupt();
}

bool ResumableRun::due() {
  const Clock::time_point now = Clock::now();
  if (now < next_) return false;
  due_since_ = now;
  return true;
}

void ResumableRun::save(std::span<const Bytes> stages) {
  const Clock::time_point before = std::exchange(due_since_, std::nullopt).value_or(Clock::now());
  no_room_ = true;
  files_.write(identity_, time(), stages);
  no_room_ = false;
  const Clock::time_point after = Clock::now();
  const double seconds = std::chrono::duration<double>(after - before).count();
  checkpoint_seconds_ += seconds;
  next_ = after + std::max(every_, duration_of(kLeastRatio * seconds));
}

void ResumableRun::finish() {
  if (keep_checkpoint_) {
    checkpoints_->save();
  } else {
    files_.remove();
  }
}

void ResumableRun::rescue() {
  try {
    if (!no_room_ && checkpoints_) checkpoints_->save();
  } catch (const FileError&) {
    // The message of the first trouble counts.
  }
  if (files_.exist()) {
    say(Message::note, "the work up to the last checkpoint is kept in " + files_.newer() +
                           "; when this is mended, continue with: " + command_);
  }
}

void ResumableRun::explain_interruption() const {
  say(Message::note, "interrupted; the work so far is kept in " + files_.newer() + ", continue with: " + command_);
}

void ResumableRun::refuse_state(const BytesError& error) const {
  throw FileError(taken_, error.what(), "restore a copy, or move it away to start afresh");
}

}  // namespace poesy::app
