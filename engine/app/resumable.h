#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "engine/app/command_line.h"
#include "engine/files/checkpoint.h"
#include "engine/run/checkpoints.h"

namespace poesy::app {

/// How a run keeps itself and ends early, as the command line says.
struct ResumeOptions {
  bool resume = false;
  bool keep_checkpoint = false;  ///< the last checkpoint stays beside a finished result
  std::string every = "10 s";
  std::string max_wall;  ///< empty: no limit

  void add_to(Command& command);
};

/// The checkpoints of one run of the program. A run without --resume refuses to start where there are some, for they
/// are hours of somebody's work; with it, where there are none.
class ResumableRun {
 public:
  /// Throws InputError or FileError when the run must not start. resume_command: for messages.
  ResumableRun(const ResumeOptions& options, const std::string& result_path, std::string resume_command);
  ResumableRun(const ResumableRun&) = delete;
  ResumableRun& operator=(const ResumableRun&) = delete;

  /// Takes up the checkpoint, if the run is to. Throws InputError when it is not one of this run. Says what it takes on
  /// stderr, unless quiet, but always when it is not the newest.
  void start(const CheckpointIdentity& run, bool quiet);
  /// Those to run with. Precondition: started.
  Checkpoints& checkpoints() { return *checkpoints_; }
  /// That all parts of the run took since they were started.
  RunTime time() const;
  /// Interrupts the run when its time is over.
  void check_time() const;

  /// The result is there: removes the checkpoints, or keeps the last one.
  void finish();
  /// The result could not be written: keeps the last state if that is possible, and says what to do.
  void rescue();
  /// The run was interrupted: says what to do.
  void explain_interruption() const;
  /// The state of the checkpoint that was taken up is not one.
  [[noreturn]] void refuse_state(const BytesError& error) const;

 private:
  using Clock = std::chrono::steady_clock;

  bool due();
  void save(std::span<const Bytes> stages);

  RunLock lock_;
  bool resume_;
  bool keep_checkpoint_;
  std::string command_;
  CheckpointFiles files_;
  CheckpointIdentity identity_;
  std::string taken_;  ///< the file that was taken up
  Clock::duration every_;
  std::optional<Clock::time_point> end_;
  Clock::time_point start_;
  RunTime before_;  ///< that earlier parts of the run took
  double checkpoint_seconds_ = 0.0;
  Clock::time_point next_;
  std::optional<Clock::time_point> due_since_;  ///< when the checkpoint was asked for that is being made
  bool no_room_ = false;                        ///< the last checkpoint could not be written
  std::optional<Checkpoints> checkpoints_;
};

}  // namespace poesy::app
