#include <string>

#include "engine/app/mpi_ranks.h"
#include "engine/base/error.h"

namespace poesy::app {

std::unique_ptr<LaunchedRanks> connect_ranks(const Launch& launch) {
  throw InputError({}, "a launcher started " + std::to_string(launch.size) + " processes, but this poesy has no MPI",
                   "build it with -DPOESY_MPI=ON, for which Debian has libopenmpi-dev; or start one process");
}

}  // namespace poesy::app
