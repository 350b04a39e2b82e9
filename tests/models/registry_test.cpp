#include "models/registry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <random>
#include <set>
#include <tuple>

#include "engine/kinds/study_file.h"
#include "engine/run/evaluation.h"
#include "engine/study/study_file.h"
#include "tests/support/kinds.h"

namespace poesy {
namespace {

/// A mechanism with one of its metrics (the entry) and one of its fidelities.
struct Choice {
  const CatalogEntry* entry;
  std::size_t fidelity;
};

void add_fidelities(const CatalogEntry& entry, std::vector<Choice>& list) {
  for (std::size_t f = 0; f < std::max<std::size_t>(entry.description.fidelities.size(), 1); ++f) {
    list.push_back({&entry, f});
  }
}

std::vector<Choice> choices() {
  std::vector<Choice> list;
  for (const CatalogEntry& entry : registry()) {
    add_fidelities(entry, list);
    if (entry.other_metric) add_fidelities(*entry.other_metric, list);
  }
  return list;
}

std::string name_of(const testing::TestParamInfo<Choice>& info) {
  const ModelDescription& model = info.param.entry->description;
  const std::string by = model.metric == "platform" ? "_w_" : "_";  // w: the platform metric W
  std::string name = model.name + by + std::to_string(info.param.fidelity);
  std::ranges::replace(name, '-', '_');
  return name;
}

/// Tests what every mechanism of the registry must satisfy (models/README.md).
class EveryMechanism : public testing::TestWithParam<Choice> {
 protected:
  static const ModelDescription& description() { return GetParam().entry->description; }

  static std::vector<double> published() {
    std::vector<double> geometry;
    for (const GeometryParameter& parameter : description().geometry) geometry.push_back(parameter.published);
    return geometry;
  }

  const std::unique_ptr<Model> model_ = GetParam().entry->build(published(), GetParam().fidelity);

  /// Reachable random poses in the described workspace. At least three of four drawn poses must be reachable.
  std::vector<std::vector<double>> poses() const {
    std::mt19937_64 random(20260101);
    std::vector<std::vector<double>> reachable;
    for (int k = 0; k < 40; ++k) {
      std::vector<double> pose;
      for (std::size_t c = 0; c < description().pose_coordinates.size(); ++c) {
        const double share = std::uniform_real_distribution<>(0.0, 1.0)(random);
        pose.push_back(std::lerp(description().pose_lower[c], description().pose_upper[c], share));
      }
      if (!model_->unreachable(pose)) reachable.push_back(pose);
    }
    EXPECT_GE(reachable.size(), 30u);
    return reachable;
  }
};

/// The outcomes of a block of samples.
struct Outcomes {
  std::vector<double> responses;  ///< [responses x samples]
  std::vector<SolveStatus> status;
  std::vector<std::uint32_t> iterations;
  std::vector<double> details;  ///< [components of all details x samples]
};

Outcomes solve(Evaluator& evaluator, const ModelDescription& model, std::span<const double> pose,
               std::span<const FactorIndex> varied, std::span<const double> values, std::size_t count) {
  const std::vector<double> none(model.factors.size(), 0.0);
  Outcomes found{std::vector<double>(model.responses.size() * count),
                 std::vector<SolveStatus>(count),
                 std::vector<std::uint32_t>(count),
                 {}};
  std::size_t components = 0;
  for (const Detail& detail : model.details) components += detail.components.size();
  found.details = std::vector<double>(components * count);
  evaluator.evaluate({pose, none, varied, values, count},
                     {found.responses, found.status, found.iterations, found.details});
  return found;
}

/// Expects different names that can be written without quotes in study files, tables and on the command line.
void expect_plain_and_different(const std::vector<std::string>& names) {
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const std::string& name : names) {
    EXPECT_FALSE(name.empty());
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-"),
              std::string::npos)
        << name;
  }
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& things) {
  std::vector<std::string> names;
  for (const Named& thing : things) names.push_back(thing.name);
  return names;
}

