#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "engine/run/ranks/team.h"

namespace poesy::app {

/// What a launcher of parallel programs says of this process.
struct Launch {
  std::size_t rank = 0;
  std::size_t size = 1;
};

/// From the environment: mpirun of Open MPI sets OMPI_COMM_WORLD_*; srun --mpi=pmix sets PMIX_RANK beside the SLURM_*
/// that every process of a job has; launchers of other MPIs set PMI_*. Nothing when there is no launcher.
std::optional<Launch> find_launch();

/// Whether this process is the first that a launcher started, or the only one.
bool is_first_process();

/// Ranks that a launcher started.
class LaunchedRanks : public Ranks {
 public:
  /// How many of them run on this machine, this one included.
  virtual std::size_t on_this_machine() const = 0;
  /// Ends all ranks at once.
  [[noreturn]] virtual void abort(int exit_code) = 0;
};

/// Joins the other ranks; when the object goes, MPI ends on all ranks together. Throws InputError when this program was
/// built without MPI, or for another one than the launcher's.
std::unique_ptr<LaunchedRanks> connect_ranks(const Launch& launch);

}  // namespace poesy::app
