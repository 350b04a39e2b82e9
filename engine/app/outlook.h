#pragma once

#include <cstddef>
#include <string>

#include "engine/model/model.h"
#include "engine/study/pose_selection.h"
#include "engine/study/study.h"

namespace poesy::app {

/// What a run has in memory at its peak, while it writes its result, without the program itself; bytes.
struct MemoryOutlook {
  std::size_t accumulators = 0;  ///< of the run; the heap does not give all of them back before the result is written
  std::size_t state = 0;         ///< the run as a checkpoint has it (run/checkpoints.h), kept until the end
  std::size_t result = 0;        ///< plain values
  std::size_t file = 0;          ///< the result file

  /// HDF5 composes the file in memory, and what is written is a copy of that (io/h5.h, File::image).
  std::size_t peak() const { return accumulators + state + result + 2 * file; }
};

/// What a study will ask of this machine.
struct Outlook {
  std::string solves;           ///< their number, and what it is the product of
  MemoryOutlook memory;         ///< beyond that of this program
  double thread_seconds = 0.0;  ///< that one thread would take for all solves
  double serial_seconds = 0.0;  ///< of what only one thread does: separating errors, composing the file
  double least = 1.0;           ///< share of the solves that are made in any case
};

/// Counts, and solves a few pieces of the study to see how long they take: about a quarter of a second.
Outlook outlook(const Study& study, const Model& model, const PoseSet& poses);

}  // namespace poesy::app
