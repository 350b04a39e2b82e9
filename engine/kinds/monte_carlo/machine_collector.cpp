#include "engine/kinds/monte_carlo/machine_collector.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/monte_carlo/columns.h"
#include "engine/kinds/monte_carlo/yield.h"
#include "engine/kinds/monte_carlo/yield_by_map.h"

namespace poesy {
namespace {

constexpr std::uint64_t kKind = 4;  ///< no other state begins with this number

}  // namespace

MachineCollector::Counts::Counts(std::size_t responses, std::size_t poses)
    : at_pose({poses, responses}), largest(responses), rms(responses), solves(poses), failed(poses) {
  make_room({responses}, machines.by_limit);
  make_room({responses, poses}, machines.at_pose);
}

void MachineCollector::Counts::add(const MachineUnit& unit) {
  const auto add_block = [](QuantileSketch& sketch, const NumberBlock& block) { sketch.add(block); };
  for_each_pair(at_pose, unit.at_pose, add_block);
  for_each_pair(largest, unit.largest, add_block);
  for_each_pair(rms, unit.rms, add_block);
  merge_each(solves, unit.solves);
  merge_each(failed, unit.failed);
  rejected.insert(rejected.end(), unit.rejected.begin(), unit.rejected.end());
  machines.merge(unit.counts);
}

void MachineCollector::Counts::merge(const Counts& later) {
  merge_each(at_pose, later.at_pose);
  merge_each(largest, later.largest);
  merge_each(rms, later.rms);
  merge_each(solves, later.solves);
  merge_each(failed, later.failed);
  rejected.insert(rejected.end(), later.rejected.begin(), later.rejected.end());
  machines.merge(later.machines);
}

void MachineCollector::Counts::state(Archive& archive, const MachineTable& table, const NumberRange& range) {
  const std::size_t count = range.end - range.first;
  state_of_each(archive, at_pose);
  state_of_each(archive, largest);
  state_of_each(archive, rms);
  for (std::size_t m = 0; m < solves.size(); ++m) {
    archive.object(solves[m]);
    archive.expect(solves[m].total() == count, "has a pose with other machines");
    failed[m].state(archive, solves[m].not_converged(), range.first, range.end);
  }
  rejected_state(archive, rejected, table, range);
  archive.object(machines);
  archive.expect(machines.machines == count, "has counts of other machines");
}

MachineCollector::MachineCollector(const MachineTable& table, const Analysis& analysis, const NumberRange& units)
    : table_(&table), analysis_(&analysis), units_(units), counts_(table.responses(), table.plan().poses().size()) {}

std::size_t MachineCollector::next() const {
  if (tail_) return table_->units();
  return sums_.empty() ? units_.first : sums_.end();
}

void MachineCollector::add(std::size_t n, MachineUnit&& unit) {
  POESY_EXPECTS(n == next() && units_.holds(n));
  if (!table_->is_whole(n)) {
    tail_ = std::move(unit);
    return;
  }
  counts_.add(unit);
  sums_.add(n, *std::move(unit.sums));
}

SolveCounts MachineCollector::total() const {
  SolveCounts sum = total_of(counts_.solves);
  if (tail_) sum.merge(tail_->total);
  return sum;
}

std::vector<Estimate> MachineCollector::overall_means() const {
  if (sums_.empty()) return std::vector<Estimate>(table_->responses(), {kNaN, {kNaN, kNaN}});
  const std::vector<Moments> means = sums_.total().mean;
  std::vector<Estimate> estimates;
  for (const Moments& mean : means) estimates.push_back({mean.mean(), mean_interval(mean, analysis_->conf_level)});
  return estimates;
}

void MachineCollector::set_columns(const MachineSums& sums, MonteCarloResult& found, MonteCarloColumns& columns) const {
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
  leave_out_correlated(table_->plan(), found.effects_on_largest);
  if (!sums.scores) return found;
  found.yield = yield_of(counts_.machines, *sums.scores, analysis_->limits, analysis_->conf_level);
  if (sums.parts) found.yield->parts = parts_yield(*sums.parts, *found.yield);
  set_first_order(*table_, sums.fit ? &*sums.fit : nullptr, counts_.rejected, analysis_->conf_level, *found.yield);
  return found;
}

EffectResult MachineCollector::effects(const MachineSums& sums, std::span<const BinSpread> spreads) const {
  const std::size_t at_poses = table_->effect_poses().size();
  EffectResult found = effect_result(table_->effect_poses(), spreads, analysis_->conf_level);
  found.effects = main_effects(std::span(sums.effects).first(at_poses), Dependence::unknown, sums.effects[at_poses],
                               spreads, table_->responses(), analysis_->conf_level);
  leave_out_correlated(table_->plan(), found.effects);
  return found;
}

MonteCarloResult MachineCollector::result() && {
  if (tail_) {
    counts_.add(*tail_);
    sums_.add(table_->units() - 1, *std::move(tail_->sums));
    tail_.reset();
  }
  const MachineSums sums = sums_.empty() ? MachineSums(*table_) : std::move(sums_).total();
  MonteCarloColumns columns(poses(), table_->responses(), *analysis_);
  MonteCarloResult& found = columns.result();
  set_columns(sums, found, columns);
  const std::vector<BinSpread> spreads = bin_spreads(table_->plan());
  found.machines = machines(sums, spreads);
  found.effects = effects(sums, spreads);
  const MonteCarloOptions& asked = asked_of<MonteCarloOptions>(*analysis_);
  if (analysis_->limits.empty()) return std::move(found);
  if (asked.judge == Judge::yield) {
    found.verdicts = judge_machines(analysis_->limits, asked.yield, *found.machines->yield, total(), counts_.machines,
                                    counts_.largest);
    return std::move(found);
  }
  std::vector<QuantileSketch> overall(table_->responses());
  for (std::size_t m = 0; m < poses(); ++m) {
    for (std::size_t r = 0; r < overall.size(); ++r) overall[r].merge(counts_.at_pose(m, r));
  }
  found.verdicts = judge_draws(analysis_->limits, asked.judge, asked.share, found, overall);
  return std::move(found);
}

void MachineCollector::write_state(ByteWriter& to) const {
  for (const std::uint64_t number :
       std::array<std::uint64_t, 5>{kKind, table_->responses(), poses(), table_->errors(), table_->plan().samples()}) {
    to.number(number);
  }
  to.number(sums_.empty() ? 0 : 1);
  if (!sums_.empty()) {
    sums_.write(to);
    to.number(sums_.first());
    to.number(sums_.end());
    poesy::write_state(counts_, to, *table_, NumberRange{0, 0});
  }
  to.number(tail_ ? 1 : 0);
  if (tail_) tail_->write(to);
}

void MachineCollector::restore(std::span<const std::byte> state) {
  ByteReader from(state);
  while (from.left() > 0) restore_one(from);
}

void MachineCollector::restore_one(ByteReader& from) {
  for (const std::uint64_t expected :
       std::array<std::uint64_t, 4>{kKind, table_->responses(), poses(), table_->errors()}) {
    if (from.number() != expected) throw BytesError("is the state of another kind or size of study");
  }
  if (tail_) throw BytesError("goes on after the last machine");
  const auto samples = static_cast<std::size_t>(from.number_up_to(table_->plan().samples()));
  const std::size_t each = MachineTable::unit_machines(poses());
  if (from.number_up_to(1) == 1) {
    const std::size_t before = next();
    sums_.read(from, samples / each, [&](ByteReader& bytes, std::size_t, std::size_t leaves) {
      auto sums = read_state<MachineSums>(bytes, *table_);
      if (sums.effects.front().samples() > leaves * each) throw BytesError("has sums of other machines");
      return sums;
    });
    const auto first = static_cast<std::size_t>(from.number_up_to(samples / each));
    const auto end = static_cast<std::size_t>(from.number_up_to(samples / each));
    if (first != before || end != sums_.end() || first >= end) throw BytesError("has sums of other machines");
    Counts counts(table_->responses(), poses());
    Archive archive(from);
    counts.state(archive, *table_, {first * each, end * each});
    counts_.merge(counts);
  }
  if (from.number_up_to(1) == 0) return;
  const bool same = samples == table_->plan().samples();
  if (samples % each == 0) throw BytesError("has a last unit that is whole");
  MachineUnit tail = MachineUnit::read(from, *table_, {samples / each * each, samples});
  if (!same) return;
  if (next() != samples / each) throw BytesError("lacks units before the last");
  tail_ = std::move(tail);
}

}  // namespace poesy
