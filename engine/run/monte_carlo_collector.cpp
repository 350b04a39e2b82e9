#include "engine/run/monte_carlo_collector.h"

#include <array>
#include <limits>
#include <utility>

#include "engine/base/contract.h"
#include "engine/stats/mean_interval.h"

namespace poesy {
namespace {

constexpr std::uint64_t kKind = 2;  ///< no other state begins with this number

/// NaN where nothing counts.
double mean_of(const Moments& moments) {
  return moments.count() == 0 ? std::numeric_limits<double>::quiet_NaN() : moments.mean();
}

/// The members of a result with a number for each response and pose.
std::array<std::vector<double>*, 6> numbers_of(MonteCarloResult& result) {
  return {&result.mean, &result.mean_ci_low, &result.mean_ci_high, &result.std, &result.min, &result.max};
}

/// Throws unless these are the solves of whole units, of so many samples at most.
void check_whole(const SolveCounts& solves, std::size_t most_samples) {
  const std::uint64_t total = solves.total();
  if (total == 0 || total % Plan::kUnitSamples != 0 || total > most_samples) {
    throw BytesError("has a pose that is no number of whole units");
  }
}

}  // namespace

void ResponseSamples::merge(const ResponseSamples& other) {
  moments.merge(other.moments);
  sketch.merge(other.sketch);
}

void ResponseSamples::write(ByteWriter& to) const {
  moments.write(to);
  sketch.write(to);
}

ResponseSamples ResponseSamples::read(ByteReader& from) {
  ResponseSamples samples;
  samples.moments = Moments::read(from);
  samples.sketch = QuantileSketch::read(from);
  return samples;
}

void PoseSamples::add(const PoseUnit& unit) {
  responses.resize(unit.responses.size());
  for (std::size_t r = 0; r < responses.size(); ++r) {
    responses[r].moments.merge(unit.responses[r].moments);
    responses[r].sketch.add(unit.responses[r].values);
  }
  solves.merge(unit.solves);
}

void PoseSamples::write(ByteWriter& to) const {
  for (const ResponseSamples& response : responses) response.write(to);
  solves.write(to);
}

PoseSamples PoseSamples::read(ByteReader& from, std::size_t responses) {
  PoseSamples samples;
  for (std::size_t r = 0; r < responses; ++r) samples.responses.push_back(ResponseSamples::read(from));
  samples.solves = SolveCounts::read(from);
  return samples;
}

MonteCarloCollector::MonteCarloCollector(const Plan& plan, std::size_t responses, const Analysis& analysis)
    : plan_(&plan), responses_(responses), overall_(responses), kept_(plan.poses().size()) {
  result_.responses = responses;
  result_.poses = plan.poses().size();
  result_.conf_level = analysis.conf_level;
  result_.quantile_relative_error = QuantileSketch::kRelativeError;
  result_.levels = analysis.quantiles;
  const std::size_t cells = responses * result_.poses;
  for (std::vector<double>* values : numbers_of(result_)) values->resize(cells);
  result_.count.resize(cells);
  result_.quantiles.resize(cells * result_.levels.size());
  result_.solves.resize(result_.poses);
}

void MonteCarloCollector::add(PoseIndex pose, const PoseUnit& unit) {
  POESY_EXPECTS(pose == pose_);
  if (at_pose_.solves.total() == 0 && !kept_[pose.value].bytes.empty()) {
    ByteReader from(kept_[pose.value].bytes);
    at_pose_ = PoseSamples::read(from, responses_);
  }
  const bool whole = unit.solves.total() == Plan::kUnitSamples;
  if (!whole) keep();
  at_pose_.add(unit);
  if (at_pose_.solves.total() < plan_->samples()) return;
  if (whole) keep();
  finish_pose();
}

void MonteCarloCollector::keep() {
  if (at_pose_.solves.total() == 0) return;
  ByteWriter to;
  at_pose_.write(to);
  Kept kept{at_pose_.solves, to.take()};
  kept.bytes.shrink_to_fit();
  set_kept(pose_.value, std::move(kept));
}

void MonteCarloCollector::set_kept(std::size_t pose, Kept kept) {
  kept_bytes_ -= kept_[pose].bytes.size();
  kept_[pose] = {};
  if (kept.bytes.size() > kMostKeptBytes - kept_bytes_) return;
  kept_bytes_ += kept.bytes.size();
  kept_[pose] = std::move(kept);
}

void MonteCarloCollector::finish_pose() {
  for (std::size_t r = 0; r < responses_; ++r) {
    const auto& [moments, sketch] = at_pose_.responses[r];
    const std::size_t cell = r * result_.poses + pose_.value;
    const Interval interval = mean_interval(moments, result_.conf_level);
    result_.mean[cell] = mean_of(moments);
    result_.mean_ci_low[cell] = interval.low;
    result_.mean_ci_high[cell] = interval.high;
    result_.std[cell] = moments.standard_deviation();
    result_.min[cell] = sketch.min();
    result_.max[cell] = sketch.max();
    result_.count[cell] = moments.count();
    for (std::size_t q = 0; q < result_.levels.size(); ++q) {
      result_.quantiles[cell * result_.levels.size() + q] = sketch.quantile(result_.levels[q]);
    }
    overall_[r].merge(at_pose_.responses[r]);
  }
  result_.solves[pose_.value] = at_pose_.solves;
  at_pose_ = {};
  ++pose_.value;
}

std::size_t MonteCarloCollector::units_done(PoseIndex pose) const {
  if (pose < pose_) return plan_->units_per_cell();
  const bool open = pose == pose_ && at_pose_.solves.total() > 0;
  return static_cast<std::size_t>((open ? at_pose_.solves : kept_[pose.value].solves).total() / Plan::kUnitSamples);
}

SolveCounts MonteCarloCollector::total() const {
  SolveCounts sum = at_pose_.solves;
  for (std::size_t m = 0; m < kept_.size(); ++m) {
    if (m < pose_.value) sum.merge(result_.solves[m]);
    if (m > pose_.value || (m == pose_.value && at_pose_.solves.total() == 0)) sum.merge(kept_[m].solves);
  }
  return sum;
}

MonteCarloResult MonteCarloCollector::result() && {
  POESY_EXPECTS(pose_.value == result_.poses);
  for (const auto& [moments, sketch] : overall_) {
    result_.overall_mean.push_back(mean_of(moments));
    result_.overall_std.push_back(moments.standard_deviation());
    result_.overall_min.push_back(sketch.min());
    result_.overall_max.push_back(sketch.max());
    result_.overall_count.push_back(moments.count());
    for (const double level : result_.levels) result_.overall_quantiles.push_back(sketch.quantile(level));
  }
  return std::move(result_);
}

void MonteCarloCollector::write_finished(ByteWriter& to, std::size_t pose) const {
  const std::size_t levels = result_.levels.size();
  for (std::size_t r = 0; r < responses_; ++r) {
    const std::size_t cell = r * result_.poses + pose;
    for (const std::vector<double>* values :
         {&result_.mean, &result_.mean_ci_low, &result_.mean_ci_high, &result_.std, &result_.min, &result_.max}) {
      to.real((*values)[cell]);
    }
    to.number(result_.count[cell]);
    to.reals(std::span(result_.quantiles).subspan(cell * levels, levels));
  }
  result_.solves[pose].write(to);
}

void MonteCarloCollector::read_finished(ByteReader& from, std::size_t pose) {
  const std::size_t levels = result_.levels.size();
  for (std::size_t r = 0; r < responses_; ++r) {
    const std::size_t cell = r * result_.poses + pose;
    for (std::vector<double>* values : numbers_of(result_)) (*values)[cell] = from.real();
    result_.count[cell] = from.number();
    from.reals(std::span(result_.quantiles).subspan(cell * levels, levels));
  }
  result_.solves[pose] = SolveCounts::read(from);
}

Bytes MonteCarloCollector::state() const {
  ByteWriter to;
  to.reserve(kept_bytes_ + kept_bytes_ / 4);  // what is kept, and some more
  for (const std::uint64_t number : std::array<std::uint64_t, 6>{
           kKind, responses_, result_.poses, result_.levels.size(), plan_->samples(), pose_.value}) {
    to.number(number);
  }
  for (std::size_t m = 0; m < pose_.value; ++m) write_finished(to, m);
  for (const ResponseSamples& response : overall_) response.write(to);
  const bool open = at_pose_.solves.total() > 0;
  to.number(open ? 1 : 0);
  if (open) at_pose_.write(to);
  for (const Kept& kept : kept_) to.block(kept.bytes);
  return to.take();
}

void MonteCarloCollector::restore(std::span<const std::byte> state) {
  ByteReader from(state);
  for (const std::uint64_t expected :
       std::array<std::uint64_t, 4>{kKind, responses_, result_.poses, result_.levels.size()}) {
    if (from.number() != expected) throw BytesError("is the state of another kind or size of study");
  }
  const auto samples = static_cast<std::size_t>(from.number_up_to(plan_->samples()));
  if (samples == 0) throw BytesError("has no samples");
  pose_.value = static_cast<std::size_t>(from.number_up_to(result_.poses));
  for (std::size_t m = 0; m < pose_.value; ++m) read_finished(from, m);
  for (ResponseSamples& response : overall_) response = ResponseSamples::read(from);
  if (from.number_up_to(pose_.value < result_.poses ? 1 : 0) == 1) {
    at_pose_ = PoseSamples::read(from, responses_);
    check_whole(at_pose_.solves, samples - 1);
  }
  for (std::size_t m = 0; m < kept_.size(); ++m) read_kept(from, m, m < pose_.value ? samples : samples - 1);
  from.expect_end();
  if (samples == plan_->samples()) return;
  if (at_pose_.solves.total() > 0) keep();
  at_pose_ = {};
  overall_.assign(responses_, {});
  pose_ = {};
}

void MonteCarloCollector::read_kept(ByteReader& from, std::size_t pose, std::size_t most_samples) {
  const std::span<const std::byte> bytes = from.block();
  if (bytes.empty()) return;
  ByteReader unit(bytes);
  const SolveCounts solves = PoseSamples::read(unit, responses_).solves;
  unit.expect_end();
  check_whole(solves, most_samples);
  set_kept(pose, {solves, Bytes(bytes.begin(), bytes.end())});
}

}  // namespace poesy
