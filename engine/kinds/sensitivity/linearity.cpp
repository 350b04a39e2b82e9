#include "engine/kinds/sensitivity/linearity.h"

#include <algorithm>
#include <array>
#include <span>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/run/counts.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/fold.h"
#include "engine/run/some_poses.h"
#include "engine/stats/indices.h"
#include "engine/stats/rounding.h"

namespace poesy {
namespace {

/// The study's size and a tenth of it, draws and their mirror images.
constexpr std::size_t kSizes = 2;
constexpr std::size_t kSigns = 2;
constexpr std::array kScales{1.0, -1.0, kSmallerSize, -kSmallerSize};

/// Poses at which draws are solved at both sizes.
std::size_t chosen_poses(const Plan& plan) { return some_poses(plan.poses().size()); }

/// The cells of the plan at the chosen poses, slot by slot, counted from 0.
WorkUnit first_draws(const Plan& plan, std::size_t chosen_cell) {
  const std::size_t poses = chosen_poses(plan);
  return {chosen_cell / poses, some_pose(chosen_cell % poses, plan.poses().size()), SampleIndex(0),
          std::min(kLinearityDraws, plan.samples())};
}

/// The local indices of one cell, for each size those of all responses: [2 x R].
using CellIndices = std::vector<LocalIndex>;

/// Solves the first draws of a cell and their mirror images at both sizes. Owns the scratch of one thread.
class CellEvaluator {
 public:
  CellEvaluator(const Plan& plan, const Model& model)
      : plan_(&plan), responses_(model.description().responses.size()), solve_(plan, model) {}

  CellIndices operator()(std::size_t cell) {
    const WorkUnit unit = first_draws(*plan_, cell);
    const UnitOutcomes found = solve_.solve(unit, kScales);  // at once, because a model prepares for a pose
    const std::size_t draws = kSigns * unit.count;
    const double sigma = plan_->distributions()[unit.slot].standard_deviation();
    CellIndices indices;
    for (std::size_t size = 0; size < kSizes; ++size) {
      for (std::size_t r = 0; r < responses_; ++r) {
        Moments moments;
        for (std::size_t n = 0; n < draws; ++n) {
          if (counts_at_both(found, n)) moments.add(found.responses[(r * kSizes + size) * draws + n]);
        }
        indices.push_back(local_index_with_error(moments, kScales[size * kSigns] * sigma));
      }
    }
    return indices;
  }

 private:
  bool counts_at_both(const UnitOutcomes& found, std::size_t draw) const {
    const std::size_t draws = found.status.size() / kSizes;
    return counts(found.status[draw], plan_->not_converged()) &&
           counts(found.status[draws + draw], plan_->not_converged());
  }

  const Plan* plan_;
  std::size_t responses_;
  UnitEvaluator solve_;
};

/// Collects cells, pose by pose, and fills in an error's changes when its poses are there: the work of fold().
class ChangeWork {
 public:
  ChangeWork(const Plan& plan, const Model& model)
      : plan_(plan),
        model_(model),
        rounding_(response_rounding(model)),
        at_poses_(kSizes * rounding_.size()),
        changes_(rounding_.size() * plan.slots(), kNaN) {}

  std::size_t begin_round() const { return plan_.slots() * chosen_poses(plan_); }
  CellEvaluator worker() const { return {plan_, model_}; }
  static CellIndices solve(CellEvaluator& evaluate, std::size_t cell) { return evaluate(cell); }
  SolveCounts merge(std::size_t cell, const CellIndices& indices) {
    const std::size_t poses = chosen_poses(plan_);
    for (std::size_t n = 0; n < at_poses_.size(); ++n) at_poses_[n].push_back(indices[n]);
    if ((cell + 1) % poses != 0) return {};
    const std::size_t slot = cell / poses;
    for (std::size_t r = 0; r < rounding_.size(); ++r) changes_[r * plan_.slots() + slot] = change(r, slot);
    for (std::vector<LocalIndex>& poses_of_one : at_poses_) poses_of_one.clear();
    return {};
  }
  static void write(std::size_t, const CellIndices& indices, ByteWriter& to) {
    for (const LocalIndex& index : indices) to.reals(std::array{index.value, index.standard_error});
  }
  CellIndices read(std::size_t, ByteReader& from) const {
    CellIndices indices;
    for (std::size_t n = 0; n < at_poses_.size(); ++n) {
      const double value = from.real();
      indices.push_back({value, from.real()});
    }
    return indices;
  }
  static SolveCounts solved() { return {}; }
  static std::uint64_t left() { return 0; }
  Bytes state() const {
    ByteWriter to;
    to.reals(changes_);
    return to.take();
  }
  void restore(std::span<const std::byte> state) { ByteReader(state).reals(std::span(changes_)); }
  static bool next_round() { return false; }

  std::vector<double> result() && { return std::move(changes_); }

 private:
  double change(std::size_t response, std::size_t slot) const {
    const double sigma = plan_.distributions()[slot].standard_deviation();
    std::array<double, kSizes> index{};
    for (std::size_t size = 0; size < kSizes; ++size) {
      index[size] = told_from_rounding(published_index(at_poses_[size * rounding_.size() + response]),
                                       index_rounding(rounding_[response], kScales[size * kSigns] * sigma));
    }
    return index[1] / index[0] - 1.0;
  }

  const Plan& plan_;
  const Model& model_;
  std::vector<double> rounding_;                   ///< [R]
  std::vector<std::vector<LocalIndex>> at_poses_;  ///< [2 x R] of the error that is being collected
  std::vector<double> changes_;                    ///< [R x P]
};

}  // namespace

std::optional<std::vector<double>> index_changes(const Plan& plan, const Model& model, const RunOptions& options) {
  POESY_EXPECTS(plan.slots() == plan.factors().size());
  RunOptions without_state = options;
  without_state.checkpoints = nullptr;
  without_state.progress = {};
  ChangeWork work(plan, model);
  if (!fold(work, without_state)) return std::nullopt;
  return std::move(work).result();
}

double index_change_solves(const Plan& plan) {
  return static_cast<double>(plan.slots() * chosen_poses(plan) * kScales.size() * first_draws(plan, 0).count);
}

}  // namespace poesy
