#include "engine/kinds/sobol/panel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/contract.h"
#include "engine/random/normal_quantile.h"
#include "engine/run/response_rounding.h"
#include "engine/stats/sums.h"

namespace poesy::sobol {
namespace {

/// The number of components of all additional outputs of the model (Detail in model/model.h).
std::size_t detail_components(const ModelDescription& model) {
  std::size_t count = 0;
  for (const Detail& detail : model.details) count += detail.components.size();
  return count;
}

/// Whether some vector has a component that is not a response but a component of an additional output.
bool need_details(const std::vector<SignedVector>& vectors, std::size_t responses) {
  return std::ranges::any_of(vectors, [&](const SignedVector& vector) {
    return std::ranges::any_of(vector.components, [&](std::size_t component) { return component >= responses; });
  });
}

/// Blocks of correlated errors that belong to several groups.
std::vector<SplitBlock> split_blocks(const Plan& plan, std::span<const ErrorGroup> groups) {
  std::vector<SplitBlock> blocks;
  for (const CorrelatedSlots& correlated : plan.correlated()) {
    SplitBlock block{correlated.slots, {}, &correlated.copula};
    for (const std::size_t slot : correlated.slots) {
      const auto group = std::ranges::find_if(
          groups, [&](const ErrorGroup& one) { return std::ranges::find(one.members, slot) != one.members.end(); });
      block.groups.push_back(static_cast<std::size_t>(group - groups.begin()));
    }
    const auto is_other = [&](std::size_t group) { return group != block.groups.front(); };
    if (std::ranges::any_of(block.groups, is_other)) blocks.push_back(std::move(block));
  }
  return blocks;
}

/// The weight of a subset of `size` groups in the Shapley effect of a group that is not in it, s! (n - s - 1)! / n! for
/// size s and n groups (Shapley 1953; for variances Owen 2014, SIAM/ASA J. Uncertain. Quantif. 2, 245-251).
double shapley_weight(std::size_t size, std::size_t groups) {
  double weight = 1.0 / static_cast<double>(groups);
  for (std::size_t k = 1; k <= size; ++k) weight *= static_cast<double>(k) / static_cast<double>(groups - k);
  return weight;
}

RatioSums mean_of(const RatioSums& sums) {
  RatioSums one;
  if (sums.count() > 0) one.add(sums.mean_x(), sums.mean_w());
  return one;
}

}  // namespace

IndexPanel::IndexPanel(const Study& study, std::size_t pose_count)
    : groups(error_groups(study.analysis, study.model())),
      vectors(signed_vectors(study.model())),
      samples(study.analysis.samples),
      responses(study.model().responses.size()),
      details(need_details(vectors, responses) ? detail_components(study.model()) : 0),
      poses(pose_count),
      split(split_groups(groups, study)),
      shapley(asked_of<Options>(study.analysis).shapley) {
  for (std::size_t r = 0; r < responses; ++r) components_.push_back({r});
  for (const SignedVector& vector : vectors) components_.push_back(vector.components);
  if (!asked_of<Options>(study.analysis).second_order) return;
  pairs = group_pairs(groups.size());
}

std::span<const std::size_t> IndexPanel::components(std::size_t quantity) const { return components_[quantity]; }

void IndexSums::merge(const IndexSums& later) {
  total.merge(later.total);
  first.merge(later.first);
}

void IndexSums::state(Archive& archive) { archive.objects(total, first); }

PanelSums::PanelSums(const IndexPanel& panel)
    : at_poses({panel.responses, panel.groups.size(), panel.poses}),
      aggregated({panel.quantities(), panel.groups.size()}),
      pairs({panel.responses, panel.pairs.size()}),
      moments({panel.rows(), panel.poses}),
      least({panel.responses}, std::numeric_limits<double>::infinity()),
      solves(panel.poses),
      failed(panel.poses),
      failures(panel.poses),
      end(panel.samples) {
  if (panel.shapley) make_room({panel.responses, panel.groups.size()}, shapley);
}

void PanelSums::merge(const PanelSums& later) {
  merge_each(at_poses, later.at_poses);
  merge_each(aggregated, later.aggregated);
  merge_each(pairs, later.pairs);
  merge_each(shapley, later.shapley);
  merge_each(moments, later.moments);
  for (std::size_t r = 0; r < least.size(); ++r) least(r) = std::min(least(r), later.least(r));
  merge_each(solves, later.solves);
  merge_each(failed, later.failed);
  for (std::size_t m = 0; m < failures.size(); ++m) failures[m] += later.failures[m];
}

PanelSums PanelSums::as_one() const {
  PanelSums one = *this;
  for (const std::span<IndexSums> list : {one.at_poses.all(), one.aggregated.all()}) {
    for (IndexSums& index : list) index = {mean_of(index.total), mean_of(index.first)};
  }
  for (RatioSums& pair : one.pairs) pair = mean_of(pair);
  for (RatioSums& effect : one.shapley) effect = mean_of(effect);
  return one;
}

void PanelSums::state(Archive& archive) {
  archive.objects(at_poses, aggregated, pairs, shapley, moments);
  archive.reals(least.all());
  archive.object(solves);
  for (std::size_t m = 0; m < failed.size(); ++m) {
    archive.number(failures[m], solves[m].not_converged());
    failed[m].state(archive, failures[m], 0, end);
  }
}

SplitDraws::SplitDraws(SplitBlock split, std::size_t subsets) : block(std::move(split)) {
  for (std::size_t subset = 0; subset < subsets; ++subset) {
    Mixture& mixture = mixtures.emplace_back();
    for (std::size_t k = 0; k < block.slots.size(); ++k) {
      const bool is_drawn = (subset >> block.groups[k] & 1U) != 0;
      (is_drawn ? mixture.drawn : mixture.shared).push_back(k);
    }
    if (mixture.drawn.empty() || mixture.shared.empty()) continue;
    mixture.scores.emplace(*block.copula, mixture.shared, mixture.drawn);
  }
}

PanelEvaluator::PanelEvaluator(const Plan& plan, const Model& model, const IndexPanel& panel, const PanelDesign& design)
    : plan_(&plan),
      panel_(&panel),
      design_(&design),
      evaluator_(model.evaluator(plan.solver())),
      rounding_(response_rounding(model)) {
  if (!panel.shapley) return;
  for (SplitBlock& block : split_blocks(plan, panel.groups)) split_.emplace_back(std::move(block), panel.subsets());
}

void PanelEvaluator::begin_scratch(std::size_t samples) {
  const std::size_t responses = panel_->responses;
  const std::size_t groups = panel_->groups.size();
  const std::size_t quantities = panel_->quantities();
  make_room({plan_->factors().size(), samples}, a_, b_);
  for (Outcomes* outcomes : {&of_a_, &of_b_, &of_mixed_}) {
    make_room({panel_->rows(), samples}, outcomes->values);
    outcomes->counts.resize(samples);
  }
  make_room({quantities, samples}, between_);
  for (GroupRows* rows : {&at_pose_, &over_poses_}) {
    make_room({quantities, groups, samples}, rows->total, rows->first, rows->between);
  }
  make_room({responses, panel_->pairs.size(), samples}, pair_first_, pair_between_);
  make_room({groups, samples}, group_counts_);
  status_.resize(samples);
  iterations_.resize(samples);
  if (!panel_->shapley) return;
  for (SplitDraws& draws : split_) {
    make_room({draws.block.slots.size(), samples}, draws.scores, draws.normals);
  }
  make_room({panel_->subsets(), responses, samples}, differences_);
  all_count_.resize(samples);
  make_room({responses, groups, samples}, shapley_);
  make_room({responses, samples}, shapley_between_);
}

void PanelEvaluator::begin(const PanelUnit& unit) {
  unit_ = unit;
  begin_scratch(unit.count);
  for (const auto& [sample, errors] : {std::pair(PanelSample::A, &a_), std::pair(PanelSample::B, &b_)}) {
    for (std::size_t slot = 0; slot < plan_->factors().size(); ++slot) {
      design_->fill(sample, slot, unit, errors->row(slot));
    }
    keep_scores(sample, *errors);
    plan_->transform(errors->all(), unit.count);
  }
  mixed_ = a_;
  sums_ = PanelSums(*panel_);
}

void PanelEvaluator::keep_scores(PanelSample sample, const OfSamples<axis::Factor>& uniforms) {
  for (SplitDraws& draws : split_) {
    auto& kept = sample == PanelSample::A ? draws.scores : draws.normals;
    std::vector<std::span<double>> rows;
    for (std::size_t k = 0; k < draws.block.slots.size(); ++k) {
      rows.push_back(kept.row(k));
      std::ranges::copy(uniforms.row(draws.block.slots[k]), rows.back().begin());
      normal_quantiles(1.0, rows.back());
    }
    if (sample == PanelSample::A) draws.block.copula->correlate(rows);
  }
}

void PanelEvaluator::solve(PoseIndex pose, const OfSamples<axis::Factor>& errors, Outcomes& outcomes) {
  const std::span values = outcomes.values.all();
  const std::span responses = values.first(panel_->responses * unit_.count);
  const PoseSet& poses = plan_->poses();
  evaluator_->evaluate(
      {poses[pose], plan_->background(), plan_->factors(), errors.all(), unit_.count, 0.0, poses.before(pose)},
      {responses, status_, iterations_, values.subspan(responses.size())});
  SolveCounts& solves = sums_.solves[pose.value];
  for (std::size_t b = 0; b < unit_.count; ++b) {
    solves.add(status_[b], iterations_[b]);
    outcomes.counts[b] = counts(status_[b], plan_->not_converged()) ? 1 : 0;
  }
}

void PanelEvaluator::take(std::size_t group, const OfSamples<axis::Factor>& from) {
  for (const std::size_t slot : panel_->groups[group].members) {
    std::ranges::copy(from.row(slot), mixed_.row(slot).begin());
  }
}

void PanelEvaluator::mix(std::span<const std::size_t> groups) {
  for (const std::size_t group : groups) take(group, b_);
  if (!split_.empty()) draw_given(groups);
}

void PanelEvaluator::unmix(std::span<const std::size_t> groups) {
  for (const std::size_t group : groups) take(group, a_);
}

void PanelEvaluator::draw_given(std::span<const std::size_t> groups) {
  std::size_t subset = 0;
  for (const std::size_t group : groups) subset |= std::size_t{1} << group;
  for (SplitDraws& draws : split_) {
    const SplitDraws::Mixture& mixture = draws.mixtures[subset];
    if (!mixture.scores) continue;
    std::vector<std::span<const double>> shared;
    std::vector<std::span<const double>> normals;
    std::vector<std::span<double>> drawn;
    for (const std::size_t k : mixture.shared) shared.emplace_back(draws.scores.row(k));
    for (const std::size_t k : mixture.drawn) {
      normals.emplace_back(draws.normals.row(k));
      drawn.push_back(mixed_.row(draws.block.slots[k]));
    }
    mixture.scores->fill(shared, normals, drawn);
    for (const std::size_t k : mixture.drawn) {
      const std::size_t slot = draws.block.slots[k];
      plan_->distributions()[slot].transform_scores(mixed_.row(slot));
    }
  }
}

void PanelEvaluator::absorb() {
  const std::size_t rows = panel_->rows();
  for (std::size_t b = 0; b < unit_.count; ++b) {
    bool same = true;
    for (std::size_t r = 0; r < panel_->responses; ++r) {
      same = same && std::abs(of_a_.values(r, b) - of_mixed_.values(r, b)) <= rounding_[r];
    }
    for (std::size_t k = 0; same && k < rows; ++k) of_mixed_.values(k, b) = of_a_.values(k, b);
  }
}

void PanelEvaluator::add_squared_differences(std::size_t quantity, const Outcomes& one, const Outcomes& other,
                                             std::span<double> sum) const {
  for (const std::size_t component : panel_->components(quantity)) {
    const std::span x = one.values.row(component);
    const std::span y = other.values.row(component);
    for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += (x[b] - y[b]) * (x[b] - y[b]);
  }
}

void PanelEvaluator::add_samples(PoseIndex pose) {
  for (std::size_t b = 0; b < unit_.count; ++b) {
    sums_.failed[pose.value].add(SampleIndex(unit_.number + b), status_[b]);
    sums_.failures[pose.value] += solved(status_[b]) ? 0 : 1;
  }
}

void PanelEvaluator::add_pose(PoseIndex pose) {
  solve(pose, a_, of_a_);
  add_samples(pose);
  solve(pose, b_, of_b_);
  std::vector<double> kept;
  for (std::size_t row = 0; row < panel_->rows(); ++row) {
    Moments& moments = sums_.moments(row, pose.value);
    for (const Outcomes* outcomes : {&of_a_, &of_b_}) {
      kept.clear();
      for (std::size_t b = 0; b < unit_.count; ++b) {
        if (outcomes->counts[b] != 0) kept.push_back(outcomes->values(row, b));
      }
      moments.merge(Moments::of(kept));
      if (row >= panel_->responses) continue;
      for (const double value : kept) sums_.least(row) = std::min(sums_.least(row), value);
    }
  }
  std::ranges::fill(between_, 0.0);
  for (std::size_t q = 0; q < panel_->quantities(); ++q) add_squared_differences(q, of_a_, of_b_, between_.row(q));
  if (panel_->shapley) {
    for (std::size_t b = 0; b < unit_.count; ++b) all_count_[b] = of_a_.counts[b] & of_b_.counts[b];
  }
  for (std::size_t g = 0; g < panel_->groups.size(); ++g) add_group(pose, g);
  for (std::size_t k = 0; k < panel_->pairs.size(); ++k) add_pair(pose, k);
  if (panel_->shapley) add_shapley(pose);
}

void PanelEvaluator::add_group(PoseIndex pose, std::size_t group) {
  const std::array one{group};
  mix(one);
  solve(pose, mixed_, of_mixed_);
  absorb();
  unmix(one);
  if (panel_->shapley) keep_differences(panel_->subsets() - 1 - (std::size_t{1} << group));
  if (panel_->split[group] == 0) add_indices(pose, group);
}

void PanelEvaluator::keep_differences(std::size_t subset) {
  for (std::size_t b = 0; b < unit_.count; ++b) all_count_[b] &= of_mixed_.counts[b];
  for (std::size_t r = 0; r < panel_->responses; ++r) {
    const std::span kept = differences_.row(subset, r);
    std::ranges::fill(kept, 0.0);
    add_squared_differences(r, of_a_, of_mixed_, kept);
  }
}

void PanelEvaluator::add_shapley(PoseIndex pose) {
  const std::size_t groups = panel_->groups.size();
  const std::size_t all = panel_->subsets() - 1;
  for (std::size_t subset = 1; subset < all; ++subset) {
    std::vector<std::size_t> others;
    for (std::size_t g = 0; g < groups; ++g) {
      if ((subset >> g & 1U) == 0) others.push_back(g);
    }
    if (others.size() == 1) continue;  // add_group() already solved this mixture
    mix(others);
    solve(pose, mixed_, of_mixed_);
    absorb();
    unmix(others);
    keep_differences(subset);
  }
  for (std::size_t r = 0; r < panel_->responses; ++r) {
    std::ranges::copy(between_.row(r), differences_.row(0, r).begin());
    std::ranges::fill(differences_.row(all, r), 0.0);
    const auto add = [&](std::span<double> sum, double weight, std::size_t with, std::size_t without) {
      const std::span<const double> more = differences_.row(with, r);
      const std::span<const double> less = differences_.row(without, r);
      for (std::size_t b = 0; b < unit_.count; ++b) {
        sum[b] += all_count_[b] != 0 ? weight * (less[b] - more[b]) : 0.0;
      }
    };
    add(shapley_between_.row(r), 1.0, all, 0);
    for (std::size_t g = 0; g < groups; ++g) {
      const std::size_t own = std::size_t{1} << g;
      for (std::size_t subset = 0; subset <= all; ++subset) {
        if ((subset & own) != 0) continue;
        const auto size = static_cast<std::size_t>(std::popcount(subset));
        add(shapley_.row(r, g), shapley_weight(size, groups), subset | own, subset);
      }
    }
  }
}

void PanelEvaluator::add_indices(PoseIndex pose, std::size_t group) {
  const std::span counts = group_counts_.row(group);
  for (std::size_t b = 0; b < unit_.count; ++b) {
    counts[b] = of_a_.counts[b] & of_b_.counts[b] & of_mixed_.counts[b];
  }
  for (std::size_t q = 0; q < panel_->quantities(); ++q) {
    const std::span total = at_pose_.total.row(q, group);
    const std::span first = at_pose_.first.row(q, group);
    const std::span between = between_.row(q);
    std::ranges::fill(total, 0.0);
    std::ranges::fill(first, 0.0);
    add_squared_differences(q, of_a_, of_mixed_, total);
    add_squared_differences(q, of_b_, of_mixed_, first);
    for (std::size_t b = 0; b < unit_.count; ++b) first[b] = between[b] - first[b];
    if (q < panel_->responses) {
      IndexSums& cell = sums_.at_poses(q, group, pose.value);
      cell.total.add(total, between, counts);
      cell.first.add(first, between, counts);
    }
    const std::span sum_total = over_poses_.total.row(q, group);
    const std::span sum_first = over_poses_.first.row(q, group);
    const std::span sum_between = over_poses_.between.row(q, group);
    for (std::size_t b = 0; b < unit_.count; ++b) {
      const bool is_in = counts[b] != 0;
      sum_total[b] += is_in ? total[b] : 0.0;
      sum_first[b] += is_in ? first[b] : 0.0;
      sum_between[b] += is_in ? between[b] : 0.0;
    }
  }
}

void PanelEvaluator::add_pair(PoseIndex pose, std::size_t pair) {
  const auto [i, j] = panel_->pairs[pair];
  const std::array pair_groups{i, j};
  mix(pair_groups);
  solve(pose, mixed_, of_mixed_);
  unmix(pair_groups);
  for (std::size_t r = 0; r < panel_->responses; ++r) {
    const std::span y_b = of_b_.values.row(r);
    const std::span y_c = of_mixed_.values.row(r);
    const std::span between = between_.row(r);
    const std::span first_i = at_pose_.first.row(r, i);
    const std::span first_j = at_pose_.first.row(r, j);
    const std::span sum_first = pair_first_.row(r, pair);
    const std::span sum_between = pair_between_.row(r, pair);
    for (std::size_t b = 0; b < unit_.count; ++b) {
      const bool is_in = (group_counts_(i, b) & group_counts_(j, b) & of_mixed_.counts[b]) != 0;
      const double both = between[b] - (y_b[b] - y_c[b]) * (y_b[b] - y_c[b]);
      sum_first[b] += is_in ? both - first_i[b] - first_j[b] : 0.0;
      sum_between[b] += is_in ? between[b] : 0.0;
    }
  }
}

void PanelEvaluator::add_over_poses() {
  const Flags all(unit_.count, 1);
  for (std::size_t g = 0; g < panel_->groups.size(); ++g) {
    for (std::size_t q = 0; q < panel_->quantities() && panel_->split[g] == 0; ++q) {
      IndexSums& index = sums_.aggregated(q, g);
      index.total.add(over_poses_.total.row(q, g), over_poses_.between.row(q, g), all);
      index.first.add(over_poses_.first.row(q, g), over_poses_.between.row(q, g), all);
    }
    for (std::size_t r = 0; r < panel_->responses && panel_->shapley; ++r) {
      sums_.shapley(r, g).add(shapley_.row(r, g), shapley_between_.row(r), all);
    }
  }
  for (std::size_t r = 0; r < panel_->responses; ++r) {
    for (std::size_t k = 0; k < panel_->pairs.size(); ++k) {
      sums_.pairs(r, k).add(pair_first_.row(r, k), pair_between_.row(r, k), all);
    }
  }
}

PanelSums PanelEvaluator::operator()(const PanelUnit& unit) {
  begin(unit);
  for (std::size_t m = 0; m < panel_->poses; ++m) add_pose(PoseIndex(m));
  add_over_poses();
  return std::move(sums_);
}

std::uint64_t PanelEvaluator::try_pose(const PanelUnit& unit, PoseIndex pose) {
  begin(unit);
  add_pose(pose);
  return sums_.solves[pose.value].total();
}

}  // namespace poesy::sobol
