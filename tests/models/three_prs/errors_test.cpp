#include "models/three_prs/errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "tests/models/three_prs/reference.h"

namespace poesy::three_prs {
namespace {

const ModelDescription kModel = catalog_entry().description;

std::size_t size_of(const char* set) { return kModel.find_set(set)->factors.size(); }

std::set<std::size_t> members(const char* set) {
  std::set<std::size_t> places;
  for (const FactorIndex factor : kModel.find_set(set)->factors) places.insert(factor.value);
  return places;
}

TEST(Factors, AreTheSixtySourcesInTheOrderOfTheOracle) {
  const nlohmann::json& names = oracle().at("names");
  const std::vector<Factor> list = factors();
  ASSERT_EQ(list.size(), kFactors);
  ASSERT_EQ(names.size(), kSources);
  for (std::size_t f = 0; f < kFactors; ++f) {
    // "dax" is a_x, "tPx" is theta_Bp_x, "dq" is q.
    const std::string text = names[f % kSources];
    std::string expected = text[0] == 'd'   ? text.substr(1, 1)
                           : text[1] == 'P' ? "theta_Bp"
                                            : "theta_" + text.substr(1, 1);
    if (text.size() == 3) expected += "_" + text.substr(2);
    EXPECT_EQ(list[f].name, expected + "_" + std::to_string(f / kSources + 1));
    EXPECT_EQ(list[f].dimension, text[0] == 'd' ? Dimension::length : Dimension::angle);
    EXPECT_EQ(list[f].limb, f / kSources + 1);
  }
}

TEST(Factors, FramesGroupTheSources) {
  for (const Factor& factor : factors()) {
    constexpr std::array kGroups{"a_", "q_", "theta_A_", "b_", "theta_B_", "theta_Bp_", "l_", "c_"};
    EXPECT_TRUE(factor.name.starts_with(kGroups.at(factor.frame))) << factor.name;
  }
}

TEST(Sources, StandWhereTheirNamesAre) {
  for (std::size_t limb = 0; limb < kLimbs; ++limb) {
    const std::string number = std::to_string(limb + 1);
    for (const auto& [source, name] :
         {std::pair(Source::a, "a_x_"), std::pair(Source::q, "q_"), std::pair(Source::theta_A, "theta_A_x_"),
          std::pair(Source::b, "b_x_"), std::pair(Source::theta_B, "theta_B_x_"),
          std::pair(Source::theta_Bp, "theta_Bp_x_"), std::pair(Source::l, "l_"), std::pair(Source::c, "c_x_")}) {
      EXPECT_EQ(kModel.find_factor(name + number)->value, factor_of(limb, source));
    }
  }
}

TEST(FactorSets, HaveThePapersSizes) {
  EXPECT_EQ(size_of("all"), 51u);
  EXPECT_EQ(size_of("compensable"), 30u);  // 24 with c as a scalar
  EXPECT_EQ(size_of("non-compensable"), 21u);
  EXPECT_EQ(size_of("platform-hinges"), 18u);
  EXPECT_EQ(size_of("initial-position"), 3u);
  EXPECT_EQ(size_of("revolute-gap"), 9u);
  EXPECT_EQ(size_of("rod-length"), 3u);
}

TEST(FactorSets, CompensableAndNonCompensablePartitionAll) {
  std::set<std::size_t> both = members("compensable");
  both.merge(members("non-compensable"));
  EXPECT_EQ(both, members("all"));
}

TEST(FactorSets, AllIsWhatHasAnEffect) {
  const nlohmann::json& mapping = oracle().at("G");
  for (std::size_t f = 0; f < kFactors; ++f) {
    const bool effect =
        std::ranges::any_of(mapping, [&](const auto& row) { return row[f].template get<double>() != 0.0; });
    EXPECT_EQ(members("all").contains(f), effect) << kModel.factors[f].name;
  }
}

TEST(FactorSets, SeparationFollowsTheRowsOfTheMapping) {
  // Section 4.2: compensable sources enter drive rows only, non-compensable ones constraint rows only; c enters both.
  const nlohmann::json& mapping = oracle().at("G");
  const auto enters = [&](std::size_t f, std::size_t first_row) {
    return std::any_of(mapping.begin() + static_cast<std::ptrdiff_t>(first_row),
                       mapping.begin() + static_cast<std::ptrdiff_t>(first_row) + 3,
                       [&](const auto& row) { return row[f].template get<double>() != 0.0; });
  };
  for (const std::size_t f : members("compensable")) {
    EXPECT_TRUE(enters(f, 0));
    EXPECT_EQ(enters(f, 3), kModel.factors[f].name.starts_with("c_"));
  }
  for (const std::size_t f : members("non-compensable")) {
    EXPECT_FALSE(enters(f, 0));
    EXPECT_TRUE(enters(f, 3));
  }
}

TEST(ErrorBound, IsThePartThatTheErrorBelongsTo) {
  const auto model = published("exact");
  const Geometry geometry;
  for (std::size_t f = 0; f < kFactors; ++f) {
    const std::string& name = model->description().factors[f].name;
    const ErrorBound bound = model->error_bound(FactorIndex(f));
    const double expected = name.starts_with("theta") ? std::numbers::pi
                            : name.starts_with("a_")  ? geometry.a
                            : name.starts_with("q_")  ? geometry.rail
                            : name.starts_with("c_")  ? geometry.c
                                                      : geometry.l;
    EXPECT_EQ(bound.size, expected) << name;
    EXPECT_FALSE(bound.part.empty());
  }
}

}  // namespace
}  // namespace poesy::three_prs
