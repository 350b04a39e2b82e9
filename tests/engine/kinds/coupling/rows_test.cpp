#include "engine/kinds/coupling/coupling.h"
#include "engine/run/evaluation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace poesy::coupling {
namespace {

using Choice = ErrorPattern::Choice;

std::vector<FactorIndex> indices(std::initializer_list<std::size_t> places) {
  std::vector<FactorIndex> list;
  for (const std::size_t place : places) list.emplace_back(place);
  return list;
}

/// Two limbs with a vector a of two components, a scalar q and an angle t each: a_x, a_y, q, t_y.
ModelDescription model() {
  ModelDescription description;
  for (std::size_t limb = 1; limb <= 2; ++limb) {
    description.factors.push_back({"a_x", Dimension::length, limb, 0, "", "x"});
    description.factors.push_back({"a_y", Dimension::length, limb, 0, "", "y"});
    description.factors.push_back({"q", Dimension::length, limb, 1, ""});
    description.factors.push_back({"t_y", Dimension::angle, limb, 2, "", "y"});
  }
  return description;
}

Options study() {
  return {{1e-4, 3e-4}, {1e-3, 2e-3}, {}, {{"A", indices({4, 0, 1, 5, 2, 6})}, {"T", indices({3, 7})}}};
}

std::vector<ErrorBlock> blocks(ErrorPattern pattern) { return error_blocks(study().sources[0], pattern, model()); }

TEST(ErrorBlocks, AreOneWhereAllMoveTogether) {
  EXPECT_EQ(blocks({}), (std::vector<ErrorBlock>{indices({0, 1, 2, 4, 5, 6})}));
}

TEST(ErrorBlocks, KeepOneLimb) {
  EXPECT_EQ(blocks({Choice::some, 2, Choice::all, {}}), (std::vector<ErrorBlock>{indices({4, 5, 6})}));
  EXPECT_TRUE(blocks({Choice::some, 3, Choice::all, {}}).empty());
}

TEST(ErrorBlocks, KeepComponentsAndScalars) {
  EXPECT_EQ(blocks({Choice::all, 0, Choice::some, {"y"}}), (std::vector<ErrorBlock>{indices({1, 2, 5, 6})}));
  EXPECT_EQ(blocks({Choice::all, 0, Choice::some, {"z"}}), (std::vector<ErrorBlock>{indices({2, 6})}));
  const ErrorPattern only_z{Choice::all, 0, Choice::some, {"z"}};
  EXPECT_TRUE(error_blocks(study().sources[1], only_z, model()).empty());
}

TEST(ErrorBlocks, AreOneForEachLimb) {
  EXPECT_EQ(blocks({Choice::independent, 0, Choice::all, {}}),
            (std::vector<ErrorBlock>{indices({0, 1, 2}), indices({4, 5, 6})}));
  EXPECT_EQ(blocks({Choice::independent, 0, Choice::some, {"x"}}),
            (std::vector<ErrorBlock>{indices({0, 2}), indices({4, 6})}));
}

TEST(ErrorBlocks, AreOneForEachComponentOfEachVector) {
  EXPECT_EQ(blocks({Choice::all, 0, Choice::independent, {}}),
            (std::vector<ErrorBlock>{indices({0, 4}), indices({1, 5}), indices({2, 6})}));
  ModelDescription two_vectors = model();
  two_vectors.factors[2] = {"b_x", Dimension::length, 1, 1, "", "x"};
  two_vectors.factors[3] = {"t_x", Dimension::angle, 1, 0, "", "x"};
  EXPECT_EQ(error_blocks({"A", indices({0, 2, 3})}, {Choice::all, 0, Choice::independent, {}}, two_vectors),
            (std::vector<ErrorBlock>{indices({0}), indices({3}), indices({2})}));
}

TEST(ErrorBlocks, AreOneForEachLimbAndComponent) {
  EXPECT_EQ(
      blocks({Choice::independent, 0, Choice::independent, {}}),
      (std::vector<ErrorBlock>{indices({0}), indices({1}), indices({2}), indices({4}), indices({5}), indices({6})}));
}

TEST(SourceSubsets, StandByNumberThenInOrder) {
  EXPECT_EQ(source_subsets(3),
            (std::vector<std::vector<std::size_t>>{{0}, {1}, {2}, {0, 1}, {0, 2}, {1, 2}, {0, 1, 2}}));
  EXPECT_EQ(source_subsets(8).size(), 255u);
  EXPECT_TRUE(source_subsets(0).empty());
}

TEST(CouplingRows, HaveNoSetTwice) {
  for (const Choice limbs : {Choice::all, Choice::some, Choice::independent}) {
    for (const Choice components : {Choice::all, Choice::some, Choice::independent}) {
      Options some = study();
      some.pattern = {limbs, 2, components, {"y"}};
      const CouplingRows rows = coupling_rows(some, model());
      std::set<ErrorBlock> sets(rows.errors.begin(), rows.errors.end());
      EXPECT_EQ(sets.size(), rows.errors.size());
      for (std::size_t s = 0; s < 2; ++s) {
        const std::vector<ErrorBlock> own = error_blocks(some.sources[s], some.pattern, model());
        ASSERT_EQ(rows.block_rows[s].size(), own.size());
        for (std::size_t b = 0; b < own.size(); ++b) EXPECT_EQ(rows.errors[rows.block_rows[s][b]], own[b]);
      }
    }
  }
}

TEST(CouplingRows, AreSubsetsThenBlocks) {
  Options some = study();
  EXPECT_EQ(coupling_rows(some, model()).errors.size(), 3u);
  some.pattern.components = Choice::independent;  // A has three blocks (its components); T has only the component y
  const CouplingRows rows = coupling_rows(some, model());
  EXPECT_EQ(rows.errors.size(), 6u);
  EXPECT_EQ(rows.errors[2], indices({0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(rows.block_rows, (std::vector<std::vector<std::size_t>>{{3, 4, 5}, {1}}));
}

TEST(CouplingTable, HasTheSubsetsAtEachSize) {
  Options some = study();
  some.pattern = {Choice::some, 1, Choice::all, {}};
  const ErrorTable table = coupling_table(some, model());
  EXPECT_EQ(table.factors, indices({0, 1, 2, 3}));
  EXPECT_EQ(table.rows, 6u);
  EXPECT_EQ(table.values, (std::vector<double>{1e-4, 1e-4, 1e-4, 0.0, 0.0, 0.0, 0.0, 1e-3, 1e-4, 1e-4, 1e-4, 1e-3,
                                               3e-4, 3e-4, 3e-4, 0.0, 0.0, 0.0, 0.0, 2e-3, 3e-4, 3e-4, 3e-4, 2e-3}));
}

TEST(CouplingTable, NeedsNoSizeOfAnglesWhereThereIsNone) {
  Options lengths = study();
  lengths.angular.clear();
  lengths.sources = {{"X", indices({0, 4})}, {"Q", indices({2, 6})}};
  EXPECT_EQ(coupling_table(lengths, model()).rows, 6u);
}

}  // namespace
}  // namespace poesy::coupling
