#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "engine/run/ranks/team.h"

namespace poesy::app {

/// The place of this process among those that a launcher of parallel programs started.
struct Launch {
  std::size_t rank = 0;
  std::size_t size = 1;
};

/// Reads the environment: mpirun of Open MPI sets OMPI_COMM_WORLD_*; srun --mpi=pmix sets PMIX_RANK, beside the SLURM_*
/// that every process of a job has; launchers of other MPIs set PMI_*. None if there is no launcher.
std::optional<Launch> find_launch();

/// Whether this process is the first that a launcher started, or the only one.
bool is_first_process();

/// The ranks that a launcher started.
class LaunchedRanks : public Ranks {
 public:
  /// The number of ranks on this machine, including this one.
  virtual std::size_t on_this_machine() const = 0;
  /// Ends all ranks immediately.
  [[noreturn]] virtual void abort(int exit_code) = 0;
};

/// Connects to the other ranks. The destructor finalises MPI on all ranks together. Throws InputError if this program
/// was built without MPI, or for another MPI than the launcher's.
std::unique_ptr<LaunchedRanks> connect_ranks(const Launch& launch);

}  // namespace poesy::app
