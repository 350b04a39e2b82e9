#pragma once

#include <span>
#include <vector>

#include "models/assembly/model.h"

namespace poesy::assembly {

/// Computes the fixed frames of all limbs for given errors.
class ErrorFrames {
 public:
  explicit ErrorFrames(const AssemblyModel& model);  ///< The model must outlive this object.

  /// The fixed frames of each limb with these errors (one for each error of the model), at these nominal displacements
  /// of the joints. The next call overwrites the frames.
  const std::vector<std::vector<Transform>>& with(std::span<const double> errors,
                                                  std::span<const double> displacements);

 private:
  const AssemblyModel* model_;
  std::vector<std::vector<Transform>> frames_;
  std::vector<std::vector<chain::FrameError<double>>> errors_;
};

}  // namespace poesy::assembly
