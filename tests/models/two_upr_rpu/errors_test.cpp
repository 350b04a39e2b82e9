#include "models/two_upr_rpu/errors.h"

#include <gtest/gtest.h>

#include <set>

#include "models/two_upr_rpu/model.h"

namespace poesy::two_upr_rpu {
namespace {

std::vector<std::string> names_of(const std::string& set_name) {
  const ModelDescription description = catalog_entry().description;
  const FactorSet* set = description.find_set(set_name);
  std::vector<std::string> names;
  for (const FactorIndex factor : set->factors) names.push_back(description.factors[factor.value].name);
  return names;
}

std::set<std::string> unique(const std::vector<std::string>& names) { return {names.begin(), names.end()}; }

TEST(Errors, AreTheNinetyWithoutThoseThePaperExcludes) {
  // Du et al. 2022, Section 3.2: 12 initial displacements, then 7 that vanish by the definition of the frames.
  const std::set<std::string> excluded{
      "epsilon_1_0_x", "epsilon_1_1_y", "delta_1_3_z", "epsilon_1_3_x", "epsilon_2_0_x", "epsilon_2_1_y", "delta_2_3_z",
      "epsilon_2_3_x", "epsilon_3_0_x", "delta_3_2_z", "epsilon_3_2_x", "epsilon_3_3_y", "delta_1_2_x",   "delta_2_2_x",
      "epsilon_1_4_y", "epsilon_2_4_y", "delta_3_1_x", "epsilon_3_3_z", "epsilon_3_4_y"};
  ASSERT_EQ(excluded.size(), 19u);
  std::set<std::string> expected;
  for (const char* kind : {"delta", "epsilon"}) {
    for (int i = 1; i <= 3; ++i) {
      for (int j = 0; j <= 4; ++j) {
        for (const char axis : {'x', 'y', 'z'}) {
          const std::string name = std::string(kind) + "_" + std::to_string(i) + "_" + std::to_string(j) + "_" + axis;
          if (!excluded.contains(name)) expected.insert(name);
        }
      }
    }
  }
  const std::vector<std::string> all = names_of("all");
  EXPECT_EQ(all.size(), 71u);
  EXPECT_EQ(unique(all), expected);
}

TEST(Errors, SlotsSayWhatTheNamesSay) {
  const std::vector<Factor> list = factors();
  const std::vector<chain::ErrorTerms> terms = error_terms();
  ASSERT_EQ(list.size(), terms.size());
  for (std::size_t f = 0; f < list.size(); ++f) {
    const bool linear = list[f].dimension == Dimension::length;
    const std::string name = std::string(linear ? "delta_" : "epsilon_") + std::to_string(terms[f].front().limb + 1) +
                             "_" + std::to_string(terms[f].front().frame) + "_" + "xyz"[terms[f].front().component % 3];
    EXPECT_EQ(list[f].name, name);
    EXPECT_EQ(linear, terms[f].front().component >= 3);
    EXPECT_EQ(list[f].limb, terms[f].front().limb + 1);
  }
}

TEST(Errors, DeformingSetIsNumberedAsInThePaper) {
  const std::vector<std::string> names = names_of("deforming");
  ASSERT_EQ(names.size(), 25u);
  // The numbers Ge_p that Section 6.2 gives in passing.
  EXPECT_EQ(names[0], "delta_1_0_y");
  EXPECT_EQ(names[4], "delta_1_1_y");
  EXPECT_EQ(names[6], "epsilon_1_1_z");
  EXPECT_EQ(names[7], "delta_1_2_z");
  EXPECT_EQ(names[10], "delta_1_3_x");
  EXPECT_EQ(names[13], "delta_1_4_y");
  EXPECT_EQ(names[15], "epsilon_1_4_z");
  EXPECT_EQ(names[16], "epsilon_3_0_y");
  EXPECT_EQ(names[24], "epsilon_3_4_z");
}

TEST(Errors, SetsPartitionTheWhole) {
  const std::vector<std::string> deforming = names_of("deforming-all");
  const std::vector<std::string> benign = names_of("benign");
  EXPECT_EQ(deforming.size(), 41u);
  EXPECT_EQ(benign.size(), 30u);
  std::set<std::string> both = unique(deforming);
  both.insert(benign.begin(), benign.end());
  EXPECT_EQ(both, unique(names_of("all")));
}

TEST(Errors, LimbTwoDeformsAsLimbOne) {
  std::set<std::string> first, second;
  for (const std::string& name : names_of("deforming-all")) {
    const auto limb = name.find('_') + 1;
    std::string mirrored = name;
    mirrored[limb] = '2';
    if (name[limb] == '1') first.insert(mirrored);
    if (name[limb] == '2') second.insert(name);
  }
  EXPECT_EQ(first, second);
  EXPECT_EQ(first.size(), 16u);
}

}  // namespace
}  // namespace poesy::two_upr_rpu