TEST_P(EveryMechanism, NamesThingsOnce) {
  const ModelDescription& model = description();
  expect_plain_and_different({model.name});
  expect_plain_and_different(names_of(model.geometry));
  expect_plain_and_different(names_of(model.pose_coordinates));
  expect_plain_and_different(names_of(model.responses));
  expect_plain_and_different(names_of(model.joints));
  expect_plain_and_different(names_of(model.charts));
  expect_plain_and_different(names_of(model.curves));
  // A case of errors may name errors, sets, linear and angular, so all these names must differ.
  std::vector<std::string> of_errors = names_of(model.factors);
  for (const std::string& set : names_of(model.factor_sets)) of_errors.push_back(set);
  of_errors.insert(of_errors.end(), {"linear", "angular"});
  expect_plain_and_different(of_errors);
}

/// Expects descriptions that are all different and consist of at least three words, without underscores as in names.
template <class Described>
void expect_words(const std::vector<Described>& things) {
  std::set<std::string> different;
  for (const Described& thing : things) {
    EXPECT_TRUE(different.insert(thing.description).second) << thing.name << " is described as another one";
    EXPECT_GE(std::ranges::count(thing.description, ' '), 2) << thing.name << ": " << thing.description;
    EXPECT_EQ(thing.description.find_first_of("_{}\"<>\n"), std::string::npos) << thing.name;
  }
}

TEST_P(EveryMechanism, DescribesWhatItHas) {
  expect_words(description().factors);
  expect_words(description().responses);
  for (const Factor& factor : description().factors) {
    // The description says how the error acts: along an axis for a length, about an axis for an angle.
    if (factor.axis.empty()) continue;
    const bool angle = factor.dimension == Dimension::angle;
    EXPECT_NE(factor.description.find(angle ? " about " : " along "), std::string::npos) << factor.description;
  }
}

TEST_P(EveryMechanism, SaysTheSameBeforeItIsBuilt) {
  EXPECT_EQ(model_->description().name, description().name);
  EXPECT_EQ(names_of(model_->description().factors), names_of(description().factors));
  EXPECT_EQ(names_of(model_->description().responses), names_of(description().responses));
  EXPECT_EQ(names_of(model_->description().joints), names_of(description().joints));
}

TEST_P(EveryMechanism, HasPositionsThatExist) {
  const ModelDescription& model = description();
  for (const FactorSet& set : model.factor_sets) {
    EXPECT_FALSE(set.factors.empty()) << set.name;
    EXPECT_TRUE(std::ranges::is_sorted(set.factors)) << set.name;
    for (const FactorIndex factor : set.factors) EXPECT_LT(factor.value, model.factors.size()) << set.name;
  }
  for (const std::size_t response : model.headline) EXPECT_LT(response, model.responses.size());
  for (const std::size_t response : model.signed_headline) EXPECT_LT(response, model.responses.size());
  if (model.deformation) {
    EXPECT_LT(model.deformation->response, model.responses.size());
  }
  for (const NamedCurve& curve : model.curves) {
    ASSERT_LT(curve.chart, model.charts.size()) << curve.name;
    EXPECT_EQ(curve.origin.size(), model.charts[curve.chart].coordinates.size()) << curve.name;
    EXPECT_EQ(curve.at(curve.start).size(), curve.origin.size()) << curve.name;
    EXPECT_LT(curve.start, curve.end) << curve.name;
  }
  if (model.separation) {
    EXPECT_EQ(model.separation->published.size(), model.factors.size());
  }
  for (const Factor& factor : model.factors) EXPECT_GE(factor.limb, 1u) << factor.name;
}

TEST_P(EveryMechanism, HasSourcesThatShareNothing) {
  std::set<std::size_t> taken;
  for (const SourceSet& source : description().sources) {
    ASSERT_NE(description().find_set(source.set), nullptr) << source.name;
    for (const FactorIndex factor : description().find_set(source.set)->factors) {
      EXPECT_TRUE(taken.insert(factor.value).second) << source.name;
    }
  }
}

