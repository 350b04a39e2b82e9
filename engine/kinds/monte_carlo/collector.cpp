#include "engine/kinds/monte_carlo/collector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/contract.h"
#include "engine/kinds/monte_carlo/yield.h"
#include "engine/stats/moments.h"

namespace poesy {
namespace {

constexpr std::uint64_t kKind = 2;  ///< no other state begins with this number

/// All that a finished pose of a result knows from a response's sketch.
void sketched_state(Archive& archive, MonteCarloResult& result, std::size_t response, std::size_t pose) {
  archive.real(result.min(response, pose), result.max(response, pose));
  archive.reals(result.quantiles.row(response, pose));
  archive.reals(result.quantiles_ci_low.row(response, pose));
  archive.reals(result.quantiles_ci_high.row(response, pose));
  archive.real(result.quantile_error(response, pose));
  if (!result.share_magnitude.empty()) archive.real(result.share_magnitude(response, pose));
}

/// Throws unless these are the solves of whole units, of so many samples at most.
void check_whole(const SolveCounts& solves, std::size_t most_samples) {
  const std::uint64_t total = solves.total();
  if (total == 0 || total % Plan::kUnitSamples != 0 || total > most_samples) {
    throw BytesError("has a pose that is no number of whole units");
  }
}

void effects_state(Archive& archive, std::optional<MainEffectSums>& effects, std::size_t errors,
                   std::size_t responses) {
  std::uint64_t has = effects ? 1 : 0;
  archive.number(has, 1);
  if (!archive.reads()) {
    if (effects) effects->write(archive.writer());
  } else if (has == 1) {
    effects = MainEffectSums::read(archive.reader(), errors, responses);
  } else {
    effects.reset();
  }
}

}  // namespace

void PoseSamples::add(const PoseUnit& unit) {
  responses.resize(unit.responses.size());
  for (std::size_t r = 0; r < responses.size(); ++r) {
    responses[r].moments.merge(unit.responses[r].moments);
    responses[r].sketch.add(unit.responses[r].values);
  }
  solves.merge(unit.solves);
  failed.merge(unit.failed);
  if (!unit.effects) return;
  if (effects) {
    effects->merge(*unit.effects);
  } else {
    effects = unit.effects;
  }
}

void PoseSamples::state(Archive& archive, std::size_t errors) {
  for (auto& [moments, sketch] : responses) {
    archive.object(moments);
    archive.object(sketch);
  }
  archive.object(solves);
  failed.state(archive, solves.not_converged(), 0, solves.total());
  effects_state(archive, effects, errors, responses.size());
}

void PoseSamples::write(ByteWriter& to) const { write_state(*this, to, std::size_t{0}); }

PoseSamples PoseSamples::read(ByteReader& from, std::size_t responses, std::size_t errors) {
  PoseSamples samples;
  samples.responses.resize(responses);
  Archive archive(from);
  samples.state(archive, errors);
  return samples;
}

MonteCarloCollector::MonteCarloCollector(const Plan& plan, std::size_t responses, const Analysis& analysis,
                                         bool keep_checkpoint)
    : plan_(&plan),
      responses_(responses),
      limits_(analysis.limits),
      asked_(asked_of<MonteCarloOptions>(analysis)),
      keep_checkpoint_(keep_checkpoint),
      sketches_(responses),
      moments_({plan.poses().size(), responses}),
      columns_(plan.poses().size(), responses, analysis),
      effects_(plan.poses().size()),
      failed_(plan.poses().size()),
      kept_(plan.poses().size()) {}

void MonteCarloCollector::add(PoseIndex pose, const PoseUnit& unit) {
  if (at_pose_.solves.total() == 0) {
    open_ = pose;
    if (const Bytes& begun = kept_[pose.value].bytes; !begun.empty()) {
      ByteReader from(begun);
      at_pose_ = PoseSamples::read(from, responses_, plan_->factors().size());
    }
  }
  POESY_EXPECTS(pose == open_ && !is_finished(pose.value));
  const bool whole = unit.solves.total() == Plan::kUnitSamples;
  if (keep_checkpoint_ && !whole) keep();
  at_pose_.add(unit);
  if (at_pose_.solves.total() < plan_->samples()) return;
  if (keep_checkpoint_ && whole) keep();
  finish_pose();
}

void MonteCarloCollector::keep() {
  if (at_pose_.solves.total() == 0) return;
  ByteWriter to;
  at_pose_.write(to);
  Kept kept{at_pose_.solves, to.take()};
  kept.bytes.shrink_to_fit();
  set_kept(open_.value, std::move(kept));
}

void MonteCarloCollector::set_kept(std::size_t pose, Kept kept) {
  kept_bytes_ -= kept_[pose].bytes.size();
  kept_[pose] = {};
  if (kept.bytes.size() > kMostKeptBytes - kept_bytes_) return;
  kept_bytes_ += kept.bytes.size();
  kept_[pose] = std::move(kept);
}

void MonteCarloCollector::set_moments(std::size_t response, std::size_t pose, const Moments& moments) {
  columns_.set_moments(response, pose, moments);
  moments_(pose, response) = moments;
}

void MonteCarloCollector::finish_pose() {
  for (std::size_t r = 0; r < responses_; ++r) {
    const auto& [moments, sketch] = at_pose_.responses[r];
    set_moments(r, open_.value, moments);
    columns_.set_quantiles(r, open_.value, sketch, at_pose_.solves.total());
    sketches_[r].merge(sketch);
  }
  columns_.result().solves[open_.value] = at_pose_.solves;
  failed_[open_.value] = std::move(at_pose_.failed);
  effects_[open_.value] = std::move(at_pose_.effects);
  at_pose_ = {};
}

std::size_t MonteCarloCollector::units_done(PoseIndex pose) const {
  if (is_finished(pose.value)) return plan_->units_per_cell();
  const SolveCounts& solves = is_open(pose.value) ? at_pose_.solves : kept_[pose.value].solves;
  return static_cast<std::size_t>(solves.total() / Plan::kUnitSamples);
}

SolveCounts MonteCarloCollector::total() const {
  SolveCounts sum = at_pose_.solves;
  for (std::size_t m = 0; m < kept_.size(); ++m) {
    if (is_finished(m)) {
      sum.merge(columns_.result().solves[m]);
    } else if (!is_open(m)) {
      sum.merge(kept_[m].solves);
    }
  }
  return sum;
}

EffectResult MonteCarloCollector::effects() const {
  const double conf_level = columns_.result().conf_level;
  const std::vector<BinSpread> spreads = bin_spreads(*plan_);
  std::vector<PoseIndex> poses;
  std::vector<MainEffectSums> at_poses;
  MainEffectSums all(plan_->factors().size(), responses_);
  for (std::size_t m = 0; m < effects_.size(); ++m) {
    if (!effects_[m]) continue;
    poses.emplace_back(m);
    at_poses.push_back(*effects_[m]);
    all.merge(*effects_[m]);
  }
  EffectResult found = effect_result(poses, spreads, conf_level);
  found.effects = main_effects(at_poses, Dependence::independent, all, spreads, responses_, conf_level);
  leave_out_correlated(*plan_, found.effects);
  return found;
}

MonteCarloResult MonteCarloCollector::result() && {
  MonteCarloResult& found = columns_.result();
  for (std::size_t r = 0; r < responses_; ++r) {
    Moments overall;
    for (std::size_t m = 0; m < found.poses(); ++m) {
      POESY_EXPECTS(is_finished(m));
      overall.merge(moments_(m, r));
    }
    columns_.set_overall(r, overall, sketches_[r], sketches_[r].count());
  }
  for (std::size_t m = 0; m < found.poses(); ++m) append_failures(0, PoseIndex(m), failed_[m], found.failures);
  found.effects = effects();
  if (!limits_.empty()) found.verdicts = judge_draws(limits_, asked_.judge, asked_.share, found, sketches_);
  return std::move(found);
}

void MonteCarloCollector::finished_state(Archive& archive, std::size_t pose, std::size_t samples) {
  MonteCarloResult& result = columns_.result();
  for (std::size_t r = 0; r < responses_; ++r) {
    Moments moments = moments_(pose, r);
    archive.object(moments);
    if (archive.reads()) set_moments(r, pose, moments);
    sketched_state(archive, result, r, pose);
  }
  archive.object(result.solves[pose]);
  archive.expect(result.solves[pose].total() == samples, "has a finished pose with other samples");
  failed_[pose].state(archive, result.solves[pose].not_converged(), 0, result.solves[pose].total());
  effects_state(archive, effects_[pose], plan_->factors().size(), responses_);
}

void MonteCarloCollector::write_state(ByteWriter& to) const {
  for (const std::uint64_t number : std::array<std::uint64_t, 5>{kKind, responses_, columns_.result().poses(),
                                                                 columns_.result().levels.size(), plan_->samples()}) {
    to.number(number);
  }
  for (std::size_t m = 0; m < columns_.result().poses(); ++m) {
    to.number(is_finished(m) ? 1 : 0);
    if (is_finished(m)) {
      Archive archive(to);
      const_cast<MonteCarloCollector*>(this)->finished_state(archive, m, 0);  // it changes nothing where it writes
    }
    to.block(kept_[m].bytes);
  }
  for (const QuantileSketch& sketch : sketches_) sketch.write(to);
  to.number(at_pose_.solves.total() > 0 ? 1 : 0);
  if (at_pose_.solves.total() == 0) return;
  to.number(open_.value);
  at_pose_.write(to);
}

void MonteCarloCollector::restore(std::span<const std::byte> state) {
  ByteReader from(state);
  while (from.left() > 0) restore_one(from);
}

void MonteCarloCollector::restore_one(ByteReader& from) {
  for (const std::uint64_t expected :
       std::array<std::uint64_t, 4>{kKind, responses_, columns_.result().poses(), columns_.result().levels.size()}) {
    if (from.number() != expected) throw BytesError("is the state of another kind or size of study");
  }
  const auto samples = static_cast<std::size_t>(from.number_up_to(plan_->samples()));
  if (samples == 0) throw BytesError("has no samples");
  const bool shorter = samples < plan_->samples();
  for (std::size_t m = 0; m < columns_.result().poses(); ++m) {
    const bool finished = from.number_up_to(1) == 1;
    if (finished) {
      if (is_finished(m) || is_open(m)) throw BytesError("has a pose twice");
      Archive archive(from);
      finished_state(archive, m, samples);
    }
    read_kept(from, m, finished ? samples : samples - 1);
    if (shorter) {
      columns_.result().solves[m] = {};
      effects_[m].reset();
    }
  }
  for (QuantileSketch& sketch : sketches_) {
    const QuantileSketch read = QuantileSketch::read(from);
    if (!shorter) sketch.merge(read);
  }
  if (from.number_up_to(1) == 1) read_open(from, samples);
}

void MonteCarloCollector::read_open(ByteReader& from, std::size_t samples) {
  if (at_pose_.solves.total() > 0) throw BytesError("has two unfinished poses");
  open_ = PoseIndex(static_cast<std::size_t>(from.number_up_to(columns_.result().poses() - 1)));
  if (is_finished(open_.value)) throw BytesError("has a pose twice");
  at_pose_ = PoseSamples::read(from, responses_, plan_->factors().size());
  check_whole(at_pose_.solves, samples - 1);
  if (samples == plan_->samples()) return;
  keep();
  at_pose_ = {};
}

void MonteCarloCollector::read_kept(ByteReader& from, std::size_t pose, std::size_t most_samples) {
  const std::span<const std::byte> bytes = from.block();
  if (bytes.empty()) return;
  ByteReader unit(bytes);
  const SolveCounts solves = PoseSamples::read(unit, responses_, plan_->factors().size()).solves;
  unit.expect_end();
  check_whole(solves, most_samples);
  set_kept(pose, {solves, Bytes(bytes.begin(), bytes.end())});
}

}  // namespace poesy
