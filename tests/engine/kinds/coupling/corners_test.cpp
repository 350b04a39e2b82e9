#include "engine/kinds/coupling/corners.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "engine/kinds/coupling/kind.h"
#include "engine/kinds/coupling/worst_case.h"
#include "engine/kinds/study_run.h"
#include "tests/support/elements.h"
#include "tests/support/function_model.h"

namespace poesy::test {
namespace {

constexpr double kSize = 1e-3;

/// A model that cannot assemble a sample whose sum of weight x error exceeds `most`.
class PartlySolved final : public FunctionModel {
 public:
  PartlySolved(std::size_t errors, ErrorFunction function, std::vector<double> weight, double most)
      : FunctionModel(errors, {"y"}, std::move(function)), weight_(std::move(weight)), most_(most) {}

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    class Some final : public Evaluator {
     public:
      Some(std::unique_ptr<Evaluator> all, const PartlySolved& model) : all_(std::move(all)), model_(&model) {}

      void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
        all_->evaluate(samples, outcomes);
        for (std::size_t b = 0; b < samples.count; ++b) {
          double sum = 0.0;
          for (std::size_t v = 0; v < samples.varied.size(); ++v) {
            sum += model_->weight_[samples.varied[v].value] * samples.values[v * samples.count + b];
          }
          if (sum > model_->most_) outcomes.status[b] = SolveStatus::singular;
        }
      }

     private:
      std::unique_ptr<Evaluator> all_;
      const PartlySolved* model_;
    };
    return std::make_unique<Some>(FunctionModel::evaluator(options), *this);
  }

 private:
  std::vector<double> weight_;
  double most_;
};

/// Two sources of errors: the first half and the second half of the errors. Each error is a block of its own.
coupling::Options halves(const Model& model, std::vector<double> sizes = {kSize}) {
  coupling::Options study{std::move(sizes), {}, {}, {}};
  study.pattern.limbs = coupling::ErrorPattern::Choice::independent;
  study.pattern.components = coupling::ErrorPattern::Choice::independent;
  study.sources = {{"A", {}}, {"B", {}}};
  const std::size_t errors = model.description().factors.size();
  for (std::size_t p = 0; p < errors; ++p) study.sources[p < errors / 2 ? 0 : 1].factors.emplace_back(p);
  return study;
}

/// The largest |y[0]| over all corners (every error +size or -size), by the function itself.
double largest_of_all_corners(const FunctionModel& model, double pose, double size) {
  const std::size_t errors = model.description().factors.size();
  std::vector<double> x(errors), y(model.description().responses.size());
  double largest = 0.0;
  for (std::size_t corner = 0; corner < std::size_t{1} << errors; ++corner) {
    for (std::size_t p = 0; p < errors; ++p) x[p] = (corner >> p & 1U) != 0 ? size : -size;
    model.function()(x, pose, y);
    largest = std::max(largest, std::abs(y[0]));
  }
  return largest;
}

struct Search {
  explicit Search(const Model& searched, const coupling::Options& asked)
      : study(asked),
        table(study, searched.description()),
        rounding(coupling::coupling_rounding(study, searched)),
        search(searched, {}, poses, table, rounding) {}

  coupling::WorstCorners all(std::size_t pose = 0, std::size_t size = 0) { return search(pose, size).subsets.back(); }

  coupling::Options study;
  PoseSet poses{1, {0.25, 0.75}};
  coupling::CornerTable table;
  Array<double, axis::Response, axis::Size> rounding;
  coupling::CornerSearch search;
};

/// y = sum of (a_p + pose) x_p + b_p x_p x_(p+1). If |a_p + pose| >= 3 |b| size, the first-order signs give the worst
/// corner.
ErrorFunction bilinear(std::vector<double> a, std::vector<double> b) {
  return [a = std::move(a), b = std::move(b)](std::span<const double> x, double pose, std::span<double> y) {
    y[0] = 0.0;
    for (std::size_t p = 0; p < a.size(); ++p) {
      y[0] += (a[p] + pose) * x[p] + b[p] * x[p] * x[(p + 1) % a.size()];
    }
  };
}

TEST(CornerTable, HasTheBlocksOfEachSubsetAndTheirErrors) {
  const FunctionModel model(4, {"y"}, bilinear({1, 1, 1, 1}, {0, 0, 0, 0}));
  const coupling::CornerTable each(halves(model), model.description());
  EXPECT_EQ(each.subsets, (std::vector<std::vector<std::size_t>>{{0, 1}, {2, 3}, {0, 1, 2, 3}}));
  EXPECT_EQ(each.signs_of_errors(1, "+-"), (std::vector{0.0, 0.0, 1.0, -1.0}));
  coupling::Options together = halves(model);
  together.pattern = {};
  const coupling::CornerTable sources(together, model.description());
  EXPECT_EQ(sources.subsets, (std::vector<std::vector<std::size_t>>{{0}, {1}, {0, 1}}));
  EXPECT_EQ(sources.signs_of_errors(2, "-+"), (std::vector{-1.0, -1.0, 1.0, 1.0}));
}

