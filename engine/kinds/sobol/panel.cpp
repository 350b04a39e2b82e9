#include "engine/kinds/sobol/panel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/contract.h"
#include "engine/run/response_rounding.h"

namespace poesy {
namespace {

/// How many numbers all details have.
std::size_t detail_components(const ModelDescription& model) {
  std::size_t count = 0;
  for (const Detail& detail : model.details) count += detail.components.size();
  return count;
}

/// Whether a vector has a component that is no response.
bool need_details(const std::vector<SignedVector>& vectors, std::size_t responses) {
  return std::ranges::any_of(vectors, [&](const SignedVector& vector) {
    return std::ranges::any_of(vector.components, [&](std::size_t component) { return component >= responses; });
  });
}

void write(const IndexSums& sums, ByteWriter& to) {
  sums.total.write(to);
  sums.first.write(to);
}

IndexSums read_index(ByteReader& from) {
  const RatioSums total = RatioSums::read(from);
  return {total, RatioSums::read(from)};
}

/// Blocks of correlated errors that are not all in one group.
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

/// By how much a subset of this size counts in the Shapley effect of one of n groups that is not in it:
/// s! (n - s - 1)! / n! (Shapley 1953; of variances Owen 2014, SIAM/ASA J. Uncertain. Quantif. 2, 245-251).
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
      responses(study.model().responses.size()),
      details(need_details(vectors, responses) ? detail_components(study.model()) : 0),
      poses(pose_count),
      split(split_groups(groups, study)),
      shapley(asked_of<SobolOptions>(study.analysis).shapley) {
  for (std::size_t r = 0; r < responses; ++r) components_.push_back({r});
  for (const SignedVector& vector : vectors) components_.push_back(vector.components);
  if (!asked_of<SobolOptions>(study.analysis).second_order) return;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (std::size_t j = i + 1; j < groups.size(); ++j) pairs.emplace_back(i, j);
  }
}

std::span<const std::size_t> IndexPanel::components(std::size_t quantity) const { return components_[quantity]; }

PanelSums::PanelSums(const IndexPanel& panel)
    : at_poses(panel.responses * panel.groups.size() * panel.poses),
      aggregated(panel.quantities() * panel.groups.size()),
      pairs(panel.responses * panel.pairs.size()),
      shapley(panel.shapley ? panel.responses * panel.groups.size() : 0),
      moments(panel.rows() * panel.poses),
      least(panel.responses, std::numeric_limits<double>::infinity()),
      solves(panel.poses),
      failed(panel.poses),
      failures(panel.poses) {}

void PanelSums::merge(const PanelSums& later) {
  const auto merge_indices = [](std::vector<IndexSums>& list, const std::vector<IndexSums>& other) {
    for (std::size_t k = 0; k < list.size(); ++k) {
      list[k].total.merge(other[k].total);
      list[k].first.merge(other[k].first);
    }
  };
  merge_indices(at_poses, later.at_poses);
  merge_indices(aggregated, later.aggregated);
  for (std::size_t k = 0; k < pairs.size(); ++k) pairs[k].merge(later.pairs[k]);
  for (std::size_t k = 0; k < shapley.size(); ++k) shapley[k].merge(later.shapley[k]);
  for (std::size_t k = 0; k < moments.size(); ++k) moments[k].merge(later.moments[k]);
  for (std::size_t r = 0; r < least.size(); ++r) least[r] = std::min(least[r], later.least[r]);
  for (std::size_t m = 0; m < solves.size(); ++m) {
    solves[m].merge(later.solves[m]);
    failed[m].merge(later.failed[m]);
    failures[m] += later.failures[m];
  }
}

PanelSums PanelSums::as_one() const {
  PanelSums one = *this;
  for (std::vector<IndexSums>* list : {&one.at_poses, &one.aggregated}) {
    for (IndexSums& index : *list) index = {mean_of(index.total), mean_of(index.first)};
  }
  for (RatioSums& pair : one.pairs) pair = mean_of(pair);
  for (RatioSums& effect : one.shapley) effect = mean_of(effect);
  return one;
}

void PanelSums::write(ByteWriter& to) const {
  for (const std::vector<IndexSums>* list : {&at_poses, &aggregated}) {
    for (const IndexSums& index : *list) poesy::write(index, to);
  }
  for (const RatioSums& pair : pairs) pair.write(to);
  for (const RatioSums& effect : shapley) effect.write(to);
  for (const Moments& one : moments) one.write(to);
  to.reals(least);
  for (const SolveCounts& counts : solves) counts.write(to);
  for (std::size_t m = 0; m < failed.size(); ++m) {
    to.number(failures[m]);
    failed[m].write(to);
  }
}

PanelSums PanelSums::read(ByteReader& from, const IndexPanel& panel, std::uint64_t end) {
  PanelSums sums(panel);
  for (std::vector<IndexSums>* list : {&sums.at_poses, &sums.aggregated}) {
    for (IndexSums& index : *list) index = read_index(from);
  }
  for (RatioSums& pair : sums.pairs) pair = RatioSums::read(from);
  for (RatioSums& effect : sums.shapley) effect = RatioSums::read(from);
  for (Moments& one : sums.moments) one = Moments::read(from);
  from.reals(sums.least);
  for (SolveCounts& counts : sums.solves) counts = SolveCounts::read(from);
  for (std::size_t m = 0; m < panel.poses; ++m) {
    sums.failures[m] = from.number_up_to(sums.solves[m].not_converged());
    sums.failed[m] = FailedSamples::read(from, sums.failures[m], 0, end);
  }
  return sums;
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
  scores.resize(block.slots.size() * PanelDesign::kUnitSamples);
  normals.resize(scores.size());
}

PanelEvaluator::PanelEvaluator(const Plan& plan, const Model& model, const IndexPanel& panel, const PanelDesign& design)
    : plan_(&plan),
      panel_(&panel),
      design_(&design),
      evaluator_(model.evaluator(plan.solver())),
      rounding_(response_rounding(model)) {
  constexpr std::size_t kB = PanelDesign::kUnitSamples;
  const std::size_t quantities = panel.quantities();
  const std::size_t groups = panel.groups.size();
  for (Rows* rows : {&a_, &b_, &mixed_}) rows->resize(plan.factors().size() * kB);
  for (Outcomes* outcomes : {&of_a_, &of_b_, &of_mixed_}) {
    outcomes->values.resize(panel.rows() * kB);
    outcomes->counts.resize(kB);
  }
  between_.resize(quantities * kB);
  for (GroupRows* rows : {&at_pose_, &over_poses_}) {
    for (Rows* one : {&rows->total, &rows->first, &rows->between}) one->resize(quantities * groups * kB);
  }
  pair_first_.resize(panel.responses * panel.pairs.size() * kB);
  pair_between_.resize(pair_first_.size());
  if (panel.shapley) {
    for (SplitBlock& block : split_blocks(plan, panel.groups)) split_.emplace_back(std::move(block), panel.subsets());
    differences_.resize(panel.subsets() * panel.responses * kB);
    all_count_.resize(kB);
    shapley_.resize(panel.responses * groups * kB);
    shapley_between_.resize(panel.responses * kB);
  }
  group_counts_.resize(groups * kB);
  status_.resize(kB);
  iterations_.resize(kB);
}

std::span<double> PanelEvaluator::row(Rows& rows, std::size_t number) const {
  return std::span(rows).subspan(number * unit_.count, unit_.count);
}

void PanelEvaluator::begin(const PanelUnit& unit) {
  unit_ = unit;
  for (const auto& [sample, rows] : {std::pair(PanelSample::A, &a_), std::pair(PanelSample::B, &b_)}) {
    for (std::size_t slot = 0; slot < plan_->factors().size(); ++slot) {
      design_->fill(sample, slot, unit, row(*rows, slot));
    }
    keep_scores(sample, *rows);
    plan_->transform(std::span(*rows).first(plan_->factors().size() * unit.count), unit.count);
  }
  mixed_ = a_;
  for (Rows* rows : {&over_poses_.total, &over_poses_.first, &over_poses_.between, &pair_first_, &pair_between_,
                     &shapley_, &shapley_between_}) {
    std::ranges::fill(*rows, 0.0);
  }
  sums_ = PanelSums(*panel_);
}

void PanelEvaluator::keep_scores(PanelSample sample, const Rows& uniforms) {
  for (SplitDraws& draws : split_) {
    Rows& kept = sample == PanelSample::A ? draws.scores : draws.normals;
    std::vector<std::span<double>> rows;
    for (std::size_t k = 0; k < draws.block.slots.size(); ++k) {
      rows.push_back(row(kept, k));
      std::ranges::copy(std::span(uniforms).subspan(draws.block.slots[k] * unit_.count, unit_.count),
                        rows.back().begin());
      normal_quantiles(1.0, rows.back());
    }
    if (sample == PanelSample::A) draws.block.copula->correlate(rows);
  }
}

void PanelEvaluator::solve(PoseIndex pose, const Rows& errors, Outcomes& outcomes) {
  const std::size_t count = unit_.count;
  const std::span values = std::span(outcomes.values);
  const std::span status = std::span(status_).first(count);
  const std::span iterations = std::span(iterations_).first(count);
  evaluator_->evaluate({plan_->poses()[pose], plan_->background(), plan_->factors(),
                        std::span(errors).first(plan_->factors().size() * count), count},
                       {values.first(panel_->responses * count), status, iterations,
                        values.subspan(panel_->responses * count, panel_->details * count)});
  SolveCounts& solves = sums_.solves[pose.value];
  for (std::size_t b = 0; b < count; ++b) {
    solves.add(status[b], iterations[b]);
    outcomes.counts[b] = counts(status[b], plan_->not_converged()) ? 1 : 0;
  }
}

void PanelEvaluator::take(std::size_t group, const Rows& from) {
  for (const std::size_t slot : panel_->groups[group].members) {
    std::ranges::copy(std::span(from).subspan(slot * unit_.count, unit_.count), row(mixed_, slot).begin());
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
    for (const std::size_t k : mixture.shared) shared.emplace_back(row(draws.scores, k));
    for (const std::size_t k : mixture.drawn) {
      normals.emplace_back(row(draws.normals, k));
      drawn.push_back(row(mixed_, draws.block.slots[k]));
    }
    mixture.scores->fill(shared, normals, drawn);
    for (const std::size_t k : mixture.drawn) {
      const std::size_t slot = draws.block.slots[k];
      plan_->distributions()[slot].transform_scores(row(mixed_, slot));
    }
  }
}

void PanelEvaluator::absorb() {
  const std::size_t rows = panel_->rows();
  for (std::size_t b = 0; b < unit_.count; ++b) {
    bool same = true;
    for (std::size_t r = 0; r < panel_->responses; ++r) {
      const std::size_t at = r * unit_.count + b;
      same = same && std::abs(of_a_.values[at] - of_mixed_.values[at]) <= rounding_[r];
    }
    for (std::size_t k = 0; same && k < rows; ++k) {
      of_mixed_.values[k * unit_.count + b] = of_a_.values[k * unit_.count + b];
    }
  }
}

void PanelEvaluator::add_squared_differences(std::size_t quantity, const Outcomes& one, const Outcomes& other,
                                             std::span<double> sum) const {
  for (const std::size_t component : panel_->components(quantity)) {
    const double* const x = one.values.data() + component * unit_.count;
    const double* const y = other.values.data() + component * unit_.count;
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
    Moments& moments = sums_.moments[row * panel_->poses + pose.value];
    for (const Outcomes* outcomes : {&of_a_, &of_b_}) {
      kept.clear();
      for (std::size_t b = 0; b < unit_.count; ++b) {
        if (outcomes->counts[b] != 0) kept.push_back(outcomes->values[row * unit_.count + b]);
      }
      moments.merge(Moments::of(kept));
      if (row >= panel_->responses) continue;
      for (const double value : kept) sums_.least[row] = std::min(sums_.least[row], value);
    }
  }
  std::ranges::fill(between_, 0.0);
  for (std::size_t q = 0; q < panel_->quantities(); ++q) add_squared_differences(q, of_a_, of_b_, row(between_, q));
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
    const std::span kept = row(differences_, subset * panel_->responses + r);
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
    if (others.size() == 1) continue;  // has been solved
    mix(others);
    solve(pose, mixed_, of_mixed_);
    absorb();
    unmix(others);
    keep_differences(subset);
  }
  const std::size_t responses = panel_->responses;
  for (std::size_t r = 0; r < responses; ++r) {
    std::ranges::copy(row(between_, r), row(differences_, r).begin());
    std::ranges::fill(row(differences_, all * responses + r), 0.0);
    const auto add = [&](std::span<double> sum, double weight, std::size_t with, std::size_t without) {
      const std::span<const double> more = row(differences_, with * responses + r);
      const std::span<const double> less = row(differences_, without * responses + r);
      for (std::size_t b = 0; b < unit_.count; ++b) {
        sum[b] += all_count_[b] != 0 ? weight * (less[b] - more[b]) : 0.0;
      }
    };
    add(row(shapley_between_, r), 1.0, all, 0);
    for (std::size_t g = 0; g < groups; ++g) {
      const std::size_t own = std::size_t{1} << g;
      for (std::size_t subset = 0; subset <= all; ++subset) {
        if ((subset & own) != 0) continue;
        const auto size = static_cast<std::size_t>(std::popcount(subset));
        add(row(shapley_, r * groups + g), shapley_weight(size, groups), subset | own, subset);
      }
    }
  }
}

