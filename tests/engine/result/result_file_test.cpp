#include "engine/result/result_file.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/evaluation.h"

#include <gtest/gtest.h>

#include <array>

#include <cmath>

#include "engine/base/error.h"
#include "engine/kinds/study_file.h"
#include "engine/result/described.h"
#include "engine/storage/version.h"
#include "engine/study/study_file.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/elements.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

/// Expects equal numbers. NaN equals NaN.
void expect_same(std::span<const double> found, std::span<const double> expected, const char* name) {
  ASSERT_EQ(found.size(), expected.size()) << name;
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_TRUE(found[k] == expected[k] || (std::isnan(found[k]) && std::isnan(expected[k])))
        << name << "[" << k << "] is " << found[k] << ", not " << expected[k];
  }
}

void expect_same(const PoseSet& found, const PoseSet& expected) {
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_EQ(found.coordinates(), expected.coordinates());
  for (std::size_t c = 0; c < found.coordinates(); ++c) {
    EXPECT_EQ(found.column(c), expected.column(c));
  }
}

std::vector<std::string> names_with_units(const std::vector<NamedUnit>& list) {
  std::vector<std::string> texts;
  for (const NamedUnit& thing : list) texts.push_back(thing.name + " " + thing.unit);
  return texts;
}

using Names = std::vector<std::string>;

TEST(ResultFile, SensitivityReadsBackAsWritten) {
  const TempFolder folder;
  const Example example;
  example.write_sensitivity(folder / "r.h5");
  const StoredResult stored = read_result(folder / "r.h5");
  const sensitivity::Result expected = example.sensitivity();
  const sensitivity::Result& found = sensitivity::sensitivity_of(stored);

  EXPECT_EQ(stored.kind, "sensitivity");
  EXPECT_EQ(stored.title, example.study.title);
  EXPECT_EQ(stored.model, "fake");
  EXPECT_EQ(stored.study_text, resolved_text(example.study));
  EXPECT_EQ(stored.poesy_version, poesy_version());
  EXPECT_EQ(names_with_units(stored.pose_coordinates), (Names{"z m", "beta rad", "gamma rad"}));
  EXPECT_EQ(names_with_units(stored.factors), (Names{"epsilon_1 rad", "delta_1 m"}));
  EXPECT_EQ(names_with_units(stored.responses), (Names{"angular_deformation rad", "linear_deformation m"}));
  expect_same(stored.poses, example.poses.poses);
  EXPECT_EQ(stored.condition, example.poses.condition);
  expect_same(stored.factor_sigma, std::vector{example.study.errors.by_factor[1].standard_deviation(), 0.001}, "sigma");

  EXPECT_EQ(found.responses(), 2U);
  EXPECT_EQ(found.factors(), 2U);
  EXPECT_EQ(found.poses(), Example::kPoses);
  EXPECT_EQ(found.conf_level, expected.conf_level);
  expect_same(found.local, expected.local, "local");
  expect_same(found.local_ci_low, expected.local_ci_low, "local_ci_low");
  expect_same(found.local_ci_high, expected.local_ci_high, "local_ci_high");
  EXPECT_EQ(found.count, expected.count);
  expect_same(found.mean, expected.mean, "mean");
  expect_same(found.std, expected.std, "std");
  expect_same(found.global, expected.global, "global");
  expect_same(found.global_ci_low, expected.global_ci_low, "global_ci_low");
  expect_same(found.global_ci_high, expected.global_ci_high, "global_ci_high");
  expect_same(found.global_corrected, expected.global_corrected, "global_corrected");
  expect_same(found.global_corrected_ci_low, expected.global_corrected_ci_low, "global_corrected_ci_low");
  expect_same(found.global_corrected_ci_high, expected.global_corrected_ci_high, "global_corrected_ci_high");
  expect_same(found.rounding, expected.rounding, "rounding");
  expect_same(found.index_change, expected.index_change, "index_change");
  expect_same(found.background, expected.background, "background");
  ASSERT_TRUE(found.history);
  EXPECT_EQ(found.history->samples, expected.history->samples);
  expect_same(found.history->value, expected.history->value, "history global");
  expect_same(found.history->ci_low, expected.history->ci_low, "history global_ci_low");
  expect_same(found.history->ci_high, expected.history->ci_high, "history global_ci_high");
  EXPECT_EQ(stored.failures, expected.failures);
  ASSERT_EQ(found.solves.lengths(), expected.solves.lengths());
  for (std::size_t cell = 0; cell < found.solves.size(); ++cell) {
    const SolveCounts& read = found.solves.all()[cell];
    const SolveCounts& written = expected.solves.all()[cell];
    EXPECT_EQ(read.by_status, written.by_status) << cell;
    EXPECT_EQ(read.iterations, written.iterations) << cell;
    EXPECT_EQ(read.most_iterations, written.most_iterations) << cell;
  }
}

TEST(ResultFile, SaysWhatErrorsAndResponsesAre) {
  const TempFolder folder;
  const Example example;
  example.write_sensitivity(folder / "r.h5");
  const StoredResult stored = read_result(folder / "r.h5");
  const ModelDescription& model = example.study.model();
  for (std::size_t p = 0; p < stored.factors.size(); ++p) {
    EXPECT_EQ(stored.factors[p].description, model.factors[example.study.analysis.factors[p].value].description);
  }
  for (std::size_t r = 0; r < stored.responses.size(); ++r) {
    EXPECT_EQ(stored.responses[r].description, model.responses[r].description);
  }
}

