// Loads of machines with one tolerance changed are those of a study with that tolerance.

#include "engine/kinds/allocation/variations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "engine/kinds/allocation/machine_loads.h"
#include "engine/kinds/allocation/result.h"
#include "engine/study/poses/pose_selection.h"
#include "tests/support/function_model.h"

namespace poesy::test {
namespace {

constexpr std::size_t kErrors = 4;
const std::vector<double> kPlaces{0.0, 0.2, 0.4, 0.6, 0.8, 1.0};

/// Each error acts most at another place, and the last one hardly at all.
void function(std::span<const double> x, double place, std::span<double> y) {
  y[0] = x[0] * (1.0 + place) + 2.0 * x[1] * (1.0 - place) + 3.0 * x[2] * place * (1.0 - place) + 1e-3 * x[3];
  y[1] = 5.0 * x[0] * x[1];
}

struct VariedStudy {
  VariedStudy() : model(kErrors, {"y", "z"}, function), entry{model.description(), nullptr} {
    study = function_study(entry, kAllocationStudy, Distribution::normal(0.3), 450);
    study.analysis.draws = Draws::per_machine;
    study.analysis.limits = {{0, 1.0}, {1, 1.0}};
  }
  Plan plan() const { return Plan(study, PoseSet(1, kPlaces)); }
  std::vector<double> varied(const std::vector<Variation>& variations, std::size_t threads = 2) const {
    std::vector<std::uint32_t> machines;
    for (std::uint32_t s = 0; s < 450; s += 2) machines.push_back(s);
    return *try_variations(plan(), model, study.analysis.limits, machines, variations, {.threads = threads});
  }

  FunctionModel model;
  CatalogEntry entry;
  Study study;
};

std::vector<Variation> variations() {
  std::vector<Variation> list;
  for (std::size_t p = 0; p < kErrors; ++p) {
    for (const double factor : {1.05, 2.0}) list.push_back({{p}, factor});
  }
  list.push_back({{0, 1, 2, 3}, -1.0});
  list.push_back({{1, 3}, 1.05});
  return list;
}

TEST(TryVariations, ChangesErrorsAsATolerance) {
  const VariedStudy study;
  const std::vector<Variation> list = variations();
  const std::vector<double> found = study.varied(list);
  ASSERT_EQ(found.size(), list.size() * 225);
  for (std::size_t v = 0; v < list.size(); ++v) {
    VariedStudy other;
    for (const std::size_t p : list[v].errors) {
      other.study.errors.by_factor[p] = Distribution::normal(0.3 * std::abs(list[v].factor));
    }
    const auto whole = machine_loads(other.plan(), other.model, other.study.analysis.limits, {.threads = 1});
    // Without signs: the function has none where all errors are mirrored.
    for (std::size_t k = 0; k < 225; ++k) EXPECT_NEAR(found[v * 225 + k], whole->load[2 * k], 1e-9) << v;
  }
}

TEST(TryVariations, GiveTheSameOnAnyNumberOfThreads) {
  const VariedStudy study;
  EXPECT_EQ(study.varied(variations(), 1), study.varied(variations(), 3));
}

TEST(TryVariations, NoneAreNone) { EXPECT_TRUE(VariedStudy().varied({}).empty()); }

}  // namespace
}  // namespace poesy::test
