#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/kinds/allocation/kind.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/study_run.h"
#include "tests/support/function_model.h"

/// Allocation studies whose model is a plain function of the errors.
namespace poesy::test {

/// The probability of a normal variable within three standard deviations. With this yield a limit on values is three
/// times the limit on root mean squares, as in the literature.
inline const double kThreeSigma = std::erf(3.0 / std::sqrt(2.0));

inline allocation::AllocatedPart part_of(std::size_t factor, const allocation::StatedCost& cost) {
  allocation::AllocatedPart part;
  part.name = "part " + std::to_string(factor + 1);
  part.factors = {FactorIndex(factor)};
  part.cost = cost;
  return part;
}

inline allocation::StatedCost reciprocal(double a, double b) {
  allocation::StatedCost cost;
  cost.law = allocation::StatedCost::Law::reciprocal;
  cost.a = a;
  cost.b = b;
  return cost;
}

/// An allocation study of a function. Each response has the limit |response| <= limit.
struct FunctionStudy {
  FunctionStudy(std::size_t errors, ErrorFunction function, double limit, std::size_t machines,
                std::vector<std::string> responses = {"y"})
      : model(errors, responses, std::move(function)), entry{model.description(), nullptr} {
    study = function_study(entry, allocation::kStudy, Distribution::normal(0.05), machines);
    study.analysis.draws = Draws::per_machine;
    study.poses.workspace = {{0.0, 1.0}};  // the text of the certificate's study states the workspace
    for (std::size_t r = 0; r < responses.size(); ++r) study.analysis.limits.push_back({r, limit});
    asked().yield = kThreeSigma;
  }
  allocation::Options& asked() { return asked_of<allocation::Options>(study.analysis); }
  StudyResult run(std::size_t threads = 2, std::vector<double> places = {0.5}) const {
    return *run_study(study, model, PoseSet(1, std::move(places)), {.threads = threads});
  }
  allocation::Result find(std::size_t threads = 2) const { return run(threads).as<allocation::Result>(); }

  FunctionModel model;
  CatalogEntry entry;
  Study study;
};

inline const std::vector<double> kCoefficients{3.0, 1.0, 0.5};
inline const std::vector<double> kPrices{1.0, 2.0, 0.2};

inline void weighted_sum(std::span<const double> x, double, std::span<double> y) {
  y[0] = 0.0;
  for (std::size_t i = 0; i < kCoefficients.size(); ++i) y[0] += kCoefficients[i] * x[i];
}

/// One response, the sum of three errors times kCoefficients. Each error is a part with a reciprocal cost.
inline FunctionStudy weighted_sum_study(std::size_t machines = 200'000) {
  FunctionStudy study(3, weighted_sum, 1.0, machines);
  study.asked().yield = 0.99;
  for (std::size_t i = 0; i < 3; ++i) study.asked().parts.push_back(part_of(i, reciprocal(0.0, kPrices[i])));
  return study;
}

}  // namespace poesy::test
