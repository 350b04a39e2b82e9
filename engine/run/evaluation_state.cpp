#include "engine/run/evaluation_state.h"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/base/contract.h"
#include "engine/run/evaluation.h"

namespace poesy {
namespace {

constexpr std::uint64_t kKind = 3;  ///< no other state begins with this number

}  // namespace

EvaluationProgress::EvaluationProgress(EvaluationResult& result, std::size_t block_rows, const Shard& shard)
    : result_(&result),
      block_rows_(block_rows),
      blocks_per_pose_((result.samples + block_rows - 1) / block_rows),
      blocks_(shard.of(result.poses * blocks_per_pose_)),
      next_(blocks_.first) {
  POESY_EXPECTS(block_rows > 0);
}

std::size_t EvaluationProgress::outcomes(std::size_t block) const {
  if (blocks_per_pose_ == 0) return 0;
  return block / blocks_per_pose_ * result_->samples +
         std::min(block % blocks_per_pose_ * block_rows_, result_->samples);
}

SolveCounts EvaluationProgress::total() const {
  SolveCounts sum;
  for (std::size_t n = outcomes(blocks_.first); n < outcomes(next_); ++n) {
    sum.add(result_->status[n], result_->iterations[n]);
  }
  return sum;
}

Bytes EvaluationProgress::state() const {
  ByteWriter to;
  for (const std::uint64_t number :
       std::array<std::uint64_t, 8>{kKind, result_->poses, result_->samples, result_->responses, result_->details,
                                    block_rows_, blocks_.first, next_}) {
    to.number(number);
  }
  const std::size_t first = outcomes(blocks_.first);
  write_outcomes(first, outcomes(next_) - first, to);
  return to.take();
}

void EvaluationProgress::restore(std::span<const std::byte> state) {
  ByteReader from(state);
  while (from.left() > 0) restore_one(from);
}

void EvaluationProgress::restore_one(ByteReader& from) {
  for (const std::uint64_t expected : std::array<std::uint64_t, 7>{
           kKind, result_->poses, result_->samples, result_->responses, result_->details, block_rows_, next_}) {
    if (from.number() != expected) throw BytesError("is the state of another kind, size or part of a study");
  }
  const std::size_t first = outcomes(next_);
  const auto end = static_cast<std::size_t>(from.number_up_to(blocks_.end));
  if (end < next_) throw BytesError("has blocks that end before they begin");
  next_ = end;
  read_outcomes(first, outcomes(next_) - first, from);
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
