#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/identification/identification.h"
#include "engine/run/evaluation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "models/three_prs/model.h"

namespace poesy::three_prs {
namespace {

using Choice = coupling::ErrorPattern::Choice;

const ModelDescription kModel = catalog_entry().description;
const PoseSet kPoses(3, {0.0, 0.0, 0.8, 0.2, -0.1, 0.7, -0.3, 0.25, 0.95});
constexpr std::size_t kExact = 0;
constexpr std::size_t kFirstOrder = 1;

std::unique_ptr<Model> build(std::size_t fidelity) {
  const CatalogEntry entry = catalog_entry();
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  return entry.build(geometry, fidelity);
}

coupling::Options study(const coupling::ErrorPattern& pattern, std::vector<double> sizes) {
  coupling::Options some{std::move(sizes), {}, pattern, {}};
  for (const SourceSet& source : kModel.sources) {
    some.sources.push_back({source.name, kModel.find_set(source.set)->factors});
  }
  return some;
}

coupling::Result solve(const Model& model, const coupling::Options& some) {
  const auto evaluation = run_evaluation(model, {}, kPoses, coupling::coupling_table(some, kModel),
                                         Pairing::every_pose_with_every_row, {1, {}, {}}, Outcomes::responses);
  return coupling::coupling_result(*evaluation, some, kModel, NotConverged::exclude,
                                   coupling::coupling_rounding(some, model));
}

TEST(LiteratureSources, AreFactorSetsThatDoNotOverlap) {
  ASSERT_EQ(kModel.sources.size(), 4u);
  std::set<FactorIndex> seen;
  std::size_t count = 0;
  for (const SourceSet& source : kModel.sources) {
    const FactorSet* set = kModel.find_set(source.set);
    ASSERT_NE(set, nullptr) << source.name;
    seen.insert(set->factors.begin(), set->factors.end());
    count += set->factors.size();
  }
  EXPECT_EQ(seen.size(), count);
}

/// Computes effects directly with the evaluator, with one solve for each set of errors.
class ByHand {
 public:
  ByHand(const Model& model, double size) : evaluator_(model.evaluator({})), size_(size) {}

  /// The effect on one response at pose m if all errors with belongs(source name, error) have the given size.
  template <class Belongs>
  double effect(std::size_t response, std::size_t m, const Belongs& belongs) {
    std::vector<double> errors(kModel.factors.size(), 0.0);
    for (const SourceSet& source : kModel.sources) {
      for (const FactorIndex factor : kModel.find_set(source.set)->factors) {
        if (belongs(source.name, kModel.factors[factor.value])) errors[factor.value] = size_;
      }
    }
    std::vector<double> responses(kModel.responses.size());
    SolveStatus status{};
    std::uint32_t iterations = 0;
    evaluator_->evaluate({kPoses[PoseIndex(m)], errors, {}, {}, 1},
                         {responses, std::span(&status, 1), std::span(&iterations, 1), {}});
    EXPECT_TRUE(solved(status));
    return responses[response];
  }

