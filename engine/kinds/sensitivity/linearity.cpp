#include "engine/kinds/sensitivity/linearity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/display.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/response_rounding.h"
#include "engine/run/result.h"
#include "engine/run/unit_fold.h"
#include "engine/stats/indices.h"
#include "engine/stats/sums.h"

namespace poesy::sensitivity {
namespace {

/// The number of sizes at which each draw is solved: the size in the study, and a tenth of it.
constexpr std::size_t kSizes = 2;
constexpr std::size_t kSigns = 2;
constexpr std::array kScales{1.0, -1.0, kSmallerSize, -kSmallerSize};

/// The number of poses at which linearity is checked.
std::size_t chosen_poses(const Plan& plan) { return some_poses(plan.poses().size()); }

/// The draws of one cell (one error at one of the poses at which linearity is checked) that are solved again at another
/// size. chosen_cell: number of this cell; all poses of one error come before those of the next.
WorkUnit first_draws(const Plan& plan, std::size_t chosen_cell) {
  const std::size_t poses = chosen_poses(plan);
  return {chosen_cell / poses, some_pose(chosen_cell % poses, plan.poses().size()), SampleIndex(0),
          std::min(kLinearityDraws, plan.samples())};
}

struct ErrorSize {
  static constexpr std::string_view kName = "size";
};

/// [sizes x responses] The local indices of one cell, which is one error at one pose.
using CellIndices = Array<LocalIndex, ErrorSize, axis::Response>;

/// Solves the first draws of a cell and their mirror images at both sizes. Owns the scratch memory of one thread.
class CellEvaluator {
 public:
  CellEvaluator(const Plan& plan, const Model& model)
      : plan_(&plan), responses_(model.description().responses.size()), solve_(plan, model) {}

  CellIndices operator()(std::size_t cell) {
    const WorkUnit unit = first_draws(*plan_, cell);
    // Both sizes are solved in one call, so that the model prepares for the pose only once.
    const UnitOutcomes found = solve_.solve(unit, kScales);
    const std::size_t draws = kSigns * unit.count;
    const ArrayView<const double, axis::Response, ErrorSize, axis::Sample> responses(found.responses,
                                                                                     {responses_, kSizes, draws});
    const ArrayView<const SolveStatus, ErrorSize, axis::Sample> status(found.status, {kSizes, draws});
    const auto counts_at = [&](std::size_t size, std::size_t n) {
      return counts(status(size, n), plan_->not_converged());
    };
    const double sigma = plan_->distributions()[unit.slot].standard_deviation();
    CellIndices indices({kSizes, responses_});
    for (std::size_t size = 0; size < kSizes; ++size) {
      for (std::size_t r = 0; r < responses_; ++r) {
        Moments moments;
        for (std::size_t n = 0; n < draws; ++n) {
          if (counts_at(0, n) && counts_at(1, n)) moments.add(responses(r, size, n));
        }
        indices(size, r) = local_index_with_error(moments, kScales[size * kSigns] * sigma);
      }
    }
    return indices;
  }

 private:
  const Plan* plan_;
  std::size_t responses_;
  UnitEvaluator solve_;
};

/// Collects the local indices of one error after the other. When those at all poses of an error are collected, computes
/// how its global indices change with size.
struct ChangeSums {
  const Plan* plan;
  std::vector<double> rounding;  ///< [responses] rounding of each response
  /// The local indices of the error that is being collected, at the poses collected so far.
  Array<std::vector<LocalIndex>, ErrorSize, axis::Response> at_poses;
  Result::Indices changes;

  ChangeSums(const Plan& of, std::vector<double> of_responses)
      : plan(&of),
        rounding(std::move(of_responses)),
        at_poses({kSizes, rounding.size()}),
        changes({rounding.size(), of.slots()}, kNaN) {}