/// For a linear response the worst case is the first-order sum, sum of |a_p + pose| size. It is at the corner with the
/// signs of a or at the opposite corner.
TEST(CornerSearch, OfALinearResponseIsTheFirstOrderSum) {
  const std::vector<double> a{3.0, -1.0, 4.0, -2.0, 0.5, -7.0};
  const FunctionModel model(6, {"y"}, bilinear(a, std::vector(6, 0.0)));
  Search search(model, halves(model, {kSize, 2.0 * kSize}));
  for (const std::size_t pose : {0U, 1U}) {
    for (const std::size_t size : {0U, 1U}) {
      double sum = 0.0;
      for (const double one : a) sum += std::abs(one + search.poses[PoseIndex(pose)][0]);
      const coupling::WorstCorners found = search.all(pose, size);
      EXPECT_NEAR(found.value[0], sum * (size == 0 ? kSize : 2.0 * kSize), 1e-16);
      EXPECT_TRUE(found.signs[0] == "+-+-+-" || found.signs[0] == "-+-+-+") << found.signs[0];
      EXPECT_EQ(found.unsolved, 0u);
      EXPECT_LE(found.tried, 3u + 6u)
          << "the corner, its opposite, the positive one, and what a flip makes of the first";
    }
  }
}

/// The second order decides which sign is worse: |x + 50 x^2| is 1.05e-3 for +size (1e-3) and 0.95e-3 for -size.
TEST(CornerSearch, TriesBothSigns) {
  for (const double side : {50.0, -50.0}) {
    const FunctionModel model(2, {"y"}, [side](auto x, double, auto y) { y[0] = x[0] + x[1] + side * x[0] * x[0]; });
    EXPECT_NEAR(Search(model, halves(model)).all().value[0], 2.0e-3 + 50.0e-6, 1e-18);
  }
}

/// Compares the search with the solution of all corners for 100 random functions of eight errors. Their second order is
/// up to a third of the first order.
TEST(CornerSearch, FindsTheWorstOfAllCorners) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int n = 0; n < 100; ++n) {
    std::vector<double> a, b;
    for (int p = 0; p < 8; ++p) a.push_back(std::copysign(0.5 + std::abs(uniform(random)), uniform(random)));
    for (int p = 0; p < 8; ++p) b.push_back(uniform(random) / (12.0 * kSize));
    const FunctionModel model(8, {"y"}, bilinear(a, b));
    EXPECT_NEAR(Search(model, halves(model)).all().value[0], largest_of_all_corners(model, 0.25, kSize), 1e-17) << n;
  }
}

/// With a dominant second order, the first-order corner is usually not the worst. The search must end at a corner where
/// no flip of a single sign is worse.
TEST(CornerSearch, EndsWhereNoFlipIsWorse) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int improved = 0;
  for (int n = 0; n < 100; ++n) {
    std::vector<double> a, b;
    for (int p = 0; p < 8; ++p) a.push_back(uniform(random));
    for (int p = 0; p < 8; ++p) b.push_back(2.0 * uniform(random) / kSize);
    const FunctionModel model(8, {"y"}, bilinear(a, b));
    const coupling::WorstCorners found = Search(model, halves(model)).all();
    const auto value = [&](const coupling::Signs& signs) {
      std::vector<double> x, y(1);
      for (const char sign : signs) x.push_back(sign == '+' ? kSize : -kSize);
      model.function()(x, 0.25, y);
      return std::abs(y[0]);
    };
    EXPECT_EQ(found.value[0], value(found.signs[0]));
    coupling::Signs first;
    for (std::size_t p = 0; p < 8; ++p) {
      coupling::Signs flipped = found.signs[0];
      flipped[p] = flipped[p] == '+' ? '-' : '+';
      EXPECT_LE(value(flipped), found.value[0]);
      first += a[p] + 0.25 < 0.0 ? '-' : '+';
    }
    EXPECT_GE(found.value[0], value(first));
    improved += found.value[0] > value(first) ? 1 : 0;
    EXPECT_LE(found.value[0], largest_of_all_corners(model, 0.25, kSize));
  }
  EXPECT_GT(improved, 50);
}

