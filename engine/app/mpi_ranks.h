#pragma once

#include <cstddef>
#include <memory>

#include "engine/app/launch.h"
#include "engine/run/ranks.h"

namespace poesy::app {

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
