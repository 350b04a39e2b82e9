#include "engine/run/linearity.h"

#include <algorithm>
#include <array>
#include <span>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/run/counts.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/run_in_order.h"
#include "engine/run/sensitivity.h"
#include "engine/stats/rounding.h"
#include "engine/stats/sensitivity_index.h"

namespace poesy {
namespace {

constexpr std::array kSizes{1.0, kSmallerSize};
constexpr std::array kSigns{1.0, -1.0};

/// The local indices of one cell, for each of kSizes those of all responses: [2 x R].
using CellIndices = std::vector<LocalIndex>;

/// Solves the first draws of a cell and their mirror images at both sizes. Owns the scratch of one thread.
class CellEvaluator {
 public:
  CellEvaluator(const Plan& plan, const Model& model)
      : plan_(&plan), responses_(model.description().responses.size()), solve_(plan, model) {}

  CellIndices operator()(std::size_t cell) {
    const std::size_t poses = plan_->poses().size();
    const WorkUnit unit{cell / poses, PoseIndex(cell % poses), SampleIndex(0),
                        std::min(kLinearityDraws, plan_->samples())};
    solve_all(unit);
    const double sigma = plan_->distributions()[unit.slot].standard_deviation();
    CellIndices indices;
    for (std::size_t size = 0; size < kSizes.size(); ++size) {
      for (std::size_t r = 0; r < responses_; ++r) {
        indices.push_back(local_index_with_error(moments(size, r), kSizes[size] * sigma));
      }
    }
    return indices;
  }

 private:
  /// What draws of one sign came to.
  struct Outcomes {
    std::array<std::vector<double>, kSizes.size()> responses;  ///< [R x B] at each size
    std::vector<bool> count;                                   ///< [B] whether a draw counts at both
  };

  void solve_all(const WorkUnit& unit) {
    for (std::size_t sign = 0; sign < kSigns.size(); ++sign) {
      Outcomes& found = outcomes_[sign];
      found.count.assign(unit.count, true);
      for (std::size_t size = 0; size < kSizes.size(); ++size) {
        const UnitOutcomes solved = solve_.solve(unit, kSigns[sign] * kSizes[size]);
        found.responses[size].assign(solved.responses.begin(), solved.responses.end());
        for (std::size_t b = 0; b < unit.count; ++b) {
          found.count[b] = found.count[b] && counts(solved.status[b], plan_->not_converged());
        }
      }
    }
  }

  Moments moments(std::size_t size, std::size_t response) const {
    Moments over_draws;
    for (const Outcomes& found : outcomes_) {
      const std::size_t draws = found.count.size();
      for (std::size_t b = 0; b < draws; ++b) {
        if (found.count[b]) over_draws.add(found.responses[size][response * draws + b]);
      }
    }
    return over_draws;
  }

  const Plan* plan_;
  std::size_t responses_;
  UnitEvaluator solve_;
  std::array<Outcomes, kSigns.size()> outcomes_;
};

/// Collects cells, pose by pose, and fills in an error's changes when its poses are there.
class ChangeCollector {
 public:
  ChangeCollector(const Plan& plan, const Model& model)
      : plan_(&plan),
        rounding_(response_rounding(model)),
        at_poses_(kSizes.size() * rounding_.size()),
        changes_(rounding_.size() * plan.slots(), kNaN) {}

  void add(std::size_t cell, const CellIndices& indices) {
    const std::size_t poses = plan_->poses().size();
    for (std::size_t n = 0; n < at_poses_.size(); ++n) at_poses_[n].push_back(indices[n]);
    if ((cell + 1) % poses != 0) return;
    for (std::size_t r = 0; r < rounding_.size(); ++r)
      changes_[r * plan_->slots() + cell / poses] = change(r, cell / poses);
    for (std::vector<LocalIndex>& poses_of_one : at_poses_) poses_of_one.clear();
  }

  std::vector<double> take() && { return std::move(changes_); }

 private:
  double change(std::size_t response, std::size_t slot) const {
    const double sigma = plan_->distributions()[slot].standard_deviation();
    std::array<double, kSizes.size()> index{};
    for (std::size_t size = 0; size < kSizes.size(); ++size) {
      index[size] = told_from_rounding(published_index(at_poses_[size * rounding_.size() + response]),
                                       index_rounding(rounding_[response], kSizes[size] * sigma));
    }
    return index[1] / index[0] - 1.0;
  }

  const Plan* plan_;
  std::vector<double> rounding_;                   ///< [R]
  std::vector<std::vector<LocalIndex>> at_poses_;  ///< [2 x R] of the error that is being collected
  std::vector<double> changes_;                    ///< [R x P]
};

void pack(const CellIndices& indices, ByteWriter& to) {
  for (const LocalIndex& index : indices) to.reals(std::array{index.value, index.standard_error});
}

CellIndices unpack(ByteReader& from, std::size_t count) {
  CellIndices indices;
  for (std::size_t n = 0; n < count; ++n) {
    const double value = from.real();
    indices.push_back({value, from.real()});
  }
  return indices;
}

}  // namespace

std::optional<std::vector<double>> index_changes(const Plan& plan, const Model& model, const RunOptions& options) {
  POESY_EXPECTS(plan.slots() == plan.factors().size());
  const std::size_t responses = model.description().responses.size();
  ChangeCollector collect(plan, model);
  Stage stage(nullptr, options.team);
  stage.begin([](std::span<const std::byte>) {});
  const bool complete = run_in_order(
      plan.cells(), options, [&] { return CellEvaluator(plan, model); },
      [](CellEvaluator& evaluate, std::size_t cell) { return evaluate(cell); },
      [&](std::size_t cell, const CellIndices& found) { collect.add(cell, found); },
      [](std::size_t, const CellIndices& found, ByteWriter& to) { pack(found, to); },
      [&](std::size_t, ByteReader& from) { return unpack(from, kSizes.size() * responses); });
  std::vector<double> changes = std::move(collect).take();
  stage.end(
      complete, [] { return SolveCounts(); },
      [&] {
        ByteWriter to;
        to.reals(changes);
        return to.take();
      },
      [&](std::span<const std::byte> end) { ByteReader(end).reals(std::span(changes)); });
  if (!complete) return std::nullopt;
  return changes;
}

}  // namespace poesy
