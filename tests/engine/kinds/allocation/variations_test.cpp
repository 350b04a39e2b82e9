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

// Recomputes the load of each machine s in a loop over the poses, with the random numbers at the addresses (seed,
// purpose, error, pose, sample) that theory.md defines.
TEST(MachineLoads, AreThoseOfErrorsDrawnAnewAtEachPose) {
  VariedStudy study;
  study.study.errors.per_pose = {FactorIndex(0), FactorIndex(2)};
  const Plan plan = study.plan();
  const auto found = allocation::machine_loads(plan, study.model, study.study.analysis.limits, {.threads = 2});
  for (std::size_t s = 0; s < 450; ++s) {
    double load = 0.0;
    for (std::size_t m = 0; m < kPlaces.size(); ++m) {
      std::array<double, kErrors> x{};
      for (std::size_t p = 0; p < kErrors; ++p) {
        const PoseIndex pose(p == 0 || p == 2 ? m : 0);
        fill_uniforms({study.study.seed, Purpose::error_samples, FactorIndex(p), pose}, SampleIndex(s),
                      std::span(x).subspan(p, 1));
        x[p] = Distribution::normal(0.3).quantile(x[p]);
      }
      std::array<double, 2> y{};
      function(x, kPlaces[m], y);
      load = std::max({load, std::abs(y[0]), std::abs(y[1])});
    }
    EXPECT_NEAR(found->load[s], load, 1e-12) << s;
  }
}

TEST(TryVariations, GiveTheSameOnAnyNumberOfThreads) {
  const VariedStudy study;
  EXPECT_EQ(study.varied(variations(), 1), study.varied(variations(), 3));
}

TEST(TryVariations, NoneAreNone) { EXPECT_TRUE(VariedStudy().varied({}).empty()); }

}  // namespace
}  // namespace poesy::test