TEST_P(EveryMechanism, HasAWorkspaceInsideReach) {
  for (const std::vector<double>& pose : poses()) {
    EXPECT_EQ(model_->joint_displacements(pose).size(), description().joints.size());
    EXPECT_GE(model_->condition(pose), 1.0);
    if (description().separation) {
      EXPECT_EQ(model_->separation(pose).effect.size(), description().factors.size());
    }
  }
}

/// Without errors the responses are zero up to rounding.
TEST_P(EveryMechanism, RespondsNothingToNoError) {
  const std::unique_ptr<Evaluator> evaluator = model_->evaluator({});
  for (const std::vector<double>& pose : poses()) {
    const Outcomes found = solve(*evaluator, description(), pose, {}, {}, 1);
    EXPECT_TRUE(solved(found.status[0]));
    for (const double response : found.responses) EXPECT_NEAR(response, 0.0, 1e-13);
  }
}

/// A sample has the same bits alone and in a block, whatever was solved before.
TEST_P(EveryMechanism, SolvesABlockAsItsSamples) {
  constexpr std::size_t kCount = 21;
  const ModelDescription& model = description();
  std::vector<FactorIndex> varied;
  for (std::size_t f = 0; f < model.factors.size(); ++f) varied.emplace_back(f);
  std::mt19937_64 random(20260102);
  std::vector<double> values(varied.size() * kCount);
  for (double& value : values) value = std::normal_distribution<>(0.0, 1e-4)(random);
  const std::vector<std::vector<double>> some = poses();
  const std::unique_ptr<Evaluator> evaluator = model_->evaluator({});
  const std::unique_ptr<Evaluator> another = model_->evaluator({});
  for (std::size_t m = 0; m < 5; ++m) {
    const Outcomes block = solve(*evaluator, model, some[m], varied, values, kCount);
    for (std::size_t b = 0; b < kCount; ++b) {
      std::vector<double> own;
      for (std::size_t v = 0; v < varied.size(); ++v) own.push_back(values[v * kCount + b]);
      const Outcomes alone = solve(*another, model, some[m], varied, own, 1);
      EXPECT_EQ(alone.status[0], block.status[b]);
      EXPECT_EQ(alone.iterations[0], block.iterations[b]);
      for (std::size_t r = 0; r < model.responses.size(); ++r) {
        EXPECT_EQ(alone.responses[r], block.responses[r * kCount + b]) << model.responses[r].name;
      }
    }
  }
}

TEST_P(EveryMechanism, ShowsASolveWithTheSameEnd) {
  const std::unique_ptr<Evaluator> evaluator = model_->evaluator({});
  const std::vector<double> pose = poses().front();
  std::vector<double> errors(description().factors.size(), 0.0);
  ASSERT_FALSE(errors.empty());
  errors[0] = 1e-4;
  const std::optional<SolveTrace> trace = model_->trace(pose, errors, {});
  if (!trace) GTEST_SKIP() << "the model shows no iterations";
  const std::vector<FactorIndex> varied{FactorIndex(0)};
  const Outcomes found = solve(*evaluator, description(), pose, varied, std::span(errors).first(1), 1);
  ASSERT_EQ(trace->responses.size(), found.responses.size());
  for (std::size_t r = 0; r < found.responses.size(); ++r) {
    EXPECT_NEAR(trace->responses[r], found.responses[r], 1e-12) << description().responses[r].name;
  }
}

TEST_P(EveryMechanism, BoundsErrorsAboveZero) {
  for (std::size_t f = 0; f < description().factors.size(); ++f) {
    EXPECT_GT(model_->error_bound(FactorIndex(f)).size, 0.0) << description().factors[f].name;
  }
}

TEST_P(EveryMechanism, FindsNothingUnusual) {
  EXPECT_TRUE(model_->unusual_geometry().empty());
  EXPECT_TRUE(model_->unusual_errors().empty());
}

