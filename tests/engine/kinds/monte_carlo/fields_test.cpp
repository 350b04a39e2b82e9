#include <gtest/gtest.h>

#include <cmath>

#include "engine/kinds/monte_carlo/result.h"
#include "engine/result/result_file.h"
#include "engine/storage/h5.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/temp_folder.h"

namespace poesy::monte_carlo {
namespace {

constexpr std::size_t kPoses = test::Example::kPoses;

class MonteCarloFile : public testing::Test {
 protected:
  MonteCarloFile() : path_(folder_.file("monte_carlo.h5")) { example_.write_monte_carlo(path_); }

  test::TempFolder folder_;
  test::Example example_;
  std::string path_;
};

/// Expects equal numbers. NaN equals NaN.
template <NamedAxis... Axes>
void expect_same(const Array<double, Axes...>& found, const Array<double, Axes...>& expected) {
  ASSERT_EQ(found.lengths(), expected.lengths());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double one = found.all()[k];
    const double other = expected.all()[k];
    EXPECT_TRUE(one == other || (std::isnan(one) && std::isnan(other))) << k;
  }
}

/// Compares the given members (arrays) of two objects.
template <class Found, class... Members>
void expect_same_members(const Found& found, const Found& expected, Members... members) {
  (expect_same(found.*members, expected.*members), ...);
}

TEST_F(MonteCarloFile, IsReadBackAsItWas) {
  const Result written = example_.monte_carlo();
  const StoredResult stored = read_result(path_);
  const Result& found = monte_carlo_of(stored);
  EXPECT_EQ(stored.kind, "monte-carlo");
  EXPECT_EQ(stored.factor_sigma.size(), 2u);
  EXPECT_EQ(found.conf_level, 0.9);
  EXPECT_EQ(found.quantile_relative_error, 1.0 / 512.0);
  EXPECT_EQ(found.levels, written.levels);
  expect_same_members(found, written, &Result::mean, &Result::mean_ci_low, &Result::mean_ci_high, &Result::std,
                      &Result::min, &Result::max, &Result::quantiles, &Result::overall_mean, &Result::overall_std,
                      &Result::overall_min, &Result::overall_max, &Result::overall_quantiles, &Result::rms,
                      &Result::overall_rms, &Result::quantiles_ci_low, &Result::quantiles_ci_high,
                      &Result::overall_quantiles_ci_low, &Result::overall_quantiles_ci_high, &Result::histogram_edges,
                      &Result::share_magnitude, &Result::quantile_error, &Result::overall_quantile_error);
  EXPECT_EQ(stored.failures, written.failures);
  EXPECT_EQ(found.count, written.count);
  EXPECT_EQ(found.histogram_counts, written.histogram_counts);
  EXPECT_EQ(found.overall_count, written.overall_count);
  ASSERT_EQ(found.solves.size(), kPoses);
  for (std::size_t m = 0; m < kPoses; ++m) {
    EXPECT_EQ(found.solves[m].by_status, written.solves[m].by_status);
    EXPECT_EQ(found.solves[m].iterations, written.solves[m].iterations);
    EXPECT_EQ(found.solves[m].most_iterations, written.solves[m].most_iterations);
  }
  EXPECT_TRUE(verify_result(path_).matches());
}

TEST_F(MonteCarloFile, HasNamedAxesAndStatesItsError) {
  const h5::File file = h5::File::open(path_);
  EXPECT_EQ(file.shape("/monte_carlo/mean"), (h5::Shape{2, kPoses}));
  EXPECT_EQ(file.shape("/monte_carlo/quantiles"), (h5::Shape{2, kPoses, 2}));
  EXPECT_EQ(file.read<double>("/monte_carlo/quantile"), (std::vector<double>{0.05, 0.995}));
  EXPECT_EQ(file.attribute<double>("/monte_carlo/quantiles", "quantile_relative_error").at(0), 1.0 / 512.0);
  EXPECT_EQ(file.attribute<double>("/monte_carlo/mean_ci_low", "conf_level").at(0), 0.9);
  EXPECT_EQ(file.read<std::uint64_t>("/solver/not_converged"), (std::vector<std::uint64_t>{3, 4, 5, 6}));
  EXPECT_EQ(file.shape("/solver/solves_by_status"), (h5::Shape{5, kPoses}));
}

TEST_F(MonteCarloFile, ListsMachinesThatCannotBeAssembled) {
  Result written = example_.monte_carlo();
  written.solves[1].by_status[static_cast<std::size_t>(SolveStatus::not_assembled)] = 4;
  written.failures = {{0, PoseIndex{1}, {SampleIndex{7}, SolveStatus::not_assembled}}};
  const std::string path = folder_.file("impossible.h5");
  write_result(path, example_.study, example_.poses, written, example_.facts);
  const h5::File file = h5::File::open(path);
  EXPECT_EQ(file.read<std::string>("/status").at(5), "not_assembled");
  EXPECT_EQ(file.shape("/solver/solves_by_status"), (h5::Shape{6, kPoses}));
  EXPECT_EQ(file.attribute<std::string>("/solver/failed_status", "status_names"), file.read<std::string>("/status"));
  const StoredResult stored = read_result(path);
  EXPECT_EQ(monte_carlo_of(stored).solves[1].by_status, written.solves[1].by_status);
  EXPECT_EQ(stored.failures, written.failures);
  EXPECT_EQ(h5::File::open(path_).read<std::string>("/status").size(), 5u)
      << "as a result without such machines ever was";
  const std::string tables = folder_.file("tables");
  export_tables(path, tables);
  EXPECT_NE(test::read_bytes(tables + "/not_converged.csv").find("solves_non_finite,solves_not_assembled\n"),
            std::string::npos);
}

/// Files of version 0.2 have no quantile_error.
TEST_F(MonteCarloFile, IsReadWithoutTheErrorsOfItsQuantiles) {
  Result older = example_.machines();
  older.quantile_error = {};
  older.overall_quantile_error = {};
  older.machines->largest.quantile_error = {};
  older.machines->rms.quantile_error = {};
  write_result(path_, example_.study, example_.poses, older, example_.facts);
  EXPECT_FALSE(h5::File::open(path_).exists("/monte_carlo/quantile_error"));
  EXPECT_TRUE(monte_carlo_of(read_result(path_)).quantile_error.empty());
  const std::string tables = folder_.file("tables");
  export_tables(path_, tables);
  EXPECT_EQ(test::read_bytes(tables + "/overall.csv").find("quantile_error"), std::string::npos);
  EXPECT_EQ(test::read_bytes(tables + "/machines_rms.csv").find("quantile_error"), std::string::npos);
}

TEST_F(MonteCarloFile, KeepsItsVerdicts) {
  const LimitVerdicts written = test::Example::verdicts();
  const auto found = read_result(path_).verdicts;
  ASSERT_TRUE(found);
  EXPECT_EQ(found->judge, Judge::share);
  EXPECT_EQ(found->share, 0.9973);
  ASSERT_EQ(found->limits.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(found->limits[k].response, written.limits[k].response);
    EXPECT_EQ(found->limits[k].limit, written.limits[k].limit);
    EXPECT_EQ(found->limits[k].value, written.limits[k].value);
    EXPECT_EQ(found->limits[k].passed, written.limits[k].passed);
    EXPECT_EQ(found->limits[k].tried, written.limits[k].tried);
    EXPECT_EQ(found->limits[k].within, written.limits[k].within);
    EXPECT_EQ(found->limits[k].pose, written.limits[k].pose);
    EXPECT_EQ(found->limits[k].row, written.limits[k].row);
  }
}

void expect_same(const MachineValues& found, const MachineValues& expected) {
  expect_same_members(found, expected, &MachineValues::mean, &MachineValues::mean_ci_low, &MachineValues::mean_ci_high,
                      &MachineValues::std, &MachineValues::min, &MachineValues::max, &MachineValues::quantiles,
                      &MachineValues::quantiles_ci_low, &MachineValues::quantiles_ci_high,
                      &MachineValues::quantile_error, &MachineValues::histogram_edges);
  EXPECT_EQ(found.count, expected.count);
  EXPECT_EQ(found.histogram_counts, expected.histogram_counts);
}

void expect_same(const MainEffects& found, const MainEffects& expected) {
  expect_same_members(found, expected, &MainEffects::s1, &MainEffects::s1_ci_low, &MainEffects::s1_ci_high,
                      &MainEffects::mean, &MainEffects::ci_low, &MainEffects::ci_high);
}

void expect_same(const YieldResult& found, const YieldResult& expected) {
  for (const auto member :
       {&YieldResult::conf_level, &YieldResult::value, &YieldResult::ci_low, &YieldResult::ci_high,
        &YieldResult::unsolved_pass, &YieldResult::unsolved_pass_ci_low, &YieldResult::unsolved_pass_ci_high}) {
    EXPECT_EQ(found.*member, expected.*member);
  }
  for (const auto member :
       {&YieldResult::rejects, &YieldResult::machines, &YieldResult::unsolved, &YieldResult::unsolved_pass_rejects}) {
    EXPECT_EQ(found.*member, expected.*member);
  }
  expect_same_members(found, expected, &YieldResult::by_response, &YieldResult::by_response_ci_low,
                      &YieldResult::by_response_ci_high, &YieldResult::worst_pose_share, &YieldResult::gradient,
                      &YieldResult::gradient_ci_low, &YieldResult::gradient_ci_high, &YieldResult::change,
                      &YieldResult::change_ci_low, &YieldResult::change_ci_high, &YieldResult::linear_share,
                      &YieldResult::mean_square_share, &YieldResult::mean_square_share_ci_low,
                      &YieldResult::mean_square_share_ci_high, &YieldResult::offset, &YieldResult::offset_share);
}

TEST_F(MonteCarloFile, KeepsWhatMachinesDid) {
  example_.write_machines(path_);
  const MachineResult written = *example_.machines().machines;
  const StoredResult stored = read_result(path_);
  ASSERT_TRUE(monte_carlo_of(stored).machines);
  const MachineResult& found = *monte_carlo_of(stored).machines;
  EXPECT_EQ(found.conf_level, written.conf_level);
  expect_same(found.largest, written.largest);
  expect_same(found.rms, written.rms);
  const EffectResult effects = example_.machines().effects;
  EXPECT_EQ(monte_carlo_of(stored).effects.s1_poses, effects.s1_poses);
  expect_same(monte_carlo_of(stored).effects.bin_error, effects.bin_error);
  expect_same(monte_carlo_of(stored).effects.effects, effects.effects);
  expect_same(found.effects_on_largest, written.effects_on_largest);
  expect_same(*found.yield, *written.yield);
  ASSERT_TRUE(stored.verdicts && stored.verdicts->yield);
  const YieldVerdict& verdict = *stored.verdicts->yield;
  EXPECT_EQ(verdict.asked, 0.9);
  EXPECT_EQ(verdict.decision, YieldVerdict::Decision::not_kept);
  EXPECT_EQ(verdict.unsolved, 1u);
  EXPECT_FALSE(stored.verdicts->passed());
  EXPECT_TRUE(verify_result(path_).matches());
  const h5::File file = h5::File::open(path_);
  EXPECT_EQ(file.shape("/yield/gradient"), (h5::Shape{2}));
  EXPECT_EQ(file.shape("/yield/mean_square_share"), (h5::Shape{2, 2}));
  EXPECT_EQ(file.shape("/yield/worst_pose_share"), (h5::Shape{2, kPoses}));
  EXPECT_EQ(file.shape("/monte_carlo/main_effect/mean"), (h5::Shape{2, 2, kEffectBins}));
  EXPECT_EQ(file.shape("/monte_carlo/S1"), (h5::Shape{2, 2}));
}

std::string first_lines(const std::string& text, std::size_t count) {
  std::size_t end = 0;
  for (std::size_t n = 0; n < count; ++n) end = text.find('\n', end) + 1;
  return text.substr(0, end);
}

TEST_F(MonteCarloFile, IsExportedPoseByPose) {
  const std::string tables = folder_.file("tables");
  EXPECT_EQ(export_tables(path_, tables).size(), 13u);
  EXPECT_EQ(
      first_lines(test::read_bytes(tables + "/monte_carlo_linear_deformation.csv"), 2),
      "pose,mean [m],mean_ci_low [m],mean_ci_high [m],std [m],min [m],max [m],count,q_0.05 [m],q_0.995 [m],rms [m],"
      "q_0.05_ci_low [m],q_0.05_ci_high [m],q_0.995_ci_low [m],q_0.995_ci_high [m],quantile_error [m]\n"
      "0,0.625,1.625,2.625,3.625,4.625,5.625,93,7.125,7.25,10.125,11.875,13.875,12,14,17.375\n");
  EXPECT_EQ(test::read_bytes(tables + "/overall.csv"),
            "response,mean,std,min,max,count,q_0.05,q_0.995,rms,q_0.05_ci_low,q_0.05_ci_high,q_0.995_ci_low,"
            "q_0.995_ci_high,quantile_error,unit\n"
            "angular_deformation,8.125,8.375,8.625,8.875,382,9.125,9.25,10.625,14.875,15.375,15,15.5,17.875,rad\n"
            "linear_deformation,NaN,NaN,NaN,NaN,366,9.375,NaN,NaN,15.125,15.625,NaN,NaN,NaN,m\n");
  EXPECT_EQ(test::read_bytes(tables + "/histogram_angular_deformation.csv"),
            "bin,low [rad],high [rad],count\n0,0,1,100\n1,1,2,200\n2,2,4,82\n");
  EXPECT_EQ(test::read_bytes(tables + "/limits.csv"),
            "response,value,limit,passed,tried,within,pose,row,unit\n"
            "angular_deformation,0.375,0.5,1,400,382,2,-1,rad\n"
            "linear_deformation,inf,0.25,0,400,96,3,-1,m\n");
  EXPECT_EQ(first_lines(test::read_bytes(tables + "/not_converged.csv"), 2),
            "pose,not_converged,iterations_mean,iterations_max,solves_converged,solves_stagnated,solves_iteration_cap,"
            "solves_singular,solves_non_finite\n0,3,7,50,90,7,2,1,0\n");
  EXPECT_EQ(first_lines(test::read_bytes(tables + "/factors.csv"), 1), "factor,sigma [rad or m],sigma [deg or mm]\n");
}

}  // namespace
}  // namespace poesy::monte_carlo
