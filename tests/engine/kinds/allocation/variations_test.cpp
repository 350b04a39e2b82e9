// The loads of machines with a changed tolerance equal those of a study with this tolerance.

#include "engine/kinds/allocation/variations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "engine/kinds/allocation/machine_loads.h"
#include "engine/kinds/allocation/result.h"
#include "engine/random/stream.h"
#include "engine/study/poses/pose_selection.h"
#include "tests/support/function_model.h"

namespace poesy::test {
namespace {

constexpr std::size_t kErrors = 4;
const std::vector<double> kPlaces{0.0, 0.2, 0.4, 0.6, 0.8, 1.0};

/// The first three errors have their largest effect at different places; the fourth has almost none.
void function(std::span<const double> x, double place, std::span<double> y) {
  y[0] = x[0] * (1.0 + place) + 2.0 * x[1] * (1.0 - place) + 3.0 * x[2] * place * (1.0 - place) + 1e-3 * x[3];
  y[1] = 5.0 * x[0] * x[1];
}

struct VariedStudy {
  VariedStudy() : model(kErrors, {"y", "z"}, function), entry{model.description(), nullptr} {
    study = function_study(entry, allocation::kStudy, Distribution::normal(0.3), 450);
    study.analysis.draws = Draws::per_machine;
    study.analysis.limits = {{0, 1.0}, {1, 1.0}};
  }
  Plan plan() const { return Plan(study, PoseSet(1, kPlaces)); }
  std::vector<double> varied(const std::vector<allocation::Variation>& variations, std::size_t threads = 2) const {
    std::vector<std::uint32_t> machines;
    for (std::uint32_t s = 0; s < 450; s += 2) machines.push_back(s);
    return *allocation::try_variations(plan(), model, study.analysis.limits, machines, variations,
                                       {.threads = threads});
  }