 private:
  std::unique_ptr<Evaluator> evaluator_;
  double size_;
};

bool takes(const coupling::ErrorPattern& pattern, const Factor& factor) {
  const bool limb = pattern.limbs != Choice::some || factor.limb == pattern.limb;
  const bool axis =
      pattern.components != Choice::some || factor.axis.empty() || factor.axis == "x" || factor.axis == "z";
  return limb && axis;
}

/// Whether two errors of one source are in the same block of the pattern, so that they move together.
bool together(const coupling::ErrorPattern& pattern, const Factor& a, const Factor& b) {
  return (pattern.limbs != Choice::independent || a.limb == b.limb) &&
         (pattern.components != Choice::independent || (a.axis == b.axis && a.frame == b.frame));
}

void expect_by_hand(const Model& model, const coupling::ErrorPattern& pattern) {
  constexpr double kSize = 3e-4;
  const coupling::Result found = solve(model, study(pattern, {kSize}));
  ByHand by_hand(model, kSize);
  const std::size_t poses = kPoses.size();
  for (std::size_t r = 0; r < kModel.responses.size(); ++r) {
    for (std::size_t m = 0; m < poses; ++m) {
      const auto own = [&](const std::string& name) {
        return by_hand.effect(r, m, [&](const std::string& source, const Factor& factor) {
          return source == name && takes(pattern, factor);
        });
      };
      const double fs = own("FS"), t = own("T"), q = own("R"), l = own("L");
      double worst = 0.0;
      double squares = 0.0;
      for (const SourceSet& source : kModel.sources) {
        std::vector<const Factor*> blocks;  // the first error of each block
        for (const FactorIndex index : kModel.find_set(source.set)->factors) {
          const Factor& factor = kModel.factors[index.value];
          const bool is_new =
              std::ranges::none_of(blocks, [&](const Factor* first) { return together(pattern, *first, factor); });
          if (takes(pattern, factor) && is_new) blocks.push_back(&factor);
        }
        for (const Factor* first : blocks) {
          const double alone = by_hand.effect(r, m, [&](const std::string& name, const Factor& factor) {
            return name == source.name && takes(pattern, factor) && together(pattern, *first, factor);
          });
          worst += std::abs(alone);
          squares += alone * alone;
        }
      }
      const double all = by_hand.effect(r, m, [&](auto&, const Factor& factor) { return takes(pattern, factor); });
      const double fs_r = by_hand.effect(r, m, [&](const std::string& source, const Factor& factor) {
        return (source == "FS" || source == "R") && takes(pattern, factor);
      });
      constexpr double kRounding = 1e-15;
      EXPECT_NEAR(found.effect(r, 0, 0, m), fs, kRounding);
      EXPECT_NEAR(found.effect(r, 0, 5, m), fs_r, kRounding);  // 5: FS+R, after FS, T, R, L, FS+T
      EXPECT_NEAR(found.effect(r, 0, 14, m), all, kRounding);
      EXPECT_NEAR(found.sum(r, 0, 14, m), fs + t + q + l, kRounding);
      EXPECT_NEAR(found.interaction(r, 0, 14, m), all - (fs + t + q + l), 2 * kRounding);
      EXPECT_NEAR(found.first_order_sum(r, 0, 14, m), worst, 10 * kRounding);
      EXPECT_NEAR(found.root_sum_square(r, 0, 14, m), std::sqrt(squares), 10 * kRounding);
    }
  }
}

TEST(Coupling, IsWhatSolvesByHandGiveForEveryPattern) {
  for (const std::size_t fidelity : {kExact, kFirstOrder}) {
    const std::unique_ptr<Model> model = build(fidelity);
    for (const Choice limbs : {Choice::all, Choice::some, Choice::independent}) {
      for (const Choice components : {Choice::all, Choice::some, Choice::independent}) {
        const bool some = components == Choice::some;
        expect_by_hand(*model, {limbs, limbs == Choice::some ? 2u : 0u, components,
                                some ? std::vector<std::string>{"x", "z"} : std::vector<std::string>{}});
      }
    }
  }
}

/// The largest |interaction| and the largest |effect| over all subsets and poses, for responses that are components,
/// not norms (m, rad).
std::pair<double, double> largest_of_components(const coupling::Result& found) {
  double interaction = 0.0;
  double effect = 0.0;
  for (std::size_t r = 0; r < kModel.responses.size(); ++r) {
    const std::string& name = kModel.responses[r].name;
    if (name != "x" && name != "y" && name != "z" && !name.starts_with("tip_") && !name.starts_with("theta_")) continue;
    if (name == "tip_position") continue;
    interaction = std::max(interaction, std::ranges::max(found.interaction_max.row(r)));
    effect = std::max(effect, std::ranges::max(found.effect_max.row(r)));
  }
  return {interaction, effect};
}

TEST(Coupling, IsSuperpositionToFirstOrder) {
  const auto [interaction, effect] = largest_of_components(solve(*build(kFirstOrder), study({}, {1e-4, 5e-4})));
  EXPECT_GT(effect, 1e-4);
  EXPECT_LT(interaction, 1e-15);
}

TEST(Coupling, DiffersFromSuperpositionInSecondOrder) {
  const std::unique_ptr<Model> exact = build(kExact);
  const auto [fine, fine_effect] = largest_of_components(solve(*exact, study({}, {1e-4})));
  const auto [coarse, coarse_effect] = largest_of_components(solve(*exact, study({}, {2e-4})));
  EXPECT_GT(fine, 1e-9);
  EXPECT_LT(fine, 5e-3 * fine_effect);
  EXPECT_NEAR(coarse / fine, 4.0, 0.05);
  EXPECT_NEAR(coarse_effect / fine_effect, 2.0, 0.01);
}

}  // namespace
}  // namespace poesy::three_prs
