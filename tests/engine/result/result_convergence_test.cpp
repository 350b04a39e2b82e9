#include <gtest/gtest.h>

#include <limits>

#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/result/result_file.h"
#include "engine/storage/h5.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void expect_same(const ConvergenceResult& found, const ConvergenceResult& expected) {
  EXPECT_EQ(found.min, expected.min);
  EXPECT_EQ(found.max, expected.max);
  EXPECT_EQ(found.relative_error, expected.relative_error);
  EXPECT_EQ(found.course.conf_level, expected.course.conf_level);
  EXPECT_EQ(found.course.samples, expected.course.samples);
  EXPECT_EQ(found.reached, expected.reached);
  EXPECT_EQ(found.relative_half_width, expected.relative_half_width);
  EXPECT_EQ(found.samples, expected.samples);
  ASSERT_EQ(found.course.value.size(), expected.course.value.size());
  for (std::size_t k = 0; k < found.course.value.size(); ++k) {
    const bool ended = std::isnan(expected.course.value[k]);
    EXPECT_TRUE(ended ? std::isnan(found.course.value[k]) : found.course.value[k] == expected.course.value[k]);
    EXPECT_TRUE(ended ? std::isnan(found.course.half_width[k])
                      : found.course.half_width[k] == expected.course.half_width[k]);
  }
}

class ConvergenceFile : public testing::Test {
 protected:
  ConvergenceFile() {
    example_.study.analysis.samples = 2500;
    example_.study.analysis.adaptive = AdaptiveSamples{1000, 0.25};
  }

  test::TempFolder folder_;
  test::Example example_;
  std::string path_ = folder_.file("convergence.h5");
};

TEST_F(ConvergenceFile, OfASensitivityResult) {
  sensitivity::Result result = example_.sensitivity();
  result.convergence = {.min = 1000,
                        .max = 2500,
                        .relative_error = 0.25,
                        .course = {.samples = {1000, 2500},
                                   .value = {8.0, kNaN, 4.0, 4.5, 2.0, kNaN, 1.0, 1.5},
                                   .half_width = {1.0, kNaN, 2.0, 1.5, 0.5, kNaN, 0.5, 0.25},
                                   .conf_level = 0.95},
                        .reached = {1, 0, 1, 1},
                        .relative_half_width = {0.125, 1.0 / 3.0, 0.25, 0.0625},
                        .samples = {1000, 2500}};
  write_result(path_, example_.study, example_.poses, result, example_.facts);
  EXPECT_TRUE(verify_result(path_).matches());
  const StoredResult stored = read_result(path_);
  ASSERT_TRUE(stored.convergence);
  expect_same(*stored.convergence, *result.convergence);
  EXPECT_FALSE(sensitivity::sensitivity_of(stored).history);
  EXPECT_FALSE(h5::File::open(path_).exists("/sensitivity/history"));
  EXPECT_NE(stored.study_text.find("samples.relative_error = 0.25\n"), std::string::npos) << stored.study_text;

  export_tables(path_, folder_.file("tables"));
  EXPECT_EQ(test::read_bytes(folder_.file("tables/convergence.csv")),
            "factor,samples,angular_deformation_reached,angular_deformation_relative_half_width,"
            "linear_deformation_reached,linear_deformation_relative_half_width\n"
            "epsilon_1,1000,1,0.125,1,0.25\ndelta_1,2500,0,0.3333333333333333,1,0.0625\n");
  EXPECT_EQ(test::read_bytes(folder_.file("tables/convergence_linear_deformation.csv")),
            "factor,samples,index [m per rad or m],half_width [m per rad or m]\n"
            "epsilon_1,1000,2,0.5\ndelta_1,1000,1,0.5\ndelta_1,2500,1.5,0.25\n");
}

TEST_F(ConvergenceFile, OfAMonteCarloResult) {
  monte_carlo::Result result = example_.monte_carlo();
  result.convergence = {.min = 1000,
                        .max = 2500,
                        .relative_error = 0.25,
                        .course = {.samples = {1000, 2000},
                                   .value = {8.0, 8.5, 4.0, 4.5},
                                   .half_width = {1.0, 0.5, 2.0, 0.5},
                                   .conf_level = 0.9},
                        .reached = {1, 1},
                        .relative_half_width = {0.0625, 0.125},
                        .samples = {2000}};
  write_result(path_, example_.study, example_.poses, result, example_.facts);
  EXPECT_TRUE(verify_result(path_).matches());
  const StoredResult stored = read_result(path_);
  ASSERT_TRUE(stored.convergence);
  expect_same(*stored.convergence, *result.convergence);
  const h5::File file = h5::File::open(path_);
  EXPECT_TRUE(file.exists("/convergence/mean"));
  EXPECT_EQ(file.shape("/convergence/half_width").size(), 2u);

  export_tables(path_, folder_.file("tables"));
  EXPECT_EQ(test::read_bytes(folder_.file("tables/convergence_angular_deformation.csv")),
            "errors,samples,mean [rad],half_width [rad]\nall,1000,8,1\nall,2000,8.5,0.5\n");
}

TEST_F(ConvergenceFile, FixedSamplesHaveNone) {
  test::Example fixed;
  fixed.write_sensitivity(path_);
  EXPECT_FALSE(read_result(path_).convergence);
  EXPECT_FALSE(h5::File::open(path_).exists("/convergence"));
}

}  // namespace
}  // namespace poesy