  void add(std::size_t cell, const CellIndices& indices) {
    const std::size_t poses = chosen_poses(*plan);
    for_each_pair(at_poses, indices, [](auto& list, const LocalIndex& index) { list.push_back(index); });
    if ((cell + 1) % poses != 0) return;
    const std::size_t slot = cell / poses;
    for (std::size_t r = 0; r < rounding.size(); ++r) changes(r, slot) = change(r, slot);
    for (std::vector<LocalIndex>& poses_of_one : at_poses) poses_of_one.clear();
  }
  /// Reads or writes all changes. Called only after the last cell, because this job has no checkpoints.
  void state(Archive& archive, const NumberRange&) { archive.reals(changes.all()); }

 private:
  double change(std::size_t response, std::size_t slot) const {
    const double sigma = plan->distributions()[slot].standard_deviation();
    std::array<double, kSizes> index{};
    for (std::size_t size = 0; size < kSizes; ++size) {
      index[size] = told_from_rounding(published_index(at_poses(size, response)),
                                       index_rounding(rounding[response], kScales[size * kSigns] * sigma));
    }
    return index[1] / index[0] - 1.0;
  }
};

/// The job of a UnitFold (run/unit_fold.h); a unit is a cell, one error at one pose. Its solves are not counted in the
/// result.
struct ChangeJob {
  const Plan& plan;
  const Model& model;

