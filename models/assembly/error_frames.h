#pragma once

#include <span>
#include <vector>

#include "models/assembly/model.h"

namespace poesy::assembly {

/// The fixed frames of all limbs with errors.
class ErrorFrames {
 public:
  explicit ErrorFrames(const AssemblyModel& model);  ///< The model must outlive it.

  /// The frames [limbs][n + 1] with these errors [F], at these nominal displacements of the joints. The reference shows
  /// the new frames after the next call.
  const std::vector<std::vector<Transform>>& with(std::span<const double> errors,
                                                  std::span<const double> displacements);

 private:
  const AssemblyModel* model_;
  std::vector<std::vector<Transform>> frames_;
  std::vector<std::vector<chain::FrameError<double>>> errors_;
};

}  // namespace poesy::assembly
