#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/progress.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/run/checkpoints.h"
#include "engine/storage/checkpoint.h"

namespace poesy::app {

/// The options of the command line about checkpoints and about ending a run early.
struct ResumeOptions {
  bool resume = false;
  bool keep_checkpoint = false;  ///< true if the last checkpoint stays after the result was written
  std::string every = "10 s";
  std::string max_wall;  ///< time after which the run ends; empty: no limit

  void add_to(Command& command) {
    const auto group = [](CLI::Option* option) { option->group("Long runs"); };
    group(command.add_flag("--resume", resume, "continue the run that was stopped, from RESULT.h5.part"));
    group(command.add_value("--checkpoint-every", every, "TIME", "time between checkpoints of the run; default: 10 s"));
    group(command.add_value("--max-wall", max_wall, "TIME",
                            "stop after this time, to be resumed: \"90 s\", \"30 min\", \"2 h\""));
    group(command.add_flag("--keep-checkpoint", keep_checkpoint,
                           "keep RESULT.h5.part when done, so that --resume can add samples"));
  }
  /// Adds the options that differ from their defaults, except --resume, to the words of a command line.
  void add_words(std::vector<std::string>& words) const {
    if (every != ResumeOptions().every) words.insert(words.end(), {"--checkpoint-every", every});
    if (!max_wall.empty()) words.insert(words.end(), {"--max-wall", max_wall});
    if (keep_checkpoint) words.emplace_back("--keep-checkpoint");
  }
};

/// Completes the command line that starts a run again: adds to `words` the options that all commands with checkpoints
/// have, except --resume. options: the options of the command. Returns the command line as a shell reads it.
template <class Options>
std::string start_command(std::vector<std::string> words, const Options& options) {
  const auto add = [&](const std::string& name, const std::string& value) { words.insert(words.end(), {name, value}); };
  if (!options.result.empty()) add("-o", options.result);
  if (options.threads != 0) add("--threads", std::to_string(options.threads));
  if (options.seed) add("--seed", std::to_string(*options.seed));
  options.resume.add_words(words);
  if (options.quiet) words.emplace_back("--quiet");
  if (options.yes) words.emplace_back("--yes");
  return shell_command(words);
}

/// Manages the checkpoints of one run of the program. Without --resume, the run does not start if there are
/// checkpoints, because these may hold hours of work. With --resume, it does not start if there is a complete result
/// and no checkpoint.
class ResumableRun {
 public:
  /// Throws InputError or FileError if the run must not start. start_command: the command line that messages show for
  /// starting the run again, and with --resume for continuing it.
  ResumableRun(const ResumeOptions& options, const std::string& result_path, std::string start_command)
      : lock_(result_path),
        keep_checkpoint_(options.keep_checkpoint),
        command_(std::move(start_command)),
        files_(result_path),
        every_(duration_of(parse_duration(options.every, "--checkpoint-every"))) {
    if (!options.max_wall.empty()) end_ = Clock::now() + duration_of(parse_duration(options.max_wall, "--max-wall"));
    if (options.resume && !files_.exist()) {
      std::error_code ignored;
      if (std::filesystem::exists(result_path, ignored)) {
        throw InputError({.file = files_.newer()},
                         "there is no such checkpoint, and " + result_path + " is there: that run is complete",
                         "leave --resume out to run the study from the beginning");
      }
      say(Message::note, "there is no checkpoint " + files_.newer() + " to resume from: starting from the beginning");
    }
    if (const std::vector<std::string> left = files_.existing(); !options.resume && !left.empty()) {
      throw InputError({.file = left.front()}, "holds an earlier run of this result, finished or not",
                       "continue it with --resume, or remove it" + (left.size() > 1 ? " and " + left.back() : "") +
                           " to start afresh");
    }
  }
  ResumableRun(const ResumableRun&) = delete;
  ResumableRun& operator=(const ResumableRun&) = delete;

  /// Must be called before the work begins. If there is a checkpoint, restores it, and names it on stderr unless
  /// `quiet` is set and the newest checkpoint could be used. Throws InputError if the checkpoint belongs to another
  /// run.
  void start(const CheckpointIdentity& run, bool quiet) {
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
    checkpoints_.emplace([this] { return due(); }, [this](std::span<const ByteSource> all) { save(all); },
                         std::move(stages),
                         [this](std::size_t stage, ByteWriter& to) { files_.write_state(stage, to); });
    start_ = Clock::now();
    next_ = start_ + every_;
  }

  /// The checkpoints of the run. Precondition: start() was called.
  Checkpoints& checkpoints() { return *checkpoints_; }

