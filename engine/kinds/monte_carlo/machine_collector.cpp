#include "engine/kinds/monte_carlo/machine_collector.h"

#include <algorithm>
#include <span>
#include <utility>

#include "engine/base/nan.h"
#include "engine/kinds/monte_carlo/columns.h"
#include "engine/kinds/monte_carlo/yield.h"
#include "engine/kinds/monte_carlo/yield_by_map.h"

namespace poesy::monte_carlo {

MachineCollector::Counts::Counts(const MachineTable& table)
    : at_pose({table.plan().poses().size(), table.responses()}),
      largest(table.responses()),
      rms(table.responses()),
      judged(table.judged().size()),
      solves(table.plan().poses().size()),
      failed(table.plan().poses().size()),
      machines(MachineCounts::of_none(table.responses(), table.plan().poses().size())) {}

void MachineCollector::Counts::add(const MachineUnit& unit) {
  const auto add_block = [](QuantileSketch& sketch, const NumberBlock& block) { sketch.add(block); };
  for_each_pair(at_pose, unit.at_pose, add_block);
  for_each_pair(largest, unit.largest, add_block);
  for_each_pair(rms, unit.rms, add_block);
  for_each_pair(judged, unit.judged, add_block);
  merge_each(solves, unit.solves);
  merge_each(failed, unit.failed);
  rejected.insert(rejected.end(), unit.rejected.begin(), unit.rejected.end());
  machines.merge(unit.counts);
  calibration.merge(unit.calibration);
}

void MachineCollector::Counts::merge(const Counts& later) {
  merge_each(at_pose, later.at_pose);
  merge_each(largest, later.largest);
  merge_each(rms, later.rms);
  merge_each(judged, later.judged);
  merge_each(solves, later.solves);
  merge_each(failed, later.failed);
  rejected.insert(rejected.end(), later.rejected.begin(), later.rejected.end());
  machines.merge(later.machines);
  calibration.merge(later.calibration);
}

void MachineCollector::Counts::state(Archive& archive, const MachineTable& table, const NumberRange& range) {
  const std::size_t count = range.end - range.first;
  archive.objects(at_pose, largest, rms, judged);
  ends_state(archive, solves, failed, count, range.first, range.end);
  rejected_state(archive, rejected, table, range);
  archive.object(machines);
  archive.expect(machines.machines == count, "has counts of other machines");
  if (table.calibration() != nullptr) calibration.state(archive, count);
}

MachineCollector::MachineCollector(const MachineTable& table, const Analysis& analysis)
    : table_(&table), analysis_(&analysis), counts_(table) {}

void MachineCollector::add(std::size_t n, MachineUnit&& unit) {
  counts_.add(unit);
  sums_.add(n, *std::move(unit.sums));
}

std::vector<Estimate> MachineCollector::overall_means() const {
  if (sums_.empty()) return std::vector<Estimate>(table_->responses(), {kNaN, {kNaN, kNaN}});
  const std::vector<Moments> means = sums_.total().mean;
  std::vector<Estimate> estimates;
  for (const Moments& mean : means) estimates.push_back({mean.mean(), mean_interval(mean, analysis_->conf_level)});
  return estimates;
}

void MachineCollector::set_columns(const MachineSums& sums, Result& found, MonteCarloColumns& columns) const {
  for (std::size_t m = 0; m < poses(); ++m) {
    found.solves[m] = counts_.solves[m];
    append_failures(0, PoseIndex(m), counts_.failed[m], found.failures);
  }
  for (std::size_t r = 0; r < table_->responses(); ++r) {
    Moments moments;
    QuantileSketch sketch;
    for (std::size_t m = 0; m < poses(); ++m) {
      columns.set_moments(r, m, sums.at_pose(m, r));
      columns.set_quantiles(r, m, counts_.at_pose(m, r), counts_.solves[m].total());
      moments.merge(sums.at_pose(m, r));
      sketch.merge(counts_.at_pose(m, r));
    }
    columns.set_overall(r, moments, sketch, counts_.machines.machines);
  }
}

MachineResult MachineCollector::machines(const MachineSums& sums, std::span<const BinSpread> spreads) const {
  const std::size_t at_poses = table_->effect_poses().size();
  MachineResult found;
  found.conf_level = analysis_->conf_level;
  found.largest = machine_values(sums.largest, counts_.largest, *analysis_);
  found.rms = machine_values(sums.rms, counts_.rms, *analysis_);
  found.effects_on_largest =
      main_effects(std::span(sums.effects).subspan(at_poses + 1, 1), Dependence::unknown, sums.effects[at_poses + 1],
                   spreads, table_->responses(), analysis_->conf_level);
  leave_out_dependent(table_->plan(), found.effects_on_largest);
  leave_out_per_pose(table_->plan(), found.effects_on_largest);
  if (!sums.scores) return found;
  found.yield = yield_of(counts_.machines, *sums.scores, analysis_->limits, analysis_->conf_level);
  if (table_->calibration() != nullptr) {
    found.calibration = calibration_yields(counts_.calibration, *table_->calibration(), *found.yield);
  }
  if (sums.parts) found.yield->parts = parts_yield(*sums.parts, *found.yield);
  if (sums.pose_scores) set_pose_gradient(table_->plan(), *sums.pose_scores, *found.yield);
  const std::span<const std::uint8_t> rejected(counts_.rejected);
  set_first_order(*table_, sums.map(), rejected.first(std::min(rejected.size(), table_->mapped())),
                  analysis_->conf_level, *found.yield);
  return found;
}

EffectResult MachineCollector::effects(const MachineSums& sums, std::span<const BinSpread> spreads) const {
  const std::size_t at_poses = table_->effect_poses().size();
  EffectResult found = effect_result(table_->effect_poses(), spreads, analysis_->conf_level);
  found.effects = main_effects(std::span(sums.effects).first(at_poses), Dependence::unknown, sums.effects[at_poses],
                               spreads, table_->responses(), analysis_->conf_level);
  leave_out_dependent(table_->plan(), found.effects);
  leave_out_curves_per_pose(table_->plan(), found.effects);
  return found;
}

Result MachineCollector::result() && {
  const MachineSums sums = sums_.empty() ? MachineSums(*table_) : std::move(sums_).total();
  MonteCarloColumns columns(poses(), table_->responses(), *analysis_);
  Result& found = columns.result();
  set_columns(sums, found, columns);
  const std::vector<BinSpread> spreads = bin_spreads(table_->plan());
  found.machines = machines(sums, spreads);
  found.effects = effects(sums, spreads);
  found.rejected = std::move(counts_.rejected);
  const Options& asked = asked_of<Options>(*analysis_);
  if (analysis_->limits.empty()) return std::move(found);
  if (asked.judge == Judge::yield) {
    found.verdicts = judge_machines(analysis_->limits, asked.yield, *found.machines->yield, total_of(counts_.solves),
                                    counts_.machines, judged_values());
    return std::move(found);
  }
  std::vector<QuantileSketch> overall(table_->responses());
  for (std::size_t m = 0; m < poses(); ++m) {
    for (std::size_t r = 0; r < overall.size(); ++r) overall[r].merge(counts_.at_pose(m, r));
  }
  found.verdicts = judge_draws(analysis_->limits, asked.judge, asked.share, found, overall);
  return std::move(found);
}

std::vector<QuantileSketch> MachineCollector::judged_values() const {
  std::vector<QuantileSketch> values = counts_.largest;
  for (std::size_t k = 0; k < counts_.judged.size(); ++k) values[table_->judged()[k]] = counts_.judged[k];
  return values;
}

void MachineCollector::state(Archive& archive, const NumberRange& units) {
  constexpr const char* kOthers = "has sums of other machines";
  const std::size_t each = table_->unit_machines();
  const std::size_t first = sums_.empty() ? units.first : sums_.first();
  sums_.state(archive, table_->units(), MachineSums(*table_));
  archive.expect(sums_.empty() ? units.first == units.end : sums_.first() == first && sums_.end() == units.end,
                 kOthers);
  for (const auto& node : sums_.nodes()) {
    archive.expect(node.sum.effects.front().samples() <= node.leaves * each, kOthers);
  }
  const NumberRange machines{units.first * each, units.end * each};
  if (!archive.reads()) return counts_.state(archive, *table_, machines);
  Counts counts(*table_);
  counts.state(archive, *table_, machines);
  counts_.merge(counts);
}

}  // namespace poesy::monte_carlo
