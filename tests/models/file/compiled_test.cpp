// Compares the compiled mechanisms with the same mechanisms from files, for the same errors and poses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "engine/model/model.h"
#include "models/registry.h"

namespace poesy {
namespace {

constexpr std::size_t kPoses = 500;
constexpr std::size_t kSamples = 200;  ///< at each pose, so there are 100 000 cases

CatalogEntry from_gallery(const std::string& name) {
  const std::string path = POESY_TEST_DATA "/../../results/gallery/" + name + "/" + name + ".toml";
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return registry().from_text(text.str(), path);
}

std::unique_ptr<Model> build(const CatalogEntry& entry, std::size_t fidelity) {
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  return entry.build(geometry, fidelity);
}

/// [errors x kSamples] Normal errors with sigma = 1 mm or 1 mrad.
std::vector<double> draw_errors(std::size_t errors, std::mt19937_64& engine) {
  std::normal_distribution<double> normal(0.0, 1e-3);
  std::vector<double> values(errors * kSamples);
  for (double& value : values) value = normal(engine);
  return values;
}

std::vector<double> draw_pose(const ModelDescription& model, std::mt19937_64& engine) {
  std::vector<double> pose;
  for (std::size_t c = 0; c < model.pose_lower.size(); ++c) {
    pose.push_back(std::uniform_real_distribution<double>(model.pose_lower[c], model.pose_upper[c])(engine));
  }
  return pose;
}

/// The rows of errors [errors x kSamples] of the mechanism `from` in the order of the errors of `to`, matched by name.
std::vector<double> reordered(const std::vector<double>& values, const ModelDescription& from,
                              const ModelDescription& to) {
  std::vector<double> rows;
  for (const Factor& factor : to.factors) {
    const auto row = values.begin() + static_cast<std::ptrdiff_t>(from.find_factor(factor.name)->value * kSamples);
    rows.insert(rows.end(), row, row + kSamples);
  }
  return rows;
}

struct Outcomes {
  std::vector<double> responses;
  std::vector<SolveStatus> status;
};

Outcomes solve(Evaluator& evaluator, const ModelDescription& model, std::span<const double> pose,
               const std::vector<double>& values) {
  std::vector<FactorIndex> varied;
  for (std::size_t f = 0; f < model.factors.size(); ++f) varied.emplace_back(f);
  Outcomes outcomes{std::vector<double>(model.responses.size() * kSamples), std::vector<SolveStatus>(kSamples)};
  std::vector<std::uint32_t> iterations(kSamples);
  evaluator.evaluate({pose, std::vector<double>(varied.size(), 0.0), varied, values, kSamples},
                     {outcomes.responses, outcomes.status, iterations, {}});
  return outcomes;
}

/// Counts of the differences between two mechanisms.
struct Differences {
  std::size_t cases = 0;
  std::size_t unsolved = 0;   ///< cases that one or both did not solve
  std::size_t responses = 0;  ///< responses beyond the tolerance, if both solved
  double largest = 0.0;       ///< the largest of these differences, SI
};

/// A tolerance: the larger of the relative and the absolute (SI) one.
struct Within {
  double relative;
  double absolute;
};

Differences compare(const CatalogEntry& compiled, const CatalogEntry& file, std::size_t fidelity,
                    SolverOptions::Method method, const Within& within) {
  const std::unique_ptr<Model> a = build(compiled, fidelity);
  const std::unique_ptr<Model> b = build(file, fidelity);
  const ModelDescription& of_a = a->description();
  const ModelDescription& of_b = b->description();
  EXPECT_EQ(of_a.factors.size(), of_b.factors.size());
  const std::unique_ptr<Evaluator> solver_a = a->evaluator({.method = method, .tolerance = of_a.tolerance});
  const std::unique_ptr<Evaluator> solver_b = b->evaluator({.method = method, .tolerance = of_b.tolerance});
  std::mt19937_64 engine(7);
  Differences found;
  for (std::size_t m = 0; m < kPoses; ++m) {
    const std::vector<double> pose = draw_pose(of_b, engine);
    if (a->unreachable(pose)) continue;
    const std::vector<double> values = draw_errors(of_a.factors.size(), engine);
    const Outcomes x = solve(*solver_a, of_a, pose, values);
    const Outcomes y = solve(*solver_b, of_b, pose, reordered(values, of_a, of_b));
    for (std::size_t n = 0; n < kSamples; ++n) {
      ++found.cases;
      if (!solved(x.status[n]) || !solved(y.status[n])) {
        ++found.unsolved;
        continue;
      }
      for (std::size_t r = 0; r < of_a.responses.size(); ++r) {
        const auto same = std::ranges::find(of_b.responses, of_a.responses[r].name, &Response::name);
        const double p = x.responses[r * kSamples + n];
        const double q = y.responses[static_cast<std::size_t>(same - of_b.responses.begin()) * kSamples + n];
        if (std::abs(p - q) <= std::max(within.absolute, within.relative * std::abs(p))) continue;
        ++found.responses;
        found.largest = std::max(found.largest, std::abs(p - q));
      }
    }
  }
  return found;
}

void expect_none(const Differences& found) {
  EXPECT_GT(found.cases, kPoses * kSamples / 2);
  EXPECT_EQ(found.unsolved, 0u);
  EXPECT_EQ(found.responses, 0u) << "up to " << found.largest;
}

constexpr Within kClose{1e-12, 1e-15};

TEST(CompiledAndFile, TwoUprRpuIsTheSameByBothMetricsAndMethods) {
  const CatalogEntry file = from_gallery("2upr-rpu");
  const CatalogEntry& compiled = *find(registry(), "2upr-rpu");
  for (const char* metric : {"platform", "published"}) {
    for (const auto method : {SolverOptions::Method::newton, SolverOptions::Method::gauss_newton}) {
      SCOPED_TRACE(metric);
      expect_none(compare(by_metric(compiled, metric), by_metric(file, metric), 0, method, kClose));
    }
    expect_none(compare(by_metric(compiled, metric), by_metric(file, metric), 1, {}, kClose));
  }
}

TEST(CompiledAndFile, ThreePrsIsTheSame) {
  const CatalogEntry file = from_gallery("3-prs");
  const CatalogEntry& compiled = *find(registry(), "3-prs");
  expect_none(compare(compiled, file, 1, {}, kClose));
  // The compiled mechanism solves nine equations and the one from the file fifteen, so their rounding errors differ.
  expect_none(compare(compiled, file, 0, {}, {1e-11, 2e-14}));
}

}  // namespace
}  // namespace poesy
