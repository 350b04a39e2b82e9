#include "engine/kinds/limited_vectors.h"

#include <algorithm>

#include "engine/base/contract.h"

namespace poesy {
namespace {

/// The largest number of sums, 8 bytes each, that the linear fits at all poses may keep in memory.
constexpr std::size_t kMostSums = std::size_t{4} << 20U;

std::size_t components_of(const std::vector<Detail>& details) {
  std::size_t count = 0;
  for (const Detail& detail : details) count += detail.components.size();
  return count;
}

}  // namespace

LimitedVectors::LimitedVectors(const Plan& plan, const Model& model, const Analysis& analysis)
    : plan_(&plan), model_(&model) {
  const ModelDescription& description = model.description();
  const std::size_t details = components_of(description.details);
  if (plan.poses().size() == 0) return;
  for (const ResponseLimit& limit : analysis.limits) {
    const Response& response = description.responses[limit.response];
    const bool is_centred = limit.allowed.is_spread() && !response.is_magnitude();
    // If errors are drawn anew at each pose, poses are fitted one by one, so the mean over the poses is not known.
    if (is_centred && !plan.per_pose().empty()) continue;
    LimitedVector vector{limit.response, limit.allowed, response.components, rows_, 0, is_centred};
    const std::size_t numbers = model.norm_of_details(limit.response, plan.poses()[PoseIndex(0)]).size();
    if (numbers > 0) {
      vector.rows = numbers / details;
      details_ = details;
    } else {
      if (vector.responses.empty()) vector.responses = {limit.response};
      vector.rows = vector.responses.size();
    }
    rows_ += vector.rows;
    vectors_.push_back(std::move(vector));
  }
  const std::size_t errors = plan.factors().size();
  // Number of products of two errors whose sums the fit at a pose keeps; 0 if no error is drawn anew at each pose.
  const std::size_t products = plan.per_pose().empty() ? 0 : errors * errors;
  if (plan.poses().size() * (rows_ * (errors + 1) + products) <= kMostSums) return;
  vectors_.clear();
  rows_ = 0;
  details_ = 0;
}

void LimitedVectors::fill(PoseIndex pose, const UnitOutcomes& outcomes,
                          const Array<double, axis::DetailComponent, axis::Sample>& details,
                          const ArrayView<double, axis::VectorRow, axis::Sample>& rows) const {
  const std::size_t block = outcomes.status.size();
  const ArrayView<const double, axis::Response, axis::Sample> responses(outcomes.responses,
                                                                        {outcomes.responses.size() / block, block});
  for (const LimitedVector& vector : vectors_) {
    for (std::size_t k = 0; k < vector.responses.size(); ++k) {
      std::ranges::copy(responses.row(vector.responses[k]), rows.row(vector.first_row + k).begin());
    }
    if (!vector.responses.empty()) continue;
    const Array<double, axis::VectorRow, axis::DetailComponent> matrix(
        {vector.rows, details_}, model_->norm_of_details(vector.response, plan_->poses()[pose]));
    for (std::size_t k = 0; k < vector.rows; ++k) {
      const std::span<double> own = rows.row(vector.first_row + k);
      std::ranges::fill(own, 0.0);
      for (std::size_t d = 0; d < details_; ++d) {
        const std::span<const double> detail = details.row(d);
        for (std::size_t b = 0; b < block; ++b) own[b] += matrix(k, d) * detail[b];
      }
    }
  }
}

}  // namespace poesy