/// A norm has no first-order signs at zero errors, so the search also tries the worst corners of other responses for
/// it.
TEST(CornerSearch, OfANormBeginsAtTheCornersOfOthers) {
  const std::vector<double> a{1.0, -1.0, 1.0, -1.0};
  const FunctionModel model(4, {"norm", "component"}, [&a](std::span<const double> x, double, std::span<double> y) {
    y[1] = 0.0;
    for (std::size_t p = 0; p < 4; ++p) y[1] += a[p] * x[p];
    y[0] = std::abs(y[1]);
  });
  const coupling::WorstCorners found = Search(model, halves(model)).all();
  EXPECT_NEAR(found.value[0], 4.0 * kSize, 1e-18);
}

/// The search ignores responses that are only rounding errors.
TEST(CornerSearch, DoesNotFollowRounding) {
  const FunctionModel model(6, {"y"}, [](std::span<const double> x, double, std::span<double> y) {
    y[0] = 1e-19 * std::sin(1e7 * (x[0] - 2.0 * x[3]));
  });
  const coupling::WorstCorners found = Search(model, halves(model)).all();
  EXPECT_LE(found.tried, 3u);
  EXPECT_LE(found.value[0], 1e-19);
}

/// y is the sum of four errors. Machines with y above 2.5 sizes cannot be assembled, so the corner ++++ (4 sizes) has
/// no solution. All other corners have one, and the worst of them is ---- (-4 sizes).
TEST(CornerSearch, NamesCornersThatHaveNoSolution) {
  const PartlySolved model(4, bilinear(std::vector(4, 0.75), std::vector(4, 0.0)), std::vector(4, 1.0), 2.5 * kSize);
  const coupling::WorstCorners found = Search(model, halves(model)).all();
  EXPECT_EQ(found.unsolved, 1u);
  EXPECT_EQ(found.first_unsolved, "++++");
  EXPECT_NEAR(found.value[0], 4.0 * kSize, 1e-18);
  EXPECT_EQ(found.signs[0], "----");
  const PartlySolved nothing(4, bilinear(std::vector(4, 1.0), std::vector(4, 0.0)), std::vector(4, 0.0), -1.0);
  const coupling::WorstCorners none = Search(nothing, halves(nothing)).all();
  EXPECT_EQ(none.unsolved, none.tried);
  EXPECT_TRUE(std::isnan(none.value[0]));
  EXPECT_EQ(none.signs[0], "");
}

/// The result of a study has the worst case over all poses with its signs and pose, and the first-order sum.
TEST(WorstCases, AreOfAllPosesInAStudy) {
  const PartlySolved model(4, bilinear({1.0, -1.0, 2.0, -2.0}, std::vector(4, 0.0)), std::vector(4, 1.0), 3.5 * kSize);
  CatalogEntry entry;
  entry.description = model.description();
  Study study;
  study.mechanism.entry = &entry;
  study.analysis.kind = &coupling::kStudy;
  study.analysis.asked = halves(model);
  study.analysis.factors = coupling::coupling_factors(halves(model), entry.description);
  const PoseSet poses(1, {0.25, 0.75, 0.5});
  const StudyResult result = run_study(study, model, poses, {1, {}, {}}).value();
  const auto& found = result.as<coupling::Result>();
  const auto sum_at = [](double pose) { return (1.0 + pose + 1.0 - pose + 2.0 + pose + 2.0 - pose) * kSize; };
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_NEAR(found.first_order_sum(0, 0, 2, m), sum_at(poses[PoseIndex(m)][0]), 1e-17);
    EXPECT_NEAR(found.worst_case(0, 0, 2, m), found.first_order_sum(0, 0, 2, m), 1e-17) << "it is linear";
    EXPECT_GT(found.corners(0, 2, m), 4u);
  }
  EXPECT_NEAR(found.worst_case_max(0, 0, 0), 2.0 * kSize, 1e-17) << "1 + pose and 1 - pose";
  EXPECT_GE(found.worst_case_max_pose(0, 0, 2), 0);
  const std::span<const std::int64_t> signs = found.worst_case_signs.row(0, 0, 2);
  const std::int64_t side = signs.front();
  EXPECT_EQ(std::vector(signs.begin(), signs.end()), (std::vector<std::int64_t>{side, -side, side, -side}));
  EXPECT_EQ(elements(found.unsolved_pose), (std::vector<std::int64_t>{-1, -1, 0}));
  const std::span<const std::int64_t> unsolved = found.unsolved_signs.row(0, 2);
  EXPECT_EQ(std::vector(unsolved.begin(), unsolved.end()), (std::vector<std::int64_t>{1, 1, 1, 1}));
  EXPECT_EQ(found.total().not_converged(), found.solves(0, 0).not_converged() * 3);
}

}  // namespace
}  // namespace poesy::test