void PanelEvaluator::add_indices(PoseIndex pose, std::size_t group) {
  const std::size_t groups = panel_->groups.size();
  const std::span counts = std::span(group_counts_).subspan(group * unit_.count, unit_.count);
  for (std::size_t b = 0; b < unit_.count; ++b) {
    counts[b] = of_a_.counts[b] & of_b_.counts[b] & of_mixed_.counts[b];
  }
  for (std::size_t q = 0; q < panel_->quantities(); ++q) {
    const std::span total = row(at_pose_.total, q * groups + group);
    const std::span first = row(at_pose_.first, q * groups + group);
    const std::span between = row(between_, q);
    std::ranges::fill(total, 0.0);
    std::ranges::fill(first, 0.0);
    add_squared_differences(q, of_a_, of_mixed_, total);
    add_squared_differences(q, of_b_, of_mixed_, first);
    for (std::size_t b = 0; b < unit_.count; ++b) first[b] = between[b] - first[b];
    if (q < panel_->responses) {
      IndexSums& cell = sums_.at_poses[(q * groups + group) * panel_->poses + pose.value];
      cell.total.add(total, between, counts);
      cell.first.add(first, between, counts);
    }
    const std::span sum_total = row(over_poses_.total, q * groups + group);
    const std::span sum_first = row(over_poses_.first, q * groups + group);
    const std::span sum_between = row(over_poses_.between, q * groups + group);
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
  const std::size_t groups = panel_->groups.size();
  const std::array pair_groups{i, j};
  mix(pair_groups);
  solve(pose, mixed_, of_mixed_);
  unmix(pair_groups);
  for (std::size_t r = 0; r < panel_->responses; ++r) {
    const double* const y_b = of_b_.values.data() + r * unit_.count;
    const double* const y_c = of_mixed_.values.data() + r * unit_.count;
    const std::span between = row(between_, r);
    const std::span first_i = row(at_pose_.first, r * groups + i);
    const std::span first_j = row(at_pose_.first, r * groups + j);
    const std::span sum_first = row(pair_first_, r * panel_->pairs.size() + pair);
    const std::span sum_between = row(pair_between_, r * panel_->pairs.size() + pair);
    for (std::size_t b = 0; b < unit_.count; ++b) {
      const bool is_in =
          (group_counts_[i * unit_.count + b] & group_counts_[j * unit_.count + b] & of_mixed_.counts[b]) != 0;
      const double both = between[b] - (y_b[b] - y_c[b]) * (y_b[b] - y_c[b]);
      sum_first[b] += is_in ? both - first_i[b] - first_j[b] : 0.0;
      sum_between[b] += is_in ? between[b] : 0.0;
    }
  }
}

void PanelEvaluator::add_over_poses() {
  const std::array<std::uint8_t, PanelDesign::kUnitSamples> all = [] {
    std::array<std::uint8_t, PanelDesign::kUnitSamples> ones{};
    ones.fill(1);
    return ones;
  }();
  const std::span counts = std::span(all).first(unit_.count);
  for (std::size_t k = 0; k < sums_.aggregated.size(); ++k) {
    if (panel_->split[k % panel_->groups.size()] != 0) continue;
    sums_.aggregated[k].total.add(row(over_poses_.total, k), row(over_poses_.between, k), counts);
    sums_.aggregated[k].first.add(row(over_poses_.first, k), row(over_poses_.between, k), counts);
  }
  for (std::size_t k = 0; k < sums_.pairs.size(); ++k) {
    sums_.pairs[k].add(row(pair_first_, k), row(pair_between_, k), counts);
  }
  for (std::size_t k = 0; k < sums_.shapley.size(); ++k) {
    sums_.shapley[k].add(row(shapley_, k), row(shapley_between_, k / panel_->groups.size()), counts);
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

}  // namespace poesy
