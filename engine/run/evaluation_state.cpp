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

std::size_t EvaluationProgress::outcomes(std::size_t blocks) const {
  if (blocks_per_pose_ == 0) return 0;
  return blocks / blocks_per_pose_ * result_->samples +
         std::min(blocks % blocks_per_pose_ * block_rows_, result_->samples);
}

SolveCounts EvaluationProgress::total() const {
  SolveCounts sum;
  for (std::size_t n = 0; n < outcomes(blocks_); ++n) sum.add(result_->status[n], result_->iterations[n]);
  return sum;
}

Bytes EvaluationProgress::state() const {
  ByteWriter to;
  for (const std::uint64_t number : std::array<std::uint64_t, 7>{
           kKind, result_->poses, result_->samples, result_->responses, result_->details, block_rows_, blocks_}) {
    to.number(number);
  }
  write_outcomes(0, outcomes(blocks_), to);
  return to.take();
}

void EvaluationProgress::restore(std::span<const std::byte> state) {
  ByteReader from(state);
  for (const std::uint64_t expected : std::array<std::uint64_t, 6>{kKind, result_->poses, result_->samples,
                                                                   result_->responses, result_->details, block_rows_}) {
    if (from.number() != expected) throw BytesError("is the state of another kind or size of study");
  }
  blocks_ = static_cast<std::size_t>(from.number_up_to(blocks_in_all()));
  read_outcomes(0, outcomes(blocks_), from);
  from.expect_end();
}

void EvaluationProgress::write_outcomes(std::size_t place, std::size_t count, ByteWriter& to) const {
  const std::size_t all = result_->poses * result_->samples;
  for (std::size_t r = 0; r < result_->responses; ++r) {
    to.reals(std::span(result_->response).subspan(r * all + place, count));
  }
  to.reals(std::span(result_->detail).subspan(place * result_->details, count * result_->details));
  for (std::size_t n = place; n < place + count; ++n) {
    to.number(static_cast<std::uint64_t>(result_->status[n]));
    to.number(result_->iterations[n]);
  }
}

void EvaluationProgress::read_outcomes(std::size_t place, std::size_t count, ByteReader& from) {
  const std::size_t all = result_->poses * result_->samples;
  for (std::size_t r = 0; r < result_->responses; ++r) {
    from.reals(std::span(result_->response).subspan(r * all + place, count));
  }
  from.reals(std::span(result_->detail).subspan(place * result_->details, count * result_->details));
  for (std::size_t n = place; n < place + count; ++n) {
    result_->status[n] = static_cast<SolveStatus>(from.number_up_to(kStatusNames.size() - 1));
    result_->iterations[n] = static_cast<std::uint32_t>(from.number_up_to(std::numeric_limits<std::uint32_t>::max()));
  }
}

void EvaluationProgress::write_block(std::size_t block, ByteWriter& to) const {
  write_outcomes(outcomes(block), outcomes(block + 1) - outcomes(block), to);
}

SolveCounts EvaluationProgress::read_block(std::size_t block, ByteReader& from) {
  const std::size_t first = outcomes(block);
  const std::size_t end = outcomes(block + 1);
  read_outcomes(first, end - first, from);
  SolveCounts solves;
  for (std::size_t n = first; n < end; ++n) solves.add(result_->status[n], result_->iterations[n]);
  return solves;
}

}  // namespace poesy