  static constexpr std::string_view kName = "index changes";
  std::vector<std::uint64_t> sizes() const { return {}; }
  NumberRange units(const Shard& shard) const { return shard.of(plan.slots() * chosen_poses(plan)); }
  static std::uint64_t expected(std::size_t) { return 0; }
  CellEvaluator worker() const { return {plan, model}; }
  CellIndices unit(std::size_t) const { return CellIndices({kSizes, model.description().responses.size()}); }
  static SolveCounts solves(std::size_t, const CellIndices&) { return {}; }
  ChangeSums sums() const { return {plan, response_rounding(model)}; }
};

/// The largest number of errors that one sentence names.
constexpr std::size_t kMostNames = 10;

std::span<const double> changes_of(const StoredResult& result, std::size_t response) {
  return sensitivity_of(result).index_change.row(response);
}

/// A change as text: "-99.1 %".
std::string change_text(double change) { return fmt::format("{:+.1f} %", 100.0 * change); }

/// The size at which to study an error, as a multiple of the size in the study. If the index is proportional to a power
/// of the size, a study at the returned size proposes about that size as the tolerance. ratio: tolerance divided by the
/// size in the study; change: relative change of the index at a tenth of the size.
double corrected_ratio(double ratio, double change) {
  constexpr double kFallsTooFast = -0.9;
  const double power = -std::log10(1.0 + change);
  return std::isfinite(power) && power > kFallsTooFast ? std::pow(ratio, 1.0 / (1.0 + power)) : ratio;
}

/// The size (SI) at which to study an error, computed from the first proposed tolerance of the error that differs much
/// from the studied size (kSameSize). None if no tolerance differs so much.
std::optional<double> size_to_study(const ResponseTolerances& tolerances, std::size_t factor, double studied,
                                    double change) {
  for (const std::span<const double> proposed : proposed_tolerances(tolerances)) {
    const double ratio = proposed[factor] / studied;
    if (std::isfinite(ratio) && (ratio > kSameSize || ratio < 1.0 / kSameSize)) {
      return studied * corrected_ratio(ratio, change);
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Result::Indices> index_changes(const Plan& plan, const Model& model, const RunOptions& options) {
  POESY_EXPECTS(plan.slots() == plan.factors().size());
  RunOptions without_state = options;
  without_state.checkpoints = nullptr;
  without_state.progress = {};
  auto sums = fold_units(ChangeJob{plan, model}, without_state);
  if (!sums) return std::nullopt;
  return std::move(sums->changes);
}

double index_change_solves(const Plan& plan) {
  return static_cast<double>(plan.slots() * chosen_poses(plan) * kScales.size() * first_draws(plan, 0).count);
}

Cell change_cell(double change) {
  if (std::isnan(change)) return text_cell("");
  // Removes the sign of a change that is shown as zero.
  const double percent = std::abs(change) < 5e-4 ? 0.0 : 100.0 * change;
  return {fmt::format("{:.1f}", percent), std::isfinite(change) ? std::optional(100.0 * change) : std::nullopt};
}

std::vector<std::size_t> changing_errors(const StoredResult& result, std::size_t response) {
  const std::span<const double> changes = changes_of(result, response);
  std::vector<std::size_t> list;
  for (std::size_t p = 0; p < changes.size(); ++p) {
    if (has_effect(result, response, p) && changes_with_size(changes[p])) list.push_back(p);
  }
  std::ranges::stable_sort(list, std::ranges::greater(), [&](std::size_t p) { return std::abs(changes[p]); });
  return list;
}

std::string index_change_text(const StoredResult& result, std::size_t response, std::span<const std::size_t> unnamed) {
  const std::span<const double> changes = changes_of(result, response);
  const std::vector<std::size_t> changing = changing_errors(result, response);
  std::vector<std::string> list;
  for (const std::size_t p : changing) {
    if (std::ranges::find(unnamed, p) != unnamed.end()) continue;
    list.push_back(fmt::format("{} ({})", result.factors[p].name, change_text(changes[p])));
  }
  const std::string names = some_names(list, kMostNames);
  if (is_first_order(result)) {
    return std::string(kSizesNotTested) +
           (list.empty() ? "" : "; already to first order they change at a tenth of the size for " + names);
  }
  std::size_t effects = 0;
  std::size_t unknown = 0;
  for (std::size_t p = 0; p < changes.size(); ++p) {
    if (!has_effect(result, response, p)) continue;
    ++effects;
    if (std::isnan(changes[p])) ++unknown;
  }
  std::string text =
      fmt::format("the index on {} holds at a tenth of the size, within {:.3g} %: {} of {}",
                  result.responses[response].name, 100.0 * kIndexHolds, effects - unknown - changing.size(),
                  counted(effects, "error with an effect", "errors with an effect"));
  if (unknown > 0) text += fmt::format("; not known for {}", unknown);
  return list.empty() ? text : text + "; not for " + names;
}

std::vector<std::size_t> negligible_errors(const StoredResult& result, std::size_t response,
                                           const MeanSquare& mean_square, double added) {
  const double most = kNegligible / static_cast<double>(result.factors.size()) * added;
  std::vector<std::size_t> list = changing_errors(result, response);
  std::erase_if(list, [&](std::size_t p) {
    return !(mean_square.effects[p] * result.factor_sigma[p] * result.factor_sigma[p] <= most);
  });
  return list;
}

std::string negligible_text(const StoredResult& result, const ResponseTolerances& tolerances) {
  if (tolerances.negligible.empty()) return {};
  std::vector<std::string> list;
  for (const std::size_t p : tolerances.negligible) {
    const NamedUnit& factor = result.factors[p];
    list.push_back(
        fmt::format("{} ({:.4g} {})", factor.name, result.factor_sigma[p] / display(factor).si, unit_text(factor)));
  }
  return fmt::format(
      "{} the size studied as tolerance: the index on {} changes with size, but at that size all together add at most "
      "{:.3g} % to its mean square: {}",
      counted(list.size(), "negligible error has", "negligible errors have"),
      result.responses[tolerances.response].name, 100.0 * kNegligible, some_names(list, kMostNames));
}

std::string wrong_sizes_text(const StoredResult& result, const ResponseTolerances& tolerances) {
  const std::span<const double> changes = changes_of(result, tolerances.response);
  std::vector<std::string> list;
  for (const std::size_t p : changing_errors(result, tolerances.response)) {
    const auto size = size_to_study(tolerances, p, result.factor_sigma[p], changes[p]);
    if (!size) continue;
    const NamedUnit& factor = result.factors[p];
    list.push_back(fmt::format("{} ({}; study it at {:.3g} {})", factor.name, change_text(changes[p]),
                               *size / display(factor).si, unit_text(factor)));
  }
  if (list.empty()) return {};
  return fmt::format(
      "{} on {} that changes with size, by so much at a tenth of it, and a tolerance of another size than was studied: "
      "{}",
      counted(list.size(), "error has an index", "errors have an index"), result.responses[tolerances.response].name,
      some_names(list, kMostNames));
}

}  // namespace poesy::sensitivity