/// The tuples name a mechanism and the size parameters of its platform (800 mm) and base (200 mm).
TEST(UnusualGeometry, IsAPlatformLargerThanItsBase) {
  for (const auto& [model, platform, base] :
       {std::tuple("2upr-rpu", "l_A", "l_B"), {"3-prs", "c", "a"}, {"xy-3-prs", "c", "a"}}) {
    const CatalogEntry& entry = *find(registry(), model);
    std::vector<double> geometry;
    for (const GeometryParameter& parameter : entry.description.geometry) {
      const bool is_length_of_rod = parameter.name == "l";
      geometry.push_back(parameter.name == platform ? 0.8
                         : parameter.name == base   ? 0.2
                         : is_length_of_rod         ? 1.0
                                                    : parameter.published);
    }
    const std::vector<std::string> found = entry.build(geometry, 0)->unusual_geometry();
    ASSERT_EQ(found.size(), 1u) << model;
    EXPECT_NE(found.front().find(std::string(platform) + " = 800 mm"), std::string::npos) << found.front();
    EXPECT_NE(found.front().find(std::string(base) + " = 200 mm"), std::string::npos) << found.front();
  }
}

TEST_P(EveryMechanism, IsFoundInCapitals) {
  std::string capitals = description().name;
  std::ranges::transform(capitals, capitals.begin(), [](unsigned char c) { return std::toupper(c); });
  ASSERT_NE(find(registry(), capitals), nullptr);
  EXPECT_EQ(find(registry(), capitals)->description.name, description().name);
}

TEST_P(EveryMechanism, HasTemplatesThatReadBack) {
  for (const StudyKind* kind : study_kinds().all) {
    if (kind->no_template != nullptr && kind->no_template(description())) continue;
    const Study study = study_of_text(template_text(*GetParam().entry, *kind), "template", registry(), StudyUse::run);
    EXPECT_EQ(study.analysis.kind, kind);
    const std::string text = resolved_text(study);
    EXPECT_EQ(resolved_text(study_of_text(text, "resolved", registry(), StudyUse::run)), text);
  }
}

/// [responses] The mean square of each response over all combinations of signs of some errors of size kSize. It is the
/// exact mean square for independent errors with mean zero. At this size the effects are linear.
std::vector<double> mean_squares_over_signs(Evaluator& evaluator, const ModelDescription& model,
                                            std::span<const double> pose, std::span<const FactorIndex> errors) {
  constexpr double kSize = 1e-6;
  const std::size_t count = std::size_t{1} << errors.size();
  std::vector<double> values;
  for (std::size_t p = 0; p < errors.size(); ++p) {
    for (std::size_t sample = 0; sample < count; ++sample) values.push_back((sample >> p) % 2 == 0 ? kSize : -kSize);
  }
  const Outcomes found = solve(evaluator, model, pose, errors, values, count);
  std::vector<double> squares(model.responses.size(), 0.0);
  for (std::size_t k = 0; k < found.responses.size(); ++k) {
    squares[k / count] += found.responses[k] * found.responses[k] / static_cast<double>(count);
  }
  return squares;
}

// Mean squares below kNoticeable (responses below a tenth of the errors) are not compared, because they may be
// second-order effects.
TEST_P(EveryMechanism, HasMeanSquaresThatAdd) {
  constexpr double kNoticeable = 1e-14;
  constexpr std::size_t kTogether = 6;
  const ModelDescription& model = description();
  const auto evaluator = model_->evaluator({});
  std::mt19937_64 random(20260102);
  std::vector<FactorIndex> all;
  for (std::size_t f = 0; f < model.factors.size(); ++f) all.emplace_back(f);
  std::vector<double> largest(model.responses.size(), 0.0);
  for (const std::vector<double>& pose : poses()) {
    std::vector<FactorIndex> some;
    std::ranges::sample(all, std::back_inserter(some), kTogether, random);
    const std::vector<double> together = mean_squares_over_signs(*evaluator, model, pose, some);
    std::vector<double> sum(model.responses.size(), 0.0);
    for (const FactorIndex& one : some) {
      const std::vector<double> alone = mean_squares_over_signs(*evaluator, model, pose, {&one, 1});
      for (std::size_t r = 0; r < sum.size(); ++r) sum[r] += alone[r];
    }
    for (std::size_t r = 0; r < sum.size(); ++r) {
      if (sum[r] > kNoticeable) largest[r] = std::max(largest[r], together[r] / sum[r]);
    }
  }
  bool some_may_exceed = false;
  double most = 0.0;  // the largest ratio of these responses
  for (std::size_t r = 0; r < largest.size(); ++r) {
    const Response& response = model.responses[r];
    EXPECT_LT(largest[r], response.mean_square_bound * (1.0 + 1e-3)) << response.name;
    EXPECT_GT(largest[r], 1.0 - 1e-3) << response.name;
    if (response.mean_square_bound == 1.0) continue;
    some_may_exceed = true;
    most = std::max(most, largest[r]);
  }
  if (some_may_exceed) {
    EXPECT_GT(most, 1.05);
  }
}

