#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/study/study.h"

namespace poesy {

/// What a run has in memory at its peak, while it writes its result, without the program itself; bytes.
struct MemoryOutlook {
  std::size_t accumulators = 0;  ///< of the run; the heap does not give all of them back before the result is written
  std::size_t state = 0;         ///< the run as a checkpoint has it (run/checkpoints.h), kept until the end
  std::size_t result = 0;        ///< plain values
  std::size_t file = 0;          ///< the result file

  /// HDF5 composes the file in memory, and what is written is a copy of that (files/h5.h, File::image).
  std::size_t peak() const { return accumulators + state + result + 2 * file; }
};

/// Work of a study that can be tried in pieces, to measure how fast a machine does it.
struct WorkOutlook {
  /// Does the piece that begins at this share of the work, 0 <= at < 1, on this thread. Gives the share that it was.
  std::function<double(double at)> do_piece;
  double times = 1.0;  ///< how much the study does of this work
};

/// What a study will ask of a machine. Refers to the study, the model and the poses.
struct Outlook {
  std::string solves;               ///< their number, and what it is the product of
  MemoryOutlook memory;             ///< beyond that of the program
  std::vector<WorkOutlook> shared;  ///< by all threads: the solves
  std::vector<WorkOutlook> by_one;  ///< what only one thread does: separating errors
  double least = 1.0;               ///< share of the solves that are made in any case
};

/// Counts what a run of the study would do, without doing it.
Outlook outlook(const Study& study, const Model& model, const PoseSet& poses);

}  // namespace poesy
