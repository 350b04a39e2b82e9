#include "engine/run/evaluation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string_view>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/run/rows_within.h"
#include "engine/run/unit_fold.h"

namespace poesy {
namespace {

/// The number of rows of the error table that are solved together at one pose.
constexpr std::size_t kBlockRows = 256;

/// Counts of how the solves with numbers in [first, end) ended. Solves are numbered pose by pose, then sample by
/// sample.
SolveCounts solves_of(const EvaluationResult& result, std::size_t first, std::size_t end) {
  SolveCounts solves;
  for (std::size_t n = first; n < end; ++n) solves.add(result.status.all()[n], result.iterations.all()[n]);
  return solves;
}

EvaluationResult empty_evaluation(const Model& model, const PoseSet& poses, std::size_t samples, Outcomes outcomes) {
  const ModelDescription& description = model.description();
  std::size_t components = 0;
  if (outcomes == Outcomes::with_details) {
    for (const Detail& detail : description.details) components += detail.components.size();
  }
  EvaluationResult result;
  make_room({description.responses.size(), poses.size(), samples}, result.response);
  make_room({poses.size(), samples, components}, result.detail);
  make_room({poses.size(), samples}, result.status, result.iterations);
  make_room({poses.size(), description.joints.size()}, result.joint_displacement);
  for (std::size_t m = 0; m < poses.size(); ++m) {
    std::ranges::copy(model.joint_displacements(poses[PoseIndex(m)]), result.joint_displacement.row(m).begin());
  }
  return result;
}

/// Divides the outcomes of a result into consecutive blocks, pose by pose: a block has kBlockRows samples at one pose,
/// or the remaining samples at this pose if there are fewer. Threads write outcomes into the result directly, so there
/// is nothing to merge.
struct OutcomeBlocks {
  EvaluationResult* result = nullptr;

  std::size_t per_pose() const { return (result->samples() + kBlockRows - 1) / kBlockRows; }
  /// The number of outcomes in all blocks before this block.
  std::size_t before(std::size_t block) const {
    if (per_pose() == 0) return 0;
    return block / per_pose() * result->samples() + std::min(block % per_pose() * kBlockRows, result->samples());
  }
  void add(std::size_t, const OutcomeBlocks&) {}
  void state(Archive& archive, const NumberRange& blocks) {
    const std::size_t first = before(blocks.first);
    const std::size_t count = before(blocks.end) - first;
    for (std::size_t r = 0; r < result->responses(); ++r) {
      archive.reals(result->response.row(r).subspan(first, count));
    }
    const std::size_t components = result->detail.length<axis::Component>();
    archive.reals(result->detail.all().subspan(first * components, count * components));
    for (std::size_t n = first; n < first + count; ++n) {
      archive.number(result->status.all()[n], kStatusNames.size() - 1);
      archive.number(result->iterations.all()[n]);
    }
  }
};

/// A job for UnitFold that solves an error table. Its units are blocks of rows of the table, pose by pose.
struct TableJob {
  const Model& model;
  const SolverOptions& solver;
  const PoseSet& poses;
  const ErrorTable& errors;
  bool paired;
  EvaluationResult& result;
  std::vector<double> zeros;

  /// The scratch memory of one thread.
  struct Scratch {
    std::unique_ptr<Evaluator> evaluator;
    std::vector<double> values;
    std::vector<double> responses;
    std::vector<double> details;
  };

  static constexpr std::string_view kName = "evaluation";
  std::vector<std::uint64_t> sizes() const {
    return {result.poses(), result.samples(), result.responses(), result.detail.length<axis::Component>(), kBlockRows};
  }
  NumberRange units(const Shard& shard) const { return shard.of(result.poses() * sums().per_pose()); }
  std::uint64_t expected(std::size_t n) const { return sums().before(n + 1) - sums().before(n); }
  auto worker() const {
    return [this, scratch = Scratch{model.evaluator(solver), {}, {}, {}}](std::size_t n) mutable {
      return solve(scratch, n);
    };
  }
  SolveCounts solves(std::size_t n, const OutcomeBlocks& all) const {
    return solves_of(result, all.before(n), all.before(n + 1));
  }
  OutcomeBlocks sums() const { return {&result}; }

  // The functions below are called by the workers.

  OutcomeBlocks solve(Scratch& scratch, std::size_t n) const {
    const std::size_t pose = n / sums().per_pose();
    const std::size_t first = n % sums().per_pose() * kBlockRows;
    const std::size_t count = std::min(kBlockRows, result.samples() - first);
    take_rows(paired ? pose : first, count, scratch.values);
    scratch.responses.resize(result.responses() * count);
    scratch.details.resize(result.detail.length<axis::Component>() * count);
    const PoseIndex at(pose);
    scratch.evaluator->evaluate({poses[at], zeros, errors.factors, scratch.values, count, 0.0, poses.before(at)},
                                {scratch.responses, result.status.row(pose).subspan(first, count),
                                 result.iterations.row(pose).subspan(first, count), scratch.details});
    scatter(scratch, pose, first, count);
    return sums();
  }
  /// Copies `count` rows of the error table from row `first` on, transposed: all samples of the first error come first.
  void take_rows(std::size_t first, std::size_t count, std::vector<double>& values) const {
    const std::size_t varied = errors.factors.size();
    values.resize(varied * count);
    const ArrayView<double, axis::Factor, axis::Sample> by_error(values, {varied, count});
    const ArrayView<const double, axis::Sample, axis::Factor> table(errors.values, {errors.rows, varied});
    for (std::size_t v = 0; v < varied; ++v) {
      for (std::size_t b = 0; b < count; ++b) by_error(v, b) = table(first + b, v);
    }
  }

