#pragma once

#include <cstddef>
#include <functional>

#include "engine/app/launch.h"
#include "engine/run/team.h"

namespace poesy::app {

/// What one rank does; rank 0's exit code counts. default_threads: where the command line says nothing.
using RankBody = std::function<int(Team& team, std::size_t default_threads)>;

/// Runs the body on this rank, together with all others. The exit code, which is the same on all of them. Rank 0 alone
/// speaks.
int run_on_ranks(const Launch& launch, const RankBody& body);

/// Says why a rank left, if one did; the run's exit code. Precondition: the run was interrupted.
int explain_leaving(const Team& team);

}  // namespace poesy::app
