#include "engine/kinds/monte_carlo/machine_unit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "engine/base/contract.h"

namespace poesy::monte_carlo {
namespace {

/// How many machines of a range are among the first MachineTable::kept() machines.
std::size_t kept_of(const MachineTable& table, const NumberRange& machines) {
  return std::min(machines.end, table.kept()) - std::min(machines.first, table.kept());
}

}  // namespace

void CalibrationCounts::merge(const CalibrationCounts& other) {
  not_fitted += other.not_fitted;
  uncalibrated += other.uncalibrated;
  best += other.best;
}

void CalibrationCounts::state(Archive& archive, std::uint64_t machines) {
  for (std::uint64_t* count : {&not_fitted, &uncalibrated, &best}) archive.number(*count, machines);
}

void rejected_state(Archive& archive, std::vector<std::uint8_t>& rejected, const MachineTable& table,
                    const NumberRange& machines) {
  const std::span<const std::byte> flags = std::as_bytes(std::span(rejected));
  Bytes bytes(flags.begin(), flags.end());
  archive.block(bytes);
  if (!archive.reads()) return;
  rejected.clear();
  for (const std::byte flag : bytes) rejected.push_back(std::to_integer<std::uint8_t>(flag));
  archive.expect(rejected.size() == kept_of(table, machines) &&
                     std::ranges::none_of(rejected, [](std::uint8_t flag) { return flag > 1; }),
                 "has flags of other machines");
}

namespace {

void merge_fit(std::optional<LinearFitSums>& fit, const std::optional<LinearFitSums>& later) {
  if (later && fit) fit->merge(*later);
  if (later && !fit) fit = later;
}

}  // namespace

MachineSums::MachineSums(const MachineTable& table)
    : at_pose({table.plan().poses().size(), table.responses()}),
      mean(table.responses()),
      largest(table.responses()),
      rms(table.responses()),
      table_(&table) {
  if (table.has_limits()) scores.emplace(table.fixed_scores());
  if (table.has_limits() && table.has_per_pose() && table.judges_each_pose()) pose_scores.emplace(table.pose_scores());
  if (table.has_per_pose()) fit_at_pose.resize(table.plan().poses().size());
  if (table.has_parts()) parts.emplace(table.parts());
  effects.assign(table.effects(), MainEffectSums(table.errors(), table.responses()));
}

void MachineSums::merge(const MachineSums& later) {
  merge_each(at_pose, later.at_pose);
  merge_each(mean, later.mean);
  merge_each(largest, later.largest);
  merge_each(rms, later.rms);
  if (scores) scores->merge(*later.scores);
  if (pose_scores) pose_scores->merge(*later.pose_scores);
  merge_fit(fit, later.fit);
  for_each_pair(fit_at_pose, later.fit_at_pose, merge_fit);
  if (parts) parts->merge(*later.parts);
  merge_each(effects, later.effects);
}

std::optional<LinearFit> MachineSums::map() const {
  if (fit_at_pose.empty()) return fit ? fit->fit() : std::nullopt;
  std::vector<LinearFit> at_poses;
  for (const auto& one : fit_at_pose) {
    auto found = one ? one->fit() : std::nullopt;
    if (!found) return std::nullopt;
    at_poses.push_back(*std::move(found));
  }
  return joined(at_poses);
}

void MachineSums::state(Archive& archive) {
  archive.objects(at_pose, mean, largest, rms);
  if (scores) archive.object(*scores);
  if (pose_scores) archive.object(*pose_scores);
  for (auto& one : fit_at_pose) archive.optional(one, table_->errors(), table_->vectors().rows());
  archive.optional(fit, table_->errors(), table_->vectors().rows() * table_->plan().poses().size());
  archive.expect(!fit || table_->vectors().rows() > 0, "has a fit of vectors that are not limited");
  if (parts) archive.object(*parts);
  archive.object(effects);
}

MachineUnit::MachineUnit(const MachineTable& table, const NumberRange& range)
    : sums(MachineSums(table)),
      counts(MachineCounts::of_none(table.responses(), table.plan().poses().size())),
      at_pose({table.plan().poses().size(), table.responses()}),
      largest(table.responses()),
      rms(table.responses()),
      judged(table.judged().size()),
      rejected(kept_of(table, range)),
      solves(table.plan().poses().size()),
      failed(table.plan().poses().size()),
      table_(&table),
      machines_(range) {}

void MachineUnit::state(Archive& archive) {
  archive.objects(*sums, counts, at_pose, largest, rms, judged);
  if (table_->calibration() != nullptr) calibration.state(archive, machines_.end - machines_.first);
  rejected_state(archive, rejected, *table_, machines_);
  ends_state(archive, solves, failed, machines_.end - machines_.first, machines_.first, machines_.end);
  total = total_of(solves);
}

MachineUnitEvaluator::MachineUnitEvaluator(const MachineTable& table, const Model& model)
    : UnitSolver(table.plan(), model, table.errors()), table_(&table) {
  const std::size_t machines = table.unit_machines();
  counts_.resize(machines);
  kept_.reserve(machines);
  if (table.calibration() == nullptr) return;
  calibrator_ = std::make_unique<MachineCalibrator>(*table.calibration());
  best_ = model.calibrated_evaluator(table.plan().solver());
}

std::span<const double> MachineUnitEvaluator::only(std::span<const double> values,
                                                   std::span<const std::uint8_t> counts) {
  if (std::ranges::all_of(counts, [](std::uint8_t one) { return one == 1; })) return values;
  kept_.clear();
  for (std::size_t b = 0; b < values.size(); ++b) {
    if (counts[b] == 1) kept_.push_back(values[b]);
  }
  return kept_;
}

void MachineUnitEvaluator::solve_pose(const WorkUnit& unit, std::size_t pose, const EffectBins& bins,
                                      MachineBlock& block, MachineUnit& found) {
  const UnitOutcomes outcomes = UnitSolver::solve(PoseIndex(pose), plan_->factors(), unit.count, 0.0, details_.all());
  if (is_fitted_)
    table_->vectors().fill(PoseIndex(pose), outcomes, details_,
                           {rows_.row(pose), {rows_.length<axis::VectorRow>(), unit.count}});
  const std::span ok = std::span(counts_).first(unit.count);
  for (std::size_t b = 0; b < unit.count; ++b) {
    ok[b] = counts(outcomes.status[b], plan_->not_converged()) ? 1 : 0;
    found.solves[pose].add(outcomes.status[b], outcomes.iterations[b]);
    found.failed[pose].add(SampleIndex(unit.first.value + b), outcomes.status[b]);
  }
  block.add_pose(outcomes.responses, ok);
  if (found.sums->pose_scores) note_rejects(outcomes, ok);
  if (is_fitted_ && table_->has_per_pose()) add_fit_at(pose, ok, found);
  const ArrayView<const double, axis::Response, axis::Sample> responses(outcomes.responses, sum_.lengths());
  for (std::size_t r = 0; r < responses_; ++r) {
    const std::span all = responses.row(r);
    std::ranges::transform(sum_.row(r), all, sum_.row(r).begin(), std::plus());
    const std::span<const double> kept = only(all, ok);
    found.sums->at_pose(pose, r) = Moments::of(kept);
    found.at_pose(pose, r) = NumberBlock(kept);
  }
  const auto place = std::ranges::find(table_->effect_poses(), PoseIndex(pose));
  if (place == table_->effect_poses().end()) return;
  const auto k = static_cast<std::size_t>(place - table_->effect_poses().begin());
  found.sums->effects[k].add(bins, outcomes.responses, ok);
}

void MachineUnitEvaluator::add_machines(const MachineBlock& block, const EffectBins& bins, MachineUnit& found) {
  for (double& sum : sum_) sum /= static_cast<double>(block.poses());
  const auto largest = block.largest();
  const auto rms = block.root_mean_square();
  for (std::size_t r = 0; r < responses_; ++r) {
    found.sums->mean[r] = Moments::of(only(sum_.row(r), block.solved()));
    const std::span<const double> largest_kept = only(largest.row(r), block.solved());
    found.largest[r] = NumberBlock(largest_kept);
    found.sums->largest[r] = Moments::of(largest_kept);
    const std::span<const double> rms_kept = only(rms.row(r), block.solved());
    found.rms[r] = NumberBlock(rms_kept);
    found.sums->rms[r] = Moments::of(rms_kept);
  }
  for (std::size_t k = 0; k < table_->judged().size(); ++k) {
    found.judged[k] = NumberBlock(only(block.deciding(table_->judged()[k]), block.solved()));
  }
  const std::size_t at_poses = table_->effect_poses().size();
  found.sums->effects[at_poses].add(bins, sum_, block.solved());
  found.sums->effects[at_poses + 1].add(bins, largest, block.solved());
  if (!found.sums->scores) return;
  const std::vector<std::uint8_t> rejected = block.rejected();
  const std::span errors = std::span(values_).first(table_->errors() * block.machines());
  found.sums->scores->add(errors, rejected);
  if (found.sums->pose_scores) {
    for (std::uint8_t& poses : poses_beyond_) poses = poses == 1 ? 1 : 0;
    found.sums->pose_scores->add(deciding_.all(), poses_beyond_);
  }
  if (found.sums->parts) found.sums->parts->add(errors, rejected);
  if (is_fitted_ && !table_->has_per_pose()) {
    centre_rows();
    add_fit(block.solved(), found);
  }
  found.rejected = rejected;
}

void MachineUnitEvaluator::centre_rows() {
  const std::size_t poses = plan_->poses().size();
  const std::size_t machines = rows_.length<axis::Sample>();
  for (const LimitedVector& vector : table_->vectors().each()) {
    if (!vector.is_centred) continue;
    for (std::size_t b = 0; b < machines; ++b) {
      double mean = 0.0;
      for (std::size_t m = 0; m < poses; ++m) mean += rows_(m, vector.first_row, b) / static_cast<double>(poses);
      for (std::size_t m = 0; m < poses; ++m) rows_(m, vector.first_row, b) -= mean;
    }
  }
}

Array<double, axis::Factor, axis::Sample> MachineUnitEvaluator::standardised(std::size_t machines) const {
  const std::size_t errors = table_->errors();
  const std::span<const double> drawn = std::span(values_).first(errors * machines);
  const ArrayView<const double, axis::Factor, axis::Sample> values(drawn, {errors, machines});
  Array<double, axis::Factor, axis::Sample> x(values.lengths());
  for (std::size_t p = 0; p < errors; ++p) {
    const Distribution& error = plan_->distributions()[p];
    std::ranges::transform(values.row(p), x.row(p).begin(),
                           [&](double one) { return (one - error.mean()) / error.standard_deviation(); });
  }
  return x;
}

void MachineUnitEvaluator::add_fit(std::span<const std::uint8_t> solved, MachineUnit& found) const {
  found.sums->fit.emplace(table_->errors(), table_->vectors().rows() * plan_->poses().size());
  found.sums->fit->add(standardised(solved.size()).all(), rows_.all(), solved);
}

void MachineUnitEvaluator::add_fit_at(std::size_t pose, std::span<const std::uint8_t> ok, MachineUnit& found) const {
  std::optional<LinearFitSums>& fit = found.sums->fit_at_pose[pose];
  fit.emplace(table_->errors(), table_->vectors().rows());
  fit->add(standardised(ok.size()).all(), rows_.row(pose), ok);
}

void MachineUnitEvaluator::note_rejects(const UnitOutcomes& outcomes, std::span<const std::uint8_t> ok) {
  const ArrayView<const double, axis::Response, axis::Sample> responses(outcomes.responses, sum_.lengths());
  const ArrayView<const double, axis::Factor, axis::Sample> errors(outcomes.values, deciding_.lengths());
  for (std::size_t b = 0; b < ok.size(); ++b) {
    bool is_beyond = ok[b] == 0;
    for (std::size_t r = 0; r < responses_ && !is_beyond; ++r) {
      is_beyond = !table_->limits()[r].holds(responses(r, b));
    }
    if (!is_beyond || poses_beyond_[b] == 2) continue;
    if (++poses_beyond_[b] == 2) continue;
    for (const std::size_t p : plan_->per_pose()) deciding_(p, b) = errors(p, b);
  }
}

std::uint64_t MachineUnitEvaluator::count_rejects(const WorkUnit& unit) {
  if (!table_->has_limits()) return 0;
  MachineBlock block(table_->limits(), unit.count);
  std::vector<std::uint8_t> ok(unit.count);
  for (std::size_t m = 0; m < plan_->poses().size(); ++m) {
    const UnitOutcomes outcomes = UnitSolver::solve(PoseIndex(m), plan_->factors(), unit.count, 0.0);
    for (std::size_t b = 0; b < unit.count; ++b) ok[b] = counts(outcomes.status[b], plan_->not_converged()) ? 1 : 0;
    block.add_pose(outcomes.responses, ok);
  }
  return block.counts().all.strict;
}

void MachineUnitEvaluator::calibrate(const WorkUnit& unit, MachineUnit& found) {
  solve_by(nullptr);
  found.calibration.uncalibrated = count_rejects(unit);
  if (best_ != nullptr) {
    solve_by(best_.get());
    found.calibration.best = count_rejects(unit);
  }
  std::vector<std::size_t> machines(unit.count);
  std::iota(machines.begin(), machines.end(), unit.first.value);
  calibration::Controllers controllers = (*calibrator_)(all_errors(drawn(unit.count)), machines);
  found.calibration.not_fitted = static_cast<std::uint64_t>(controllers.errors.row(0).array().isNaN().count());
  calibrated_ = table_->calibration()->evaluator(std::move(controllers));
  solve_by(calibrated_.get());
}

void MachineUnitEvaluator::draw_at(const WorkUnit& unit, std::size_t pose, EffectBins& bins) {
  if (pose == 0 || !table_->has_per_pose()) return;
  const WorkUnit at_pose{unit.slot, PoseIndex(pose), unit.first, unit.count};
  const bool has_effects = std::ranges::find(table_->effect_poses(), PoseIndex(pose)) != table_->effect_poses().end();
  if (has_effects) {
    bins = draw_in_bins(at_pose);
  } else {
    draw_per_pose(at_pose);
  }
}

MachineUnit MachineUnitEvaluator::operator()(std::size_t n) {
  const WorkUnit unit = table_->unit(n);
  const std::size_t poses = plan_->poses().size();
  MachineUnit found(*table_, {unit.first.value, unit.first.value + unit.count});
  EffectBins bins = draw_in_bins(unit);
  make_room({responses_, unit.count}, sum_);
  is_fitted_ = table_->is_fitted(n);
  const LimitedVectors& vectors = table_->vectors();
  make_room({is_fitted_ ? vectors.details() : 0, unit.count}, details_);
  make_room({poses, is_fitted_ ? vectors.rows() : 0, unit.count}, rows_);
  poses_beyond_.assign(table_->has_per_pose() ? unit.count : 0, 0);
  make_room({table_->has_per_pose() ? table_->errors() : 0, unit.count}, deciding_);
  if (calibrator_ != nullptr) calibrate(unit, found);
  MachineBlock block(table_->limits(), unit.count);
  for (std::size_t m = 0; m < poses; ++m) {
    draw_at(unit, m, bins);
    solve_pose(unit, m, bins, block, found);
  }
  found.counts = block.counts();
  add_machines(block, bins, found);
  found.rejected.resize(kept_of(*table_, {unit.first.value, unit.first.value + unit.count}));
  found.total = total_of(found.solves);
  return found;
}

}  // namespace poesy::monte_carlo
