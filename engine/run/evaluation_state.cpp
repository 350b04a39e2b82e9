#include "engine/run/evaluation_state.h"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/base/contract.h"

namespace poesy {
namespace {

constexpr std::uint64_t kKind = 3;  ///< no other state begins with this number

}  // namespace

EvaluationProgress::EvaluationProgress(EvaluationResult& result, std::size_t block_rows)
    : result_(&result), block_rows_(block_rows), blocks_per_pose_((result.samples + block_rows - 1) / block_rows) {
  POESY_EXPECTS(block_rows > 0);
}

std::size_t EvaluationProgress::outcomes() const {
  if (blocks_per_pose_ == 0) return 0;
  return blocks_ / blocks_per_pose_ * result_->samples +
         std::min(blocks_ % blocks_per_pose_ * block_rows_, result_->samples);
}

SolveCounts EvaluationProgress::total() const {
  SolveCounts sum;
  for (std::size_t n = 0; n < outcomes(); ++n) sum.add(result_->status[n], result_->iterations[n]);
  return sum;
}

Bytes EvaluationProgress::state() const {
  ByteWriter to;
  for (const std::uint64_t number : std::array<std::uint64_t, 7>{
           kKind, result_->poses, result_->samples, result_->responses, result_->details, block_rows_, blocks_}) {
    to.number(number);
  }
  const std::size_t all = result_->poses * result_->samples;
  const std::size_t done = outcomes();
  for (std::size_t r = 0; r < result_->responses; ++r) to.reals(std::span(result_->response).subspan(r * all, done));
  to.reals(std::span(result_->detail).first(done * result_->details));
  for (std::size_t n = 0; n < done; ++n) {
    to.number(static_cast<std::uint64_t>(result_->status[n]));
    to.number(result_->iterations[n]);
  }
  return to.take();
}

void EvaluationProgress::restore(std::span<const std::byte> state) {
  ByteReader from(state);
  for (const std::uint64_t expected : std::array<std::uint64_t, 6>{kKind, result_->poses, result_->samples,
                                                                   result_->responses, result_->details, block_rows_}) {
    if (from.number() != expected) throw BytesError("is the state of another kind or size of study");
  }
  blocks_ = static_cast<std::size_t>(from.number_up_to(blocks_in_all()));
  const std::size_t all = result_->poses * result_->samples;
  const std::size_t done = outcomes();
  for (std::size_t r = 0; r < result_->responses; ++r) from.reals(std::span(result_->response).subspan(r * all, done));
  from.reals(std::span(result_->detail).first(done * result_->details));
  for (std::size_t n = 0; n < done; ++n) {
    result_->status[n] = static_cast<SolveStatus>(from.number_up_to(kStatusNames.size() - 1));
    result_->iterations[n] = static_cast<std::uint32_t>(from.number_up_to(std::numeric_limits<std::uint32_t>::max()));
  }
  from.expect_end();
}

}  // namespace poesy
