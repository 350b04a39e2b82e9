#include "engine/kinds/monte_carlo/limited_vectors.h"

#include <algorithm>

#include "engine/base/contract.h"

namespace poesy {
namespace {

/// Sums of fits at all poses, and no more.
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
    LimitedVector vector{limit.response, limit.most, description.responses[limit.response].components, rows_, 0};
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
  if (rows_ * plan.poses().size() * (plan.factors().size() + 1) <= kMostSums) return;
  vectors_.clear();
  rows_ = 0;
  details_ = 0;
}

void LimitedVectors::fill(PoseIndex pose, const UnitOutcomes& outcomes, std::span<const double> details,
                          std::span<double> rows) const {
  const std::size_t block = outcomes.status.size();
  POESY_EXPECTS(rows.size() == rows_ * block && details.size() == details_ * block);
  for (const LimitedVector& vector : vectors_) {
    const std::span<double> own = rows.subspan(vector.first_row * block, vector.rows * block);
    for (std::size_t k = 0; k < vector.responses.size(); ++k) {
      std::ranges::copy(outcomes.responses.subspan(vector.responses[k] * block, block),
                        own.begin() + static_cast<std::ptrdiff_t>(k * block));
    }
    if (!vector.responses.empty()) continue;
    const std::vector<double> matrix = model_->norm_of_details(vector.response, plan_->poses()[pose]);
    std::ranges::fill(own, 0.0);
    for (std::size_t k = 0; k < vector.rows; ++k) {
      for (std::size_t d = 0; d < details_; ++d) {
        const double factor = matrix[k * details_ + d];
        for (std::size_t b = 0; b < block; ++b) own[k * block + b] += factor * details[d * block + b];
      }
    }
  }
}

}  // namespace poesy