TEST(ResultFile, ReadsBackWhatARunSaysOfItsStudy) {
  const TempFolder folder;
  const Example example;
  example.write_sensitivity(folder / "r.h5");
  const StoredResult stored = read_result(folder / "r.h5");
  const StoredResult said = described(example.study, *build_model(example.study.mechanism), example.poses);
  EXPECT_EQ(said.kind, stored.kind);
  EXPECT_EQ(said.title, stored.title);
  EXPECT_EQ(said.model, stored.model);
  EXPECT_EQ(said.metric, stored.metric);
  EXPECT_EQ(said.metric_points, stored.metric_points);
  EXPECT_EQ(names_with_units(said.pose_coordinates), names_with_units(stored.pose_coordinates));
  EXPECT_EQ(names_with_units(said.responses), names_with_units(stored.responses));
  EXPECT_EQ(said.headline, stored.headline);
  EXPECT_EQ(said.signed_headline, stored.signed_headline);
  expect_same(said.poses, stored.poses);
  EXPECT_EQ(said.condition, stored.condition);
  EXPECT_EQ(said.time, stored.time);
}

TEST(ResultFile, FactsReadBackAsWritten) {
  const TempFolder folder;
  const Example example;
  example.write_sensitivity(folder / "r.h5");
  const RunFacts facts = read_result(folder / "r.h5").facts;
  EXPECT_EQ(facts.created, example.facts.created);
  EXPECT_EQ(facts.host, example.facts.host);
  EXPECT_EQ(facts.cpu, example.facts.cpu);
  EXPECT_EQ(facts.threads, example.facts.threads);
  EXPECT_EQ(facts.ranks, example.facts.ranks);
  EXPECT_EQ(facts.wall_seconds, example.facts.wall_seconds);
  EXPECT_EQ(facts.checkpoint_seconds, example.facts.checkpoint_seconds);
  EXPECT_EQ(facts.solves, example.facts.solves);
}

class EvaluationFile : public testing::TestWithParam<Pairing> {};

TEST_P(EvaluationFile, ReadsBackAsWritten) {
  const TempFolder folder;
  const Example example;
  example.write_evaluation(folder / "e.h5", GetParam());
  const StoredResult stored = read_result(folder / "e.h5");
  const EvaluationResult expected = example.evaluation(GetParam()).solves;
  const evaluate::Evaluation& evaluation = evaluate::evaluation_of(stored);
  const EvaluationResult& found = evaluation.solves;

  EXPECT_EQ(stored.kind, "evaluate");
  EXPECT_EQ(evaluation.pairing, GetParam());
  EXPECT_EQ(names_with_units(stored.factors), (Names{"delta_2 m", "epsilon_1 rad"}));
  EXPECT_EQ(evaluation.joints, (Names{"q_1", "q_2"}));
  expect_same(stored.poses, example.poses.poses);
  EXPECT_EQ(stored.condition, example.poses.condition);
  EXPECT_EQ(elements(evaluation.errors), example.errors(GetParam()).values);
  ASSERT_EQ(evaluation.details.size(), 3U);
  EXPECT_EQ(evaluation.details[2].name, "twist_32");
  EXPECT_EQ(evaluation.details[2].unit, "rad,rad,m");
  EXPECT_EQ(evaluation.details[2].components, (Names{"omega_x", "omega_y", "v_z"}));

  EXPECT_EQ(found.response, expected.response);
  EXPECT_EQ(found.detail, expected.detail);
  EXPECT_EQ(found.joint_displacement, expected.joint_displacement);
  EXPECT_EQ(found.status, expected.status);
  EXPECT_EQ(found.iterations, expected.iterations);
}

INSTANTIATE_TEST_SUITE_P(BothPairings, EvaluationFile,
                         testing::Values(Pairing::every_pose_with_every_row, Pairing::row_by_row),
                         [](const auto& pairing) {
                           return pairing.param == Pairing::row_by_row ? "RowByRow" : "EveryRow";
                         });

TEST(ResultFile, SameResultGivesSameBytes) {
  const TempFolder folder;
  const Example example;
  example.write_sensitivity(folder / "a.h5");
  example.write_sensitivity(folder / "b.h5");
  EXPECT_EQ(read_bytes(folder / "a.h5"), read_bytes(folder / "b.h5"));
}

TEST(ResultFile, ReplacesAnOlderResultAndLeavesNothingBeside) {
  const TempFolder folder;
  write_bytes(folder / "r.h5", "old");
  Example().write_sensitivity(folder / "r.h5");
  EXPECT_TRUE(verify_result(folder / "r.h5").matches());
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(CheckResultPath, TakesNewAndExistingFiles) {
  const TempFolder folder;
  write_bytes(folder / "old.h5", "poesy-result");
  EXPECT_NO_THROW(check_result_path(folder / "new.h5"));
  EXPECT_NO_THROW(check_result_path(folder / "old.h5"));
  EXPECT_NO_THROW(check_result_path("in-the-current-folder.h5"));
  EXPECT_EQ(read_bytes(folder / "old.h5"), "poesy-result");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(CheckResultPath, RefusesWhatCannotBecomeAResult) {
  const TempFolder folder;
  EXPECT_THROW(check_result_path(folder / "missing/r.h5"), InputError);
  EXPECT_THROW(check_result_path(folder.path()), InputError);
  EXPECT_THROW(check_result_path(folder.path() + "/"), InputError);
  EXPECT_THROW(check_result_path("/dev/null"), InputError);
  EXPECT_THROW(check_result_path(""), InputError);
}

TEST(CheckResultPath, KeepsOtherFilesFromBeingReplaced) {
  const TempFolder folder;
  write_bytes(folder / "study.toml", "old");
  write_bytes(folder / "shard.h5", "old");
  EXPECT_THROW(check_result_path(folder / "study.toml"), InputError);
  EXPECT_THROW(check_result_path(folder / "shard.h5", std::array{folder / "study.toml", folder / "./shard.h5"}),
               InputError);
}

}  // namespace
}  // namespace poesy::test
