#include "engine/kinds/monte_carlo/collector.h"

#include <utility>

#include "engine/base/contract.h"
#include "engine/kinds/monte_carlo/yield.h"
#include "engine/stats/moments.h"
#include "engine/stats/sums.h"

namespace poesy::monte_carlo {
namespace {

/// Reads or writes the statistics of one response at a finished pose that come from its quantile sketch: the extremes,
/// the quantiles, and share_magnitude if it is computed.
void sketched_state(Archive& archive, Result& result, std::size_t response, std::size_t pose) {
  archive.real(result.min(response, pose), result.max(response, pose));
  archive.reals(result.quantiles.row(response, pose));
  archive.reals(result.quantiles_ci_low.row(response, pose));
  archive.reals(result.quantiles_ci_high.row(response, pose));
  archive.real(result.quantile_error(response, pose));
  if (!result.share_magnitude.empty()) archive.real(result.share_magnitude(response, pose));
}

/// Refuses to read the state of a pose unless its number of samples is a positive multiple of Plan::kUnitSamples, and
/// not above `most_samples`.
void expect_whole(const Archive& archive, const SolveCounts& solves, std::size_t most_samples) {
  const std::uint64_t total = solves.total();
  archive.expect(total > 0 && total % Plan::kUnitSamples == 0 && total <= most_samples,
                 "has a pose that is not a number of whole units");
}

}  // namespace

void PoseSamples::add(const PoseUnit& unit) {
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

void PoseSamples::state(Archive& archive) {
  archive.object(responses);
  ends_state(archive, solves, failed, 0);
  archive.optional(effects, errors_, responses.size());
}

Collector::Collector(const Plan& plan, std::size_t responses, const Analysis& analysis, bool keep_checkpoint)
    : plan_(&plan),
      responses_(responses),
      limits_(analysis.limits),
      asked_(asked_of<Options>(analysis)),
      keep_checkpoint_(keep_checkpoint),
      at_pose_(no_samples()),
      sketches_(responses),
      moments_({plan.poses().size(), responses}),
      columns_(plan.poses().size(), responses, analysis),
      effects_(plan.poses().size()),
      failed_(plan.poses().size()),
      kept_(plan.poses().size()) {}

void Collector::add(const WorkUnit& unit, const PoseUnit& found) {
  const PoseIndex pose = unit.pose;
  if (at_pose_.solves.total() == 0) {
    open_ = pose;
    if (const Bytes& begun = kept_[pose.value].bytes; !begun.empty()) {
      ByteReader from(begun);
      at_pose_ = read_state<PoseSamples>(from, responses_, plan_->factors().size());
    }
  }
  POESY_EXPECTS(pose == open_ && !is_finished(pose.value));
  const bool whole = found.solves.total() == Plan::kUnitSamples;
  if (keep_checkpoint_ && !whole) keep();
  at_pose_.add(found);
  if (at_pose_.solves.total() < plan_->samples()) return;
  if (keep_checkpoint_ && whole) keep();
  finish_pose();
}

void Collector::keep() {
  if (at_pose_.solves.total() == 0) return;
  ByteWriter to;
  write_state(at_pose_, to);
  Kept kept{at_pose_.solves, to.take()};
  kept.bytes.shrink_to_fit();
  set_kept(open_.value, std::move(kept));
}

void Collector::set_kept(std::size_t pose, Kept kept) {
  kept_bytes_ -= kept_[pose].bytes.size();
  kept_[pose] = {};
  if (kept.bytes.size() > kMostKeptBytes - kept_bytes_) return;
  kept_bytes_ += kept.bytes.size();
  kept_[pose] = std::move(kept);
}

void Collector::set_moments(std::size_t response, std::size_t pose, const Moments& moments) {
  columns_.set_moments(response, pose, moments);
  moments_(pose, response) = moments;
}

void Collector::finish_pose() {
  for (std::size_t r = 0; r < responses_; ++r) {
    const auto& [moments, sketch] = at_pose_.responses[r];
    set_moments(r, open_.value, moments);
    columns_.set_quantiles(r, open_.value, sketch, at_pose_.solves.total());
    sketches_[r].merge(sketch);
  }
  columns_.result().solves[open_.value] = at_pose_.solves;
  failed_[open_.value] = std::move(at_pose_.failed);
  effects_[open_.value] = std::move(at_pose_.effects);
  at_pose_ = no_samples();
}

std::size_t Collector::units_done(std::size_t pose) const {
  if (is_finished(pose)) return plan_->units_per_cell();
  const SolveCounts& solves = is_open(pose) ? at_pose_.solves : kept_[pose].solves;
  return static_cast<std::size_t>(solves.total() / Plan::kUnitSamples);
}

SolveCounts Collector::total() const {
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

EffectResult Collector::effects() const {
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
  leave_out_dependent(*plan_, found.effects);
  return found;
}

Result Collector::result() && {
  Result& found = columns_.result();
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

void Collector::finished_state(Archive& archive, std::size_t pose, std::size_t samples) {
  Result& result = columns_.result();
  for (std::size_t r = 0; r < responses_; ++r) {
    Moments moments = moments_(pose, r);
    archive.object(moments);
    if (archive.reads()) set_moments(r, pose, moments);
    sketched_state(archive, result, r, pose);
  }
  ends_state(archive, result.solves[pose], failed_[pose], 0);
  archive.expect(result.solves[pose].total() == samples, "has a finished pose with other samples");
  archive.optional(effects_[pose], plan_->factors().size(), responses_);
}

void Collector::state(Archive& archive, std::size_t samples) {
  const bool is_shorter = archive.reads() && samples < plan_->samples();
  for (std::size_t m = 0; m < columns_.result().poses(); ++m) {
    const bool finished = archive.flag(is_finished(m));
    archive.expect(!finished || (!is_finished(m) && !is_open(m)), "has a pose twice");
    if (finished) finished_state(archive, m, samples);
    kept_state(archive, m, finished ? samples : samples - 1);
    if (!is_shorter) continue;
    columns_.result().solves[m] = {};
    effects_[m].reset();
  }
  std::vector<QuantileSketch> read(responses_);
  archive.object(archive.reads() ? read : sketches_);
  if (archive.reads() && !is_shorter) merge_each(sketches_, read);
  if (archive.flag(at_pose_.solves.total() > 0)) open_state(archive, samples);
}

void Collector::open_state(Archive& archive, std::size_t samples) {
  archive.expect(at_pose_.solves.total() == 0, "has two unfinished poses");
  archive.number(open_.value, columns_.result().poses() - 1);
  archive.expect(!is_finished(open_.value), "has a pose twice");
  archive.object(at_pose_);
  expect_whole(archive, at_pose_.solves, samples - 1);
  if (!archive.reads() || samples == plan_->samples()) return;
  keep();
  at_pose_ = no_samples();
}

void Collector::kept_state(Archive& archive, std::size_t pose, std::size_t most_samples) {
  Bytes read;
  archive.block(archive.reads() ? read : kept_[pose].bytes);
  if (read.empty()) return;
  ByteReader from(read);
  const SolveCounts solves = read_state<PoseSamples>(from, responses_, plan_->factors().size()).solves;
  from.expect_end();
  expect_whole(archive, solves, most_samples);
  set_kept(pose, {solves, std::move(read)});
}

}  // namespace poesy::monte_carlo