  FunctionModel model;
  CatalogEntry entry;
  Study study;
};

std::vector<allocation::Variation> variations() {
  std::vector<allocation::Variation> list;
  for (std::size_t p = 0; p < kErrors; ++p) {
    for (const double factor : {1.05, 2.0}) list.push_back({{p, factor}});
  }
  list.push_back({{0, -1.0}, {1, -1.0}, {2, -1.0}, {3, -1.0}});
  list.push_back({{1, 1.05}, {3, 1.05}});
  return list;
}

TEST(TryVariations, ChangesErrorsAsATolerance) {
  const VariedStudy study;
  const std::vector<allocation::Variation> list = variations();
  const std::vector<double> found = study.varied(list);
  ASSERT_EQ(found.size(), list.size() * 225);
  for (std::size_t v = 0; v < list.size(); ++v) {
    VariedStudy other;
    for (const auto& [p, factor] : list[v]) {
      other.study.errors.by_factor[p] = Distribution::normal(0.3 * std::abs(factor));
    }
    const auto whole =
        allocation::machine_loads(other.plan(), other.model, other.study.analysis.limits, {.threads = 1});
    // The factor -1 for all errors leaves the loads as they are, because y changes only its sign and z is unchanged.
    for (std::size_t k = 0; k < 225; ++k) EXPECT_NEAR(found[v * 225 + k], whole->load[2 * k], 1e-9) << v;
  }
}

TEST(TryVariations, KeepErrorsThatAreDrawnAnewAtEachPose) {
  VariedStudy study;
  study.study.errors.per_pose = {FactorIndex(2)};
  const std::vector<allocation::Variation> list{{{0, 1.05}}, {{0, 2.0}, {1, 1.5}}, {{1, 1.05}, {3, 1.05}}};
  const std::vector<double> found = study.varied(list);
  for (std::size_t v = 0; v < list.size(); ++v) {
    VariedStudy other;
    other.study.errors.per_pose = study.study.errors.per_pose;
    for (const auto& [p, factor] : list[v]) {
      other.study.errors.by_factor[p] = Distribution::normal(0.3 * factor);
    }
    const auto whole =
        allocation::machine_loads(other.plan(), other.model, other.study.analysis.limits, {.threads = 1});
    for (std::size_t k = 0; k < 225; ++k) EXPECT_NEAR(found[v * 225 + k], whole->load[2 * k], 1e-9) << v;
  }
}

/// The responses of machine s at each pose, with the random numbers at the addresses (seed, purpose, error, pose,
/// sample) that theory.md defines.
std::vector<std::array<double, 2>> responses_of(const Study& study, std::size_t s) {
  std::vector<std::array<double, 2>> list;
  for (std::size_t m = 0; m < kPlaces.size(); ++m) {
    std::array<double, kErrors> x{};
    for (std::size_t p = 0; p < kErrors; ++p) {
      const bool anew = std::ranges::find(study.errors.per_pose, FactorIndex(p)) != study.errors.per_pose.end();
      fill_uniforms({study.seed, Purpose::error_samples, FactorIndex(p), PoseIndex(anew ? m : 0)}, SampleIndex(s),
                    std::span(x).subspan(p, 1));
      x[p] = Distribution::normal(0.3).quantile(x[p]);
    }
    function(x, kPlaces[m], list.emplace_back());
  }
  return list;
}

using Near = Array<std::uint64_t, axis::Limit, axis::Pose>;

TEST(MachineLoads, AreThoseOfErrorsDrawnAnewAtEachPose) {
  VariedStudy study;
  study.study.errors.per_pose = {FactorIndex(0), FactorIndex(2)};
  const Plan plan = study.plan();
  const auto found = allocation::machine_loads(plan, study.model, study.study.analysis.limits, {.threads = 2});
  Near near({2, kPlaces.size()});
  for (std::size_t s = 0; s < 450; ++s) {
    double load = 0.0;
    std::uint64_t* deciding = nullptr;
    const auto list = responses_of(study.study, s);
    for (std::size_t m = 0; m < kPlaces.size(); ++m) {
      for (std::size_t k = 0; k < 2; ++k) {
        if (std::abs(list[m][k]) <= load) continue;
        load = std::abs(list[m][k]);
        deciding = &near(k, m);
      }
    }
    EXPECT_NEAR(found->load[s], load, 1e-12) << s;
    if (std::abs(load - 1.0) <= allocation::kNearLimit) ++*deciding;
  }
  EXPECT_EQ(found->near, near);
  EXPECT_GT(std::accumulate(near.begin(), near.end(), std::uint64_t{0}), 20U);
}

TEST(MachineLoads, OfALimitOverThePosesDecideAtPose0) {
  VariedStudy study;
  study.study.analysis.limits = {{0, ValueLimit::of_spread(1.5)}, {1, 1.0}};
  Near near({2, kPlaces.size()});
  for (std::size_t s = 0; s < 450; ++s) {
    const auto list = responses_of(study.study, s);
    const auto by_y = [](const auto& one, const auto& other) { return one[0] < other[0]; };
    const auto [least, most] = std::ranges::minmax_element(list, by_y);
    const double spread = ((*most)[0] - (*least)[0]) / 1.5;
    const double load = std::max(spread, std::abs(list.front()[1]));  // z is the same at all poses
    if (std::abs(load - 1.0) > allocation::kNearLimit) continue;
    ++near(load == spread ? 0 : 1, 0);
  }
  for (const std::size_t threads : {1U, 3U}) {
    const auto found =
        allocation::machine_loads(study.plan(), study.model, study.study.analysis.limits, {.threads = threads});
    EXPECT_EQ(found->near, near) << threads;
  }
  EXPECT_GT(near(0, 0), 1U);
  EXPECT_GT(near(1, 0), 1U);
}

TEST(TryVariations, GiveTheSameOnAnyNumberOfThreads) {
  const VariedStudy study;
  EXPECT_EQ(study.varied(variations(), 1), study.varied(variations(), 3));
}

TEST(TryVariations, NoneAreNone) { EXPECT_TRUE(VariedStudy().varied({}).empty()); }

}  // namespace
}  // namespace poesy::test
