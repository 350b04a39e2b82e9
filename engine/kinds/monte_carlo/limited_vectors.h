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

/// The vector behind a limited response, of which the response is the norm: components that are linear in the errors to
/// first order. Of a response with a sign that is itself.
struct LimitedVector {
  std::size_t response;                ///< that is limited
  double most;                         ///< its limit
  std::vector<std::size_t> responses;  ///< that are the components; empty: Model::norm_of_details makes them
  std::size_t first_row;               ///< of its components among those of all limited vectors
  std::size_t rows;                    ///< components
};

/// The vectors behind all limited responses of a study, which are fitted at each pose: how the machines' rows come from
/// what is solved.
class LimitedVectors {
 public:
  /// Refers to the plan and the model. No vectors where the study states no limit, or where fits at all poses would
  /// take more than some tens of megabytes.
  LimitedVectors(const Plan& plan, const Model& model, const Analysis& analysis);

  std::span<const LimitedVector> each() const { return vectors_; }  ///< In the order of the limits.
  std::size_t rows() const { return rows_; }                        ///< Of all vectors at one pose; 0 where none are.
  /// Components of the model's details where a vector is made of them, else 0.
  std::size_t details() const { return details_; }

  /// Fills the rows from what was solved at a pose.
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