/// [samples] The norm of the vector that the model states for a response: a vector of other responses, or of details.
std::vector<double> norms_of(const Model& model, std::size_t response, std::span<const double> pose,
                             const Outcomes& found, std::size_t count) {
  const std::vector<std::size_t>& components = model.description().responses[response].components;
  const std::vector<double> matrix = model.norm_of_details(response, pose);
  const std::size_t details = found.details.size() / count;
  std::vector<double> norms;
  for (std::size_t s = 0; s < count; ++s) {
    double sum = 0.0;
    for (const std::size_t r : components) sum += std::pow(found.responses[r * count + s], 2);
    for (std::size_t row = 0; components.empty() && row < matrix.size() / details; ++row) {
      double component = 0.0;
      for (std::size_t d = 0; d < details; ++d) component += matrix[row * details + d] * found.details[d * count + s];
      sum += component * component;
    }
    norms.push_back(std::sqrt(sum));
  }
  return norms;
}

TEST_P(EveryMechanism, NamesTheVectorOfEachNorm) {
  constexpr std::size_t kSamples = 5;
  constexpr double kSize = 1e-5;  // nonlinear effects are below 1e-9
  const ModelDescription& model = description();
  const auto evaluator = model_->evaluator({});
  std::mt19937_64 random(20260103);
  std::uniform_real_distribution<double> error(-kSize, kSize);
  std::vector<FactorIndex> all;
  for (std::size_t f = 0; f < model.factors.size(); ++f) all.emplace_back(f);
  std::vector<double> values(all.size() * kSamples);
  for (double& value : values) value = error(random);
  for (const std::vector<double>& pose : poses()) {
    const Outcomes found = solve(*evaluator, model, pose, all, values, kSamples);
    for (std::size_t r = 0; r < model.responses.size(); ++r) {
      const std::span own = std::span(found.responses).subspan(r * kSamples, kSamples);
      if (std::ranges::any_of(own, [](double value) { return value < 0.0; })) continue;  // it is not a norm
      const Response& response = model.responses[r];
      const bool is_named = !response.components.empty() || !model_->norm_of_details(r, pose).empty();
      if (!is_named) continue;  // a component that happens to be positive; the norms are listed below
      const std::vector<double> norms = norms_of(*model_, r, pose, found, kSamples);
      for (std::size_t s = 0; s < kSamples; ++s) {
        // The published deformations are the mean and the maximum of three norms, so they differ from the norm of the
        // vector.
        const bool is_exact = response.mean_square_bound == 1.0;
        EXPECT_NEAR(own[s], norms[s], (is_exact ? 1e-9 : 0.35) * norms[s] + 1e-15) << response.name;
      }
    }
  }
  for (std::size_t r = 0; r < model.responses.size(); ++r) {
    const Response& response = model.responses[r];
    const bool is_norm =
        std::set<std::string>{"position",           "rotation",       "tip_position", "gap", "angular_deformation",
                              "linear_deformation", "deformation_max"}
            .contains(response.name);
    EXPECT_EQ(!response.components.empty() || !model_->norm_of_details(r, poses().front()).empty(), is_norm)
        << response.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryMechanism, testing::ValuesIn(choices()), name_of);

}  // namespace
}  // namespace poesy
