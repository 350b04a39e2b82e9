#include "engine/run/series_model.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/array.h"
#include "engine/model/forwarding_model.h"
#include "engine/run/response_series.h"

namespace poesy {
namespace {

/// Everything that determines the series of a block of samples: its varied error and range, its pose and previous pose,
/// and its constant errors.
struct SeriesCell {
  FactorIndex factor;
  double range;
  std::vector<double> pose;
  std::vector<double> previous;
  std::vector<double> errors;

  explicit SeriesCell(const SampleBlock& samples)
      : factor(samples.varied.front()),
        range(samples.range),
        pose(samples.pose.begin(), samples.pose.end()),
        previous(samples.previous.begin(), samples.previous.end()),
        errors(samples.errors.begin(), samples.errors.end()) {}

  bool is_of(const SampleBlock& samples) const {
    return factor == samples.varied.front() && range == samples.range && std::ranges::equal(pose, samples.pose) &&
           std::ranges::equal(previous, samples.previous) && std::ranges::equal(errors, samples.errors);
  }
};

class SeriesEvaluator final : public Evaluator {
 public:
  SeriesEvaluator(const Model& model, std::unique_ptr<Evaluator> solver)
      : solver_(std::move(solver)), responses_(model.description().responses.size()), series_(model) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    const bool one_varies = samples.varied.size() == 1 && samples.range > 0.0 && outcomes.details.empty();
    if (!one_varies || !has_series(samples)) {
      solver_->evaluate(samples, outcomes);
      return;
    }
    left_.clear();
    series_.evaluate(samples.values, outcomes.responses, left_);
    std::ranges::fill(outcomes.status, SolveStatus::by_series);
    std::ranges::fill(outcomes.iterations, 0u);
    if (!left_.empty()) solve_left(samples, outcomes);
  }

 private:
  /// Outcomes of solves at a few values of the varied error, such as the nodes of the series.
  struct Solved {
    std::vector<double> responses;
    std::vector<SolveStatus> status;
    std::vector<std::uint32_t> iterations;
  };

  /// Solves the block with these values of the varied error instead of the block's values. The range is not passed on:
  /// the solver would prepare for it, which is too slow for so few samples.
  Solved solve(SampleBlock samples, std::span<const double> errors) {
    samples.values = errors;
    samples.count = errors.size();
    samples.range = 0.0;
    Solved made{std::vector<double>(responses_ * errors.size()), std::vector<SolveStatus>(errors.size()),
                std::vector<std::uint32_t>(errors.size())};
    solver_->evaluate(samples, {made.responses, made.status, made.iterations, {}});
    return made;
  }

  bool has_series(const SampleBlock& samples) {
    if (cell_ && cell_->is_of(samples)) return is_certified_;
    cell_.emplace(samples);
    const Solved found = solve(samples, ResponseSeries::errors(samples.range));
    const auto converged = [](SolveStatus status) { return status == SolveStatus::converged; };
    is_certified_ = std::ranges::all_of(found.status, converged) && series_.form(samples.range, found.responses);
    return is_certified_;
  }

  void solve_left(const SampleBlock& samples, const OutcomeBlock& outcomes) {
    std::vector<double> errors;
    for (const std::size_t b : left_) errors.push_back(samples.values[b]);
    const Solved found = solve(samples, errors);
    const ArrayView<const double, axis::Response, axis::Sample> solved(found.responses, {responses_, left_.size()});
    const ArrayView<double, axis::Response, axis::Sample> all(outcomes.responses, {responses_, samples.count});
    for (std::size_t k = 0; k < left_.size(); ++k) {
      outcomes.status[left_[k]] = found.status[k];
      outcomes.iterations[left_[k]] = found.iterations[k];
      for (std::size_t r = 0; r < responses_; ++r) all(r, left_[k]) = solved(r, k);
    }
  }

  std::unique_ptr<Evaluator> solver_;
  std::size_t responses_;
  ResponseSeries series_;           ///< series for `cell_`; usable only if is_certified_
  std::optional<SeriesCell> cell_;  ///< what determined the series of the last block; none before the first block
  bool is_certified_ = false;
  std::vector<std::size_t> left_;  ///< samples of the block that are solved one by one
};

class SeriesModel final : public ForwardingModel {
 public:
  explicit SeriesModel(std::shared_ptr<const Model> model) : ForwardingModel(std::move(model)) {}

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return std::make_unique<SeriesEvaluator>(behind(), behind().evaluator(options));
  }
};

}  // namespace

std::unique_ptr<Model> with_series(std::shared_ptr<const Model> model) {
  return std::make_unique<SeriesModel>(std::move(model));
}

}  // namespace poesy
