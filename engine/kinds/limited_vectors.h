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
/// Components of all additional outputs of the model (Detail in model/model.h).
using DetailComponent = Axis<"detail_component">;
using VectorRow = Axis<"vector_row">;  ///< Components of all limited vectors (LimitedVector).
}  // namespace axis

/// The vector whose norm is a response with a limit. To first order, its components are linear in the errors. The
/// vector of a response with a sign has this response as its only component. If the limit is on the spread of a signed
/// response over the poses, the mean over the poses is subtracted, which does not change the spread.
struct LimitedVector {
  std::size_t response;                ///< the response with a limit
  ValueLimit limit;                    ///< the limit on this response
  std::vector<std::size_t> responses;  ///< the responses that are the components; empty if Model::norm_of_details
                                       ///< computes the components instead
  std::size_t first_row;  ///< position of the first component on axis::VectorRow, the components of all limited vectors
  std::size_t rows;       ///< number of components
  bool is_centred;        ///< whether the mean of the response over the poses is subtracted
};

/// The vectors (LimitedVector) of all responses that a study limits, and how their components are computed from the
/// outcomes of solves. Users of this class fit a linear model of the components at each pose.
class LimitedVectors {
 public:
  /// Keeps references to the plan and the model. There are no vectors if the study states no limit, or if the linear
  /// fits at all poses would need more than some tens of megabytes. A response whose mean is subtracted has no vector
  /// if machines draw errors anew at each pose.
  LimitedVectors(const Plan& plan, const Model& model, const Analysis& analysis);

  std::span<const LimitedVector> each() const { return vectors_; }  ///< The vectors, in the order of the limits.
  std::size_t rows() const { return rows_; }  ///< Number of components of all vectors at one pose; 0 without vectors.
  /// Number of components of all additional outputs of the model (Detail in model/model.h) if some vector is computed
  /// from them, otherwise 0.
  std::size_t details() const { return details_; }

  /// Computes `rows`, the components of all vectors, from the outcomes of the solves at a pose. details: values of the
  /// additional outputs, empty if details() is 0.
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
