#include "engine/kinds/sobol/groups.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/kinds/sobol/kind.h"
#include "tests/support/function_model.h"

namespace poesy::test {
namespace {

/// The names of the groups for errors x1 to x4 of the limbs 1, 1, 2, 2 and the frames 0, 1, 0, 1.
std::vector<std::string> groups_of(sobol::GroupsBy by, std::vector<sobol::NamedGroup> named = {}) {
  const FunctionModel model(4, {"y"}, [](std::span<const double>, double, std::span<double>) {});
  const CatalogEntry entry{model.description(), nullptr};
  Study study = function_study(entry, sobol::kStudy, Distribution::normal(1.0), 100);
  sobol::Options& asked = asked_of<sobol::Options>(study.analysis);
  asked.groups_by = by;
  asked.named_groups = std::move(named);
  std::vector<std::string> list;
  for (const sobol::ErrorGroup& group : sobol::error_groups(study.analysis, study.model())) {
    list.push_back(group.name + ":");
    for (const std::size_t p : group.members) list.back() += " x" + std::to_string(p + 1);
  }
  return list;
}

using Texts = std::vector<std::string>;

TEST(ErrorGroups, AreTheErrorsWhereNoneAreJoined) {
  EXPECT_EQ(groups_of(sobol::GroupsBy::none), (Texts{"x1: x1", "x2: x2", "x3: x3", "x4: x4"}));
}

TEST(ErrorGroups, AreLimbsOrTheirFrames) {
  EXPECT_EQ(groups_of(sobol::GroupsBy::limb), (Texts{"limb 1: x1 x2", "limb 2: x3 x4"}));
  EXPECT_EQ(groups_of(sobol::GroupsBy::frame),
            (Texts{"limb 1 frame 0: x1", "limb 1 frame 1: x2", "limb 2 frame 0: x3", "limb 2 frame 1: x4"}));
}

TEST(ErrorGroups, HaveTheNamesOfTheStudyAndWhatIsLeft) {
  EXPECT_EQ(groups_of(sobol::GroupsBy::name, {{"late", {"x4"}}, {"early", {"x1", "x2"}}}),
            (Texts{"late: x4", "early: x1 x2", "others: x3"}));
  EXPECT_EQ(groups_of(sobol::GroupsBy::name, {{"odd", {"x[13]", "x1", "x3"}}, {"even", {"x2", "x4"}}}),
            (Texts{"odd: x1 x3", "even: x2 x4"}));
}

TEST(SignedVectors, AreTriplesOfResponsesAndPartsOfDetails) {
  ModelDescription model;
  for (const char* name : {"gap", "x", "y", "z", "theta_x", "theta_y", "theta_z", "tip_x", "tip_y"}) {
    model.responses.push_back({name, Dimension::length, ""});
  }
  model.details = {{"delta", {"omega_x", "omega_y", "omega_z", "v_x", "v_y", "v_z"}, "rad,rad,rad,m,m,m", ""},
                   {"whole", {"a", "b"}, "m", ""}};
  const std::vector<sobol::SignedVector> vectors = sobol::signed_vectors(model);
  ASSERT_EQ(vectors.size(), 5u);
  EXPECT_EQ(vectors[0].name, "displacement");
  EXPECT_EQ(vectors[0].components, (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_EQ(vectors[1].name, "theta");
  EXPECT_EQ(vectors[2].name, "delta_omega");
  EXPECT_EQ(vectors[2].components, (std::vector<std::size_t>{9, 10, 11}));
  EXPECT_EQ(vectors[3].name, "delta_v");
  EXPECT_EQ(vectors[4].name, "whole");
  EXPECT_EQ(vectors[4].components, (std::vector<std::size_t>{15, 16}));
}

}  // namespace
}  // namespace poesy::test
