// If one error varies within a known range, samples start from a predicted solution. Tests that they end at the same
// solution as without a prediction.
#include <bit>

#include "tests/models/assembly/made.h"

namespace poesy::assembly {
namespace {

constexpr std::size_t kSamples = 100;

/// Samples in which one error varies; all other errors are small and constant.
struct Varied {
  std::vector<double> pose;
  std::vector<double> errors;
  std::vector<FactorIndex> varied;
  std::vector<double> values;
  double range;

  SampleBlock block(std::size_t first, std::size_t count, double within) const {
    return {pose, errors, varied, std::span(values).subspan(first, count), count, within};
  }
};

/// Samples with normal values of the error `factor`; size: standard deviation (mm or deg). The range is two standard
/// deviations, so few values are beyond it.
Varied varied(const Case& one, const AssemblyModel& model, std::size_t factor, double size) {
  const double sigma = size * (model.terms[factor].front().component < 3 ? kDegree : kMillimetre);
  Varied made{one.pose, random_errors(model, 0.05, 5), {FactorIndex(factor)}, {}, 2.0 * sigma};
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (std::size_t b = 0; b < kSamples; ++b) made.values.push_back(sigma * normal(random));
  return made;
}

struct Block {
  std::vector<double> responses;
  std::vector<SolveStatus> status;
  std::vector<std::uint32_t> iterations;
};

Block solved_by(Evaluator& evaluator, const AssemblyModel& model, const SampleBlock& samples) {
  Block made{std::vector<double>(responses_of(model).size() * samples.count), std::vector<SolveStatus>(samples.count),
             std::vector<std::uint32_t>(samples.count)};
  evaluator.evaluate(samples, {made.responses, made.status, made.iterations, {}});
  return made;
}

template <class Check>
void for_each_varied(Check check) {
  for (const Case& one : cases()) {
    const AssemblyModel model = made(one.text(), Metric::platform);
    for (std::size_t factor = 1; factor < model.terms.size(); factor += 7) {
      for (const double size : {0.1, 1.0}) {
        SCOPED_TRACE(std::string(one.name) + ", error " + std::to_string(factor) + ", " + std::to_string(size));
        check(model, varied(one, model, factor, size));
      }
    }
  }
}

TEST(PredictedStarts, LeadToTheSameSolutions) {
  double rounds = 0.0;
  double rounds_without = 0.0;
  for_each_varied([&](const AssemblyModel& model, const Varied& samples) {
    const std::unique_ptr<Evaluator> evaluator = assembly_evaluator(model, kOptions, kExact);
    const Block wanted = solved_by(*evaluator, model, samples.block(0, kSamples, 0.0));
    const Block found = solved_by(*evaluator, model, samples.block(0, kSamples, samples.range));
    const std::vector<Response> responses = responses_of(model);
    for (std::size_t b = 0; b < kSamples; ++b) {
      ASSERT_EQ(found.status[b], wanted.status[b]);
      rounds += found.iterations[b];
      rounds_without += wanted.iterations[b];
      for (std::size_t r = 0; r < responses.size(); ++r) {
        const double unit = responses[r].dimension == Dimension::length ? model.assembly.reach : 1.0;
        EXPECT_NEAR(found.responses[r * kSamples + b], wanted.responses[r * kSamples + b], 1e-12 * unit)
            << responses[r].name;
      }
    }
  });
  EXPECT_LT(rounds, 0.8 * rounds_without);
}

/// A predicted start does not depend on the other samples of its block or on earlier blocks.
TEST(PredictedStarts, DependOnTheSampleAlone) {
  for_each_varied([&](const AssemblyModel& model, const Varied& samples) {
    const Block wanted =
        solved_by(*assembly_evaluator(model, kOptions, kExact), model, samples.block(0, kSamples, samples.range));
    const std::unique_ptr<Evaluator> used = assembly_evaluator(model, kOptions, kExact);
    for (const auto& [first, count] : {std::pair(3u, 1u), {40u, 16u}, {8u, 13u}, {99u, 1u}}) {
      solved_by(*used, model, samples.block(first, count, 0.0));
      const Block found = solved_by(*used, model, samples.block(first, count, samples.range));
      for (std::size_t b = 0; b < count; ++b) {
        EXPECT_EQ(found.iterations[b], wanted.iterations[first + b]);
        for (std::size_t r = 0; r < found.responses.size() / count; ++r) {
          ASSERT_EQ(std::bit_cast<std::uint64_t>(found.responses[r * count + b]),
                    std::bit_cast<std::uint64_t>(wanted.responses[r * kSamples + first + b]));
        }
      }
    }
  });
}

}  // namespace
}  // namespace poesy::assembly
