#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "models/assembly/block_solver.h"
#include "models/assembly/model.h"
#include "models/chain/metric.h"
#include "models/file/balanced_model.h"
#include "tests/models/file/files.h"

// Assemblies of mechanism files, random errors for them, and their responses.
namespace poesy::assembly {

/// Short names of the fidelities.
/// @{
inline constexpr auto kExact = chain::Fidelity::exact;
inline constexpr auto kFirstOrder = chain::Fidelity::first_order;
/// @}

inline constexpr double kMillimetre = 1e-3;
inline constexpr double kDegree = 0.017453292519943295;

inline const SolverOptions kOptions{.tolerance = chain::kToleranceByMetric};

/// The assembly of a mechanism file with its default geometry. text: content of the file.
inline AssemblyModel made(const std::string& text, Metric metric) {
  const file::MechanismFile read = file::read_mechanism_file(text, "m.toml");
  const file::Checked found =
      file::checked(file::mechanism(read, file::default_geometry(read)), file::Workspace::as_it_is);
  return file::assembly_model(found.mechanism, std::make_shared<const file::PoseTracker>(found.mechanism), found.home,
                              metric);
}

/// All errors of the mechanism (SI): those named, and 0 for the others.
inline std::vector<double> named_errors(const std::string& text, const std::map<std::string, double>& values) {
  const file::MechanismFile read = file::read_mechanism_file(text, "m.toml");
  const std::vector<Factor> factors = file::mechanism(read, file::default_geometry(read)).factors;
  std::vector<double> errors;
  std::size_t known = 0;
  for (const Factor& factor : factors) {
    const auto at = values.find(factor.name);
    known += at != values.end() ? 1 : 0;
    errors.push_back(at == values.end() ? 0.0 : at->second);
  }
  EXPECT_EQ(known, values.size()) << "an error has no such name";
  return errors;
}

/// A mechanism of tests/data/mechanisms, and a pose in its workspace.
struct Case {
  const char* name;
  std::vector<double> pose;

  std::string text() const { return file::text_of(name); }
};

inline const std::vector<Case>& cases() {
  static const std::vector<Case> all{{"lift-table", {0.56, 0.03, -0.05}},
                                     {"linear-delta", {0.05, -0.03, 0.21}},
                                     {"upr2-rpu-beams", {-0.25, 0.2, -0.15}},
                                     {"delta-parallelogram", {-0.03, 0.04, 0.16}},
                                     {"tripteron-msa", {0.45, 0.55, 0.6}}};
  return all;
}

inline constexpr Metric kMetrics[] = {Metric::stiffness, Metric::platform};

/// Random normal errors (SI) with the standard deviation `size` mm or deg.
inline std::vector<double> random_errors(const AssemblyModel& model, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> errors;
  for (const chain::ErrorTerms& terms : model.terms) {
    errors.push_back(size * (terms.front().component < 3 ? kDegree : kMillimetre) * normal(random));
  }
  return errors;
}

/// Responses and their values.
struct Answers {
  std::vector<Response> responses;
  std::vector<double> values;
  double reach;  ///< reach of the mechanism, m

  /// The value of the response with this name. If there is none, the test fails and the value is NaN.
  double operator[](const std::string& name) const {
    const auto at = std::ranges::find(responses, name, &Response::name);
    EXPECT_NE(at, responses.end()) << name;
    return at == responses.end() ? std::nan("") : values[static_cast<std::size_t>(at - responses.begin())];
  }
};

inline Answers answers(const AssemblyModel& model, const std::vector<double>& pose, const std::vector<double>& errors,
                       chain::Fidelity fidelity) {
  Answers made{responses_of(model), {}, model.assembly.reach};
  made.values.resize(made.responses.size());
  SolveStatus status{};
  std::uint32_t iterations = 0;
  assembly_evaluator(model, kOptions, fidelity)
      ->evaluate({pose, errors, {}, {}, 1}, {made.values, {&status, 1}, {&iterations, 1}, {}});
  EXPECT_TRUE(solved(status)) << kStatusNames[static_cast<std::size_t>(status)];
  return made;
}

/// The largest magnitude for each dimension. Lengths and angles are compared via the reach, as are forces and moments,
/// because one of them may be zero except for rounding errors of the other.
inline std::map<Dimension, double> largest_of(const Answers& all) {
  std::map<Dimension, double> largest;
  for (std::size_t r = 0; r < all.values.size(); ++r) {
    double& most = largest[all.responses[r].dimension];
    most = std::max(most, std::abs(all.values[r]));
  }
  const auto together = [&](Dimension one, Dimension other) {  // `one` has the unit of `other` times a length
    largest[one] = std::max(largest[one], all.reach * largest[other]);
    largest[other] = largest[one] / all.reach;
  };
  together(Dimension::length, Dimension::angle);
  together(Dimension::moment, Dimension::force);
  return largest;
}

/// Compares the responses that both answers have. tolerance: relative to the largest value of their dimension. Returns
/// the number of compared responses.
inline std::size_t expect_same(const Answers& found, const Answers& wanted, double tolerance) {
  std::map<Dimension, double> largest = largest_of(wanted);
  std::size_t compared = 0;
  for (std::size_t r = 0; r < found.values.size(); ++r) {
    const Response& response = found.responses[r];
    if (std::ranges::find(wanted.responses, response.name, &Response::name) == wanted.responses.end()) continue;
    ++compared;
    EXPECT_NEAR(found.values[r], wanted[response.name], tolerance * largest[response.dimension]) << response.name;
  }
  return compared;
}

/// The solution by the plain Newton solver. iterations: the largest allowed number.
inline Solution solution_of(const AssemblyModel& model, const Nominal& pose, const std::vector<double>& errors,
                            int iterations = kOptions.max_iterations) {
  SolverOptions options = kOptions;
  options.max_iterations = iterations;
  Solver solver(model.assembly, model.ranks, options);
  solver.prepare(pose);
  ErrorFrames frames(model);
  return solver.solve(frames.with(errors, pose.displacements));
}

}  // namespace poesy::assembly
