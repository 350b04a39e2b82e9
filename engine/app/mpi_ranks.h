#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "engine/run/ranks/team.h"

namespace poesy::app {

/// The rank of this process, and the number of processes that an MPI launcher started.
struct Launch {
  std::size_t rank = 0;
  std::size_t size = 1;
};

/// Finds out from environment variables how this process was launched. mpirun of Open MPI sets OMPI_COMM_WORLD_*. srun
/// --mpi=pmix sets PMIX_RANK, and Slurm sets SLURM_* for every process of a job. Launchers of other MPIs set PMI_*.
/// None if these variables do not state the rank and the number of processes.
std::optional<Launch> find_launch();

/// Returns true if this process is the first one that a launcher started, or the only one.
bool is_first_process();

/// The ranks that a launcher started, connected to each other.
class LaunchedRanks : public Ranks {
 public:
  /// The number of ranks on this machine, including this process.
  virtual std::size_t on_this_machine() const = 0;
  /// Ends all ranks immediately with this exit code.
  [[noreturn]] virtual void abort(int exit_code) = 0;
};

/// Connects this process to the other ranks. The destructor of the returned object waits for all ranks and ends MPI.
/// Throws InputError if this program was built without MPI, or for an MPI that differs from the launcher's.
std::unique_ptr<LaunchedRanks> connect_ranks(const Launch& launch);

}  // namespace poesy::app