  void scatter(const Scratch& from, std::size_t pose, std::size_t first, std::size_t count) const {
    const ArrayView<const double, axis::Response, axis::Sample> responses(from.responses, {result.responses(), count});
    for (std::size_t r = 0; r < result.responses(); ++r) {
      std::ranges::copy(responses.row(r), result.response.row(r, pose).subspan(first).begin());
    }
    const std::size_t components = result.detail.length<axis::Component>();
    const ArrayView<const double, axis::Component, axis::Sample> details(from.details, {components, count});
    for (std::size_t d = 0; d < components; ++d) {
      for (std::size_t b = 0; b < count; ++b) result.detail(pose, first + b, d) = details(d, b);
    }
  }
};

std::size_t number_of_rows(const EvaluationResult& found, Pairing pairing) {
  return pairing == Pairing::row_by_row ? found.poses() : found.samples();
}

/// How one row of errors (a machine) compares with one limit.
struct JudgedRow {
  bool within = false;
  /// Number that is compared with the limit, from the poses whose solves count in statistics (counts()); NaN if there
  /// is no such pose.
  double value = kNaN;
  std::optional<std::size_t> pose = std::nullopt;  ///< pose at which `value` occurs, if it is the value at one pose
};

JudgedRow judge_row(const ResponseLimit& limit, const EvaluationResult& found, Pairing pairing, NotConverged policy,
                    std::size_t row) {
  const bool paired = pairing == Pairing::row_by_row;
  const std::size_t first = paired ? row : 0;
  const std::size_t poses = paired ? 1 : found.poses();
  const std::size_t sample = paired ? 0 : row;
  std::vector<double> values;
  for (std::size_t m = first; m < first + poses; ++m) {
    const double value = found.response(limit.response, m, sample);
    if (!counts(found.status(m, sample), policy)) continue;
    values.push_back(limit.allowed.is_magnitude() ? std::abs(value) : value);
  }
  JudgedRow judged{poses > 0 && values.size() == poses && limit.allowed.keeps(values, poses)};
  std::erase_if(values, [](double value) { return std::isnan(value); });
  judged.value = limit.allowed.deciding(values, poses);
  if (limit.allowed.is_spread()) return judged;
  for (std::size_t m = first; m < first + poses && !judged.pose; ++m) {
    const double value = found.response(limit.response, m, sample);
    const bool is_it = (limit.allowed.is_magnitude() ? std::abs(value) : value) == judged.value;
    if (is_it && counts(found.status(m, sample), policy)) judged.pose = m;
  }
  return judged;
}

}  // namespace

SolveCounts EvaluationResult::total() const { return solves_of(*this, 0, status.size()); }

std::optional<EvaluationResult> run_evaluation(const Model& model, const SolverOptions& solver, const PoseSet& poses,
                                               const ErrorTable& errors, Pairing pairing, const RunOptions& options,
                                               Outcomes outcomes) {
  const bool paired = pairing == Pairing::row_by_row;
  EvaluationResult result = empty_evaluation(model, poses, paired ? 1 : errors.rows, outcomes);
  const std::vector<double> zeros(model.description().factors.size(), 0.0);
  if (!fold_units(TableJob{model, solver, poses, errors, paired, result, zeros}, options)) return std::nullopt;
  return result;
}

std::vector<std::uint8_t> rows_within(std::span<const ResponseLimit> limits, const EvaluationResult& found,
                                      Pairing pairing, NotConverged policy) {
  std::vector<std::uint8_t> within(number_of_rows(found, pairing), 1);
  for (const ResponseLimit& limit : limits) {
    for (std::size_t row = 0; row < within.size(); ++row) {
      if (!judge_row(limit, found, pairing, policy, row).within) within[row] = 0;
    }
  }
  return within;
}

LimitVerdicts judge_rows(std::span<const ResponseLimit> limits, const EvaluationResult& found, Pairing pairing,
                         NotConverged policy) {
  const std::size_t rows = number_of_rows(found, pairing);
  LimitVerdicts verdicts;
  for (const ResponseLimit& limit : limits) {
    LimitVerdict verdict{.response = limit.response, .limit = limit.allowed, .value = kNaN, .tried = rows};
    double worst = -std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < rows; ++row) {
      const JudgedRow judged = judge_row(limit, found, pairing, policy, row);
      if (judged.within) ++verdict.within;
      if (std::isnan(judged.value) || limit.allowed.badness(judged.value) <= worst) continue;
      worst = limit.allowed.badness(judged.value);
      verdict.value = judged.value;
      verdict.pose = judged.pose;
      verdict.row = row;
    }
    verdict.passed = verdict.within == verdict.tried;
    verdicts.limits.push_back(verdict);
  }
  verdicts.rows_within = static_cast<std::uint64_t>(std::ranges::count(rows_within(limits, found, pairing, policy), 1));
  return verdicts;
}

}  // namespace poesy
