#include "engine/app/run_on_ranks.h"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>

#include "engine/app/exit_code_of.h"
#include "engine/app/mpi_ranks.h"

namespace poesy::app {
namespace {

/// How long the other ranks may take to end their parts after rank 0 has ended the run.
std::chrono::seconds patience(int exit_code) { return std::chrono::seconds(exit_code == kDone ? 60 : 10); }

/// The processors that this process may use: those that the launcher bound it to, or its part of the machine's.
std::size_t processors_of_rank(std::size_t ranks_on_this_machine) {
  const auto all = static_cast<std::size_t>(std::max(1L, sysconf(_SC_NPROCESSORS_ONLN)));
  cpu_set_t allowed;
  const bool known = pthread_getaffinity_np(pthread_self(), sizeof allowed, &allowed) == 0;
  const std::size_t bound = known ? static_cast<std::size_t>(CPU_COUNT(&allowed)) : all;
  return bound < all ? bound : std::max<std::size_t>(1, all / ranks_on_this_machine);
}

}  // namespace

int run_on_ranks(const Launch& launch, const RankBody& body) {
  const std::unique_ptr<LaunchedRanks> ranks = connect_ranks(launch);
  const std::size_t processors = processors_of_rank(ranks->on_this_machine());
  Team team(*ranks);
  if (!team.leads()) return team.follow([&] { body(team, processors); });
  const int code = exit_code_of([&] { return body(team, processors); });
  if (!team.dismiss(code, patience(code))) ranks->abort(code);
  return code;
}

int explain_leaving(const Team& team) {
  if (!team.left()) return kInterrupted;
  switch (team.left()->reason) {
    case LeaveReason::stopped:
      return complain(team.left()->text, kInterrupted);
    case LeaveReason::bad_input:
      return complain(team.left()->text, kBadInput);
    case LeaveReason::file_trouble:
      return complain(team.left()->text, kFileTrouble);
    case LeaveReason::internal:
      break;
  }
  return complain(team.left()->text, kInternalError);
}

}  // namespace poesy::app
