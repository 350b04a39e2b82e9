#include "engine/kinds/sobol/panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/base/contract.h"

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
      poses(pose_count) {
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
      moments(panel.responses * panel.poses),
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
  return one;
}

void PanelSums::write(ByteWriter& to) const {
  for (const std::vector<IndexSums>* list : {&at_poses, &aggregated}) {
    for (const IndexSums& index : *list) poesy::write(index, to);
  }
  for (const RatioSums& pair : pairs) pair.write(to);
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
  for (Moments& one : sums.moments) one = Moments::read(from);
  from.reals(sums.least);
  for (SolveCounts& counts : sums.solves) counts = SolveCounts::read(from);
  for (std::size_t m = 0; m < panel.poses; ++m) {
    sums.failures[m] = from.number_up_to(sums.solves[m].not_converged());
    sums.failed[m] = FailedSamples::read(from, sums.failures[m], 0, end);
  }
  return sums;
}

PanelEvaluator::PanelEvaluator(const Plan& plan, const Model& model, const IndexPanel& panel, const PanelDesign& design)
    : plan_(&plan), panel_(&panel), design_(&design), evaluator_(model.evaluator(plan.solver())) {
  constexpr std::size_t kB = PanelDesign::kUnitSamples;
  const std::size_t quantities = panel.quantities();
  const std::size_t groups = panel.groups.size();
  for (Rows* rows : {&a_, &b_, &mixed_}) rows->resize(plan.factors().size() * kB);
  for (Outcomes* outcomes : {&of_a_, &of_b_, &of_mixed_}) {
    outcomes->values.resize((panel.responses + panel.details) * kB);
    outcomes->counts.resize(kB);
  }
  between_.resize(quantities * kB);
  for (GroupRows* rows : {&at_pose_, &over_poses_}) {
    for (Rows* one : {&rows->total, &rows->first, &rows->between}) one->resize(quantities * groups * kB);
  }
  pair_first_.resize(panel.responses * panel.pairs.size() * kB);
  pair_between_.resize(pair_first_.size());
  group_counts_.resize(groups * kB);
  for (std::size_t r = 0; r < panel.responses; ++r) rounding_.push_back(model.rounding(r));
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
      const std::span<double> one = row(*rows, slot);
      design_->fill(sample, slot, unit, one);
      plan_->distributions()[slot].transform(one);
    }
  }
  mixed_ = a_;
  for (Rows* rows : {&over_poses_.total, &over_poses_.first, &over_poses_.between, &pair_first_, &pair_between_}) {
    std::ranges::fill(*rows, 0.0);
  }
  sums_ = PanelSums(*panel_);
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

void PanelEvaluator::absorb() {
  const std::size_t rows = panel_->responses + panel_->details;
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
  for (std::size_t r = 0; r < panel_->responses; ++r) {
    Moments& moments = sums_.moments[r * panel_->poses + pose.value];
    for (const Outcomes* outcomes : {&of_a_, &of_b_}) {
      kept.clear();
      for (std::size_t b = 0; b < unit_.count; ++b) {
        if (outcomes->counts[b] != 0) kept.push_back(outcomes->values[r * unit_.count + b]);
      }
      moments.merge(Moments::of(kept));
      for (const double value : kept) sums_.least[r] = std::min(sums_.least[r], value);
    }
  }
  std::ranges::fill(between_, 0.0);
  for (std::size_t q = 0; q < panel_->quantities(); ++q) add_squared_differences(q, of_a_, of_b_, row(between_, q));
  for (std::size_t g = 0; g < panel_->groups.size(); ++g) add_group(pose, g);
  for (std::size_t k = 0; k < panel_->pairs.size(); ++k) add_pair(pose, k);
}

void PanelEvaluator::add_group(PoseIndex pose, std::size_t group) {
  const std::size_t groups = panel_->groups.size();
  take(group, b_);
  solve(pose, mixed_, of_mixed_);
  absorb();
  take(group, a_);
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
  take(i, b_);
  take(j, b_);
  solve(pose, mixed_, of_mixed_);
  take(i, a_);
  take(j, a_);
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
    sums_.aggregated[k].total.add(row(over_poses_.total, k), row(over_poses_.between, k), counts);
    sums_.aggregated[k].first.add(row(over_poses_.first, k), row(over_poses_.between, k), counts);
  }
  for (std::size_t k = 0; k < sums_.pairs.size(); ++k) {
    sums_.pairs[k].add(row(pair_first_, k), row(pair_between_, k), counts);
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
