#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "engine/base/array.h"
#include "engine/model/model.h"
#include "engine/run/evaluate_unit.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy {

namespace axis {
using DetailComponent = Axis<"detail_component">;  ///< Components of the model's details.
using VectorRow = Axis<"vector_row">;              ///< Components of the vectors behind all limited responses.
}  // namespace axis

/// The vector whose norm is a limited response. Its components are linear in the errors to first order. For a response
/// with a sign, the response itself is its only component; if its spread is limited, less its mean over the poses,
/// which does not change the spread.
struct LimitedVector {
  std::size_t response;                ///< the limited response
  ValueLimit limit;                    ///< its limit
  std::vector<std::size_t> responses;  ///< responses that are its components; empty: Model::norm_of_details makes them
  std::size_t first_row;               ///< position of its first component among those of all limited vectors
  std::size_t rows;                    ///< number of components
  bool is_centred;                     ///< whether it is taken less its mean over the poses
};

/// The vectors of all limited responses of a study, and how their components are computed from the outcomes of solves.
/// They are fitted at each pose.
class LimitedVectors {
 public:
  /// Refers to the plan and the model. There is none for a centred response if machines draw errors anew at each pose.
  /// There are no vectors if the study states no limit, or if fits at all poses would
  /// take more than some tens of megabytes.
  LimitedVectors(const Plan& plan, const Model& model, const Analysis& analysis);

  std::span<const LimitedVector> each() const { return vectors_; }  ///< The vectors, in the order of the limits.
  std::size_t rows() const { return rows_; }  ///< Components of all vectors at one pose; 0 if there are none.
  /// Components of the model's details if a vector is made of them, otherwise 0.
  std::size_t details() const { return details_; }

  /// Fills the components from the outcomes of the solves at a pose.
  void fill(PoseIndex pose, const UnitOutcomes& outcomes,
            const Array<double, axis::DetailComponent, axis::Sample>& details,
            const ArrayView<double, axis::VectorRow, axis::Sample>& rows) const;

 private:
  const Plan* plan_;
  const Model* model_;
  std::vector<LimitedVector> vectors_;
  std::size_t rows_ = 0;
  std::size_t details_ = 0;
};

}  // namespace poesy
