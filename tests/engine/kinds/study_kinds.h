#pragma once

#include <gtest/gtest.h>

#include <bit>

#include "engine/kinds/identification/identification.h"
#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/evaluation.h"
#include "engine/run/run_options.h"
#include "tests/engine/run/prepared.h"
#include "tests/support/elements.h"
#include "tests/support/failing_model.h"
#include "tests/support/kinds.h"

namespace poesy::test {

inline const Catalog& catalog() {
  static const Catalog failing = failing_catalog();
  return failing;
}

inline Study study_of(KindOfStudy kind, std::size_t samples) {
  Study study;
  study.mechanism = {&catalog().front(), {test::FakeModel::kArm}, 0, {}};
  study.errors.by_factor.assign(3, Distribution::normal(1e-3));
  study.poses.count = 3;
  study.poses.workspace = {{-0.3, -0.2}, {-0.1, 0.1}, {-0.1, 0.1}};
  study.analysis.kind = kind;
  study.analysis.factors = {FactorIndex(0), FactorIndex(1)};
  study.analysis.samples = samples;
  set_quantiles(study.analysis, {0.1, 0.9});
  study.seed = 3;
  return study;
}

/// The bits of all numbers of a result, for exact comparisons.
using Bits = std::vector<std::uint64_t>;

inline void append(Bits& bits, std::span<const double> values) {
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
}

inline void append(Bits& bits, const SolveCounts& solves) {
  bits.insert(bits.end(), solves.by_status.begin(), solves.by_status.end());
  bits.insert(bits.end(), {solves.iterations, solves.most_iterations});
}

inline void append(Bits& bits, const std::vector<Failure>& failures) {
  for (const Failure& failure : failures) {
    bits.insert(bits.end(), {failure.slot, failure.pose.value, failure.failed.sample.value,
                             static_cast<std::uint64_t>(failure.failed.status)});
  }
}

inline Bits bits_of(const sensitivity::Result& result) {
  Bits bits;
  for (const auto values :
       {result.local.all(), result.local_ci_low.all(), result.global.all(), result.global_ci_high.all(),
        result.mean.all(), result.std.all(), result.background.all()}) {
    append(bits, values);
  }
  bits.insert(bits.end(), result.count.begin(), result.count.end());
  for (const SolveCounts& solves : result.solves) append(bits, solves);
  append(bits, result.failures);
  if (result.history) {
    bits.insert(bits.end(), result.history->samples.begin(), result.history->samples.end());
    for (const auto* values : {&result.history->value, &result.history->ci_low, &result.history->ci_high}) {
      append(bits, *values);
    }
  }
  return bits;
}

inline Bits bits_of(const monte_carlo::Result& result) {
  Bits bits;
  for (const std::span<const double> values : std::initializer_list<std::span<const double>>{
           result.mean, result.mean_ci_low, result.std, result.min, result.max, result.quantiles, result.overall_mean,
           result.overall_std, result.overall_min, result.overall_quantiles}) {
    append(bits, values);
  }
  bits.insert(bits.end(), result.count.begin(), result.count.end());
  bits.insert(bits.end(), result.overall_count.begin(), result.overall_count.end());
  for (const SolveCounts& solves : result.solves) append(bits, solves);
  append(bits, result.failures);
  return bits;
}

inline Bits bits_of(const EvaluationResult& result) {
  Bits bits;
  append(bits, elements(result.response));
  append(bits, elements(result.detail));
  append(bits, result.total());
  return bits;
}

inline Bits bits_of(const identification::Result& result) {
  Bits bits(elements(result.coupled_below));
  append(bits, elements(result.single_max));
  bits.insert(bits.end(), result.coupled_reduced.begin(), result.coupled_reduced.end());
  bits.insert(bits.end(), result.coupled.begin(), result.coupled.end());
  append(bits, result.solves);
  return bits;
}

/// Runs the study. Returns the bits of its result, or none if the run was stopped.
inline std::optional<Bits> run(const Prepared& prepared, const RunOptions& options) {
  const auto table = [&](const ErrorTable& errors) {
    return run_evaluation(*prepared.model, {}, prepared.plan.poses(), errors, Pairing::every_pose_with_every_row,
                          options);
  };
  const auto bits = [](const auto& result) { return result ? std::optional(bits_of(*result)) : std::nullopt; };
  const KindOfStudy kind = prepared.study.analysis.kind;
  if (kind == &sensitivity::kStudy)
    return bits(sensitivity::run_sensitivity(prepared.plan, *prepared.model, 0.95, options));
  if (kind == &monte_carlo::kStudy) {
    return bits(monte_carlo::run_monte_carlo(prepared.plan, *prepared.model, prepared.study.analysis, options));
  }
  if (kind == &identification::kStudy) {
    Analysis analysis = prepared.study.analysis;
    analysis.asked = identification::Options{{{"one", 1e-3, 1e-3}, {"two", 2e-3, 2e-3}}, 0.9};
    return bits(identification::identify(analysis, prepared.model->description(), table));
  }
  ErrorTable errors{{FactorIndex(0), FactorIndex(1)}, {}, 700};
  for (std::size_t k = 0; k < 2 * errors.rows; ++k) errors.values.push_back(1e-6 * static_cast<double>(k));
  return bits(table(errors));
}

inline std::string kind_name(const testing::TestParamInfo<KindOfStudy>& info) {
  std::string text(info.param->name);
  std::erase(text, '-');
  return text;
}

}  // namespace poesy::test
