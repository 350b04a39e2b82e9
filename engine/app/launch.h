#pragma once

#include <cstddef>
#include <optional>

namespace poesy::app {

/// What a launcher of parallel programs says of this process.
struct Launch {
  std::size_t rank = 0;
  std::size_t size = 1;
};

/// From the environment: mpirun of Open MPI sets OMPI_COMM_WORLD_*; srun --mpi=pmix sets PMIX_RANK beside the SLURM_*
/// that every process of a job has; launchers of other MPIs set PMI_*. Nothing when there is no launcher.
std::optional<Launch> find_launch();

}  // namespace poesy::app