  /// The time that this run took so far, plus that of the earlier runs that it continues.
  RunTime time() const { return {before_.wall + seconds_since(start_), before_.checkpoints + checkpoint_seconds_}; }

  /// Returns true if an earlier run left a checkpoint.
  bool continues() const { return files_.exist(); }

  /// Returns true if the time limit (--max-wall) ends the run within this number of seconds.
  bool ends_within(double seconds) const { return end_ && *end_ <= Clock::now() + duration_of(seconds); }

  /// Interrupts the run if the time limit (--max-wall) is reached.
  void check_time() const {
    if (end_ && Clock::now() >= *end_) interrupt();
  }

  /// Removes the checkpoints after the result was written, or keeps the last one if the user asked for it
  /// (keep_checkpoint).
  void finish() {
    if (keep_checkpoint_) {
      checkpoints_->save();
    } else {
      files_.remove();
    }
  }

  /// Removes the checkpoints after an error that would occur again if the run were continued, because they cannot lead
  /// to a result.
  void discard() { files_.remove(); }

  /// Writes a last checkpoint, if possible, after the run failed for lack of memory or because a file could not be
  /// written. Tells the user how to continue.
  void rescue() {
    try {
      if (!no_room_ && checkpoints_) checkpoints_->save();
    } catch (const FileError&) {
      // The error of the run is reported, and not that a checkpoint could not be written.
    } catch (const std::bad_alloc&) {
      // There is not enough memory for a checkpoint, either.
    }
    if (files_.exist()) {
      say(Message::note, "the work up to the last checkpoint is kept in " + files_.newer() +
                             "; when this is mended, continue with: " + resume_command());
    }
  }

  /// Tells the user how to continue the run after an interruption.
  void explain_interruption() const {
    say(Message::note, files_.exist() ? "interrupted; the work so far is kept in " + files_.newer() +
                                            ", continue with: " + resume_command()
                                      : "interrupted before anything was solved, start again with: " + command_);
  }

  /// Throws FileError because the state in the checkpoint cannot be read.
  [[noreturn]] void refuse_state(const BytesError& error) const {
    throw FileError(taken_, error.what(), "restore a copy, or move it away to start afresh");
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::string resume_command() const { return command_ + " --resume"; }

  /// Converts seconds to a clock duration. More than a century is shortened to a century, so that the number does not
  /// overflow.
  static Clock::duration duration_of(double seconds) {
    constexpr double kCentury = 3.2e9;
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(seconds, kCentury)));
  }

  bool due() {
    const Clock::time_point now = Clock::now();
    if (now < next_) return false;
    due_since_ = now;
    return true;
  }

  void save(std::span<const ByteSource> stages) {
    // The next checkpoint is not written before kLeastRatio times the duration of this one has passed. With this rule,
    // checkpoints take less than 1 % of the time, even if the last one took by far the longest.
    constexpr double kLeastRatio = 200.0;
    const Clock::time_point before = std::exchange(due_since_, std::nullopt).value_or(Clock::now());
    no_room_ = true;
    files_.write(identity_, time(), stages);
    no_room_ = false;
    const double seconds = seconds_since(before);
    checkpoint_seconds_ += seconds;
    next_ = Clock::now() + std::max(every_, duration_of(kLeastRatio * seconds));
  }

  RunLock lock_;
  bool keep_checkpoint_;
  std::string command_;
  CheckpointFiles files_;
  CheckpointIdentity identity_;
  std::string taken_;  ///< path of the checkpoint that start() restored
  Clock::duration every_;
  std::optional<Clock::time_point> end_;
  Clock::time_point start_;
  RunTime before_;  ///< time of the earlier runs that this run continues
  double checkpoint_seconds_ = 0.0;
  Clock::time_point next_;
  std::optional<Clock::time_point> due_since_;  ///< time at which the checkpoint that is being written was due
  bool no_room_ = false;                        ///< true if the last checkpoint could not be written
  std::optional<Checkpoints> checkpoints_;
};

/// Calls act(), which does the run. If it fails, keeps or removes the checkpoints, and tells the user which.
/// too_little: makes the error that the run needs more memory than there is.
template <class Act, class TooLittle>
auto run_to_end(ResumableRun& resumable, const Act& act, const TooLittle& too_little) -> decltype(act()) {
  try {
    return act();
  } catch (const BytesError& error) {
    resumable.refuse_state(error);
  } catch (const InputError&) {
    resumable.discard();
    throw;
  } catch (const FileError&) {
    resumable.rescue();
    throw;
  } catch (const std::bad_alloc&) {
    resumable.rescue();
    throw too_little();
  }
}

}  // namespace poesy::app
