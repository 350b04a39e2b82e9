#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/sobol/kind.h"
#include "engine/kinds/sobol/result.h"
#include "engine/kinds/study_run.h"
#include "tests/engine/stats/coverage.h"
#include "tests/support/function_model.h"

// Functions of correlated errors with known Shapley effects, and the coverage of the 95 % intervals of these effects.

namespace poesy::test {

/// y = x1 + x2 + x3.
inline void sum_of_three(std::span<const double> x, double, std::span<double> y) { y[0] = x[0] + x[1] + x[2]; }

/// A study of three normal errors with standard deviations 1, 1 and 2, of which the last two are correlated by 0.9.
/// entry: of a function with three errors; it must outlive the study.
inline Study correlated_study(const CatalogEntry& entry, std::size_t samples) {
  Study study = function_study(entry, sobol::kStudy, Distribution::normal(1.0), samples);
  study.errors.by_factor[2] = Distribution::normal(2.0);
  study.errors.correlated = {{{FactorIndex(1), FactorIndex(2)}, {1.0, 0.9, 0.9, 1.0}}};
  return study;
}

/// A function of z, the sum of the three errors of correlated_study() divided by its standard deviation.
struct ShapleyFunction {
  std::string name;                         ///< for messages
  std::function<double(double)> value;      ///< the response y as a function of z
  std::function<double(double)> explained;  ///< Var(E[y | S]), up to a factor, if S explains this share of Var(z)

  /// The Shapley effects by the definition of Owen 2014. kParts: the part of the sum's variance, 9.6, that each subset
  /// S of the errors explains.
  std::array<double, 3> effects() const {
    constexpr std::array kParts{0.0, 1.0, 7.84, 8.84, 8.41, 9.41, 8.6, 9.6};  // bit p of the index: x_p is in S
    const auto worth = [&](std::size_t subset) { return explained(kParts[subset] / 9.6) / explained(1.0); };
    std::array<double, 3> effects{};
    for (std::size_t p = 0; p < 3; ++p) {
      const std::size_t own = std::size_t{1} << p;
      const std::size_t one = std::size_t{1} << (p + 1) % 3;
      const std::size_t other = std::size_t{1} << (p + 2) % 3;
      effects[p] = (worth(own) + worth(7) - worth(7 - own)) / 3.0 +
                   (worth(own | one) - worth(one) + worth(own | other) - worth(other)) / 6.0;
    }
    return effects;
  }
};

/// The functions z, |z| and exp(z / 2).
inline std::vector<ShapleyFunction> shapley_functions() {
  // Two standard normals u and w with the correlation r have E[|u| |w|] = 2 / pi (sqrt(1 - r^2) + r asin r).
  const auto folded = [](double r) { return std::sqrt(1.0 - r * r) + r * std::asin(r) - 1.0; };
  return {{"linear", [](double z) { return z; }, [](double share) { return share; }},
          {"folded", [](double z) { return std::abs(z); }, folded},
          {"exp(z / 2)", [](double z) { return std::exp(0.5 * z); }, [](double r) { return std::expm1(0.25 * r); }}};
}

/// The coverage of the intervals of the three effects, over `repetitions` studies with the seeds `seed`, `seed` + 1,
/// ...
inline std::array<Coverage, 3> shapley_coverage(const ShapleyFunction& function, std::size_t samples, int repetitions,
                                                std::uint64_t seed) {
  const FunctionModel model(3, {"y"}, [&](std::span<const double> x, double place, std::span<double> y) {
    sum_of_three(x, place, y);
    y[0] = function.value(y[0] / std::sqrt(9.6));
  });
  const CatalogEntry entry{model.description(), nullptr};
  Study study = correlated_study(entry, samples);
  asked_of<sobol::Options>(study.analysis).shapley = true;
  const std::array<double, 3> effects = function.effects();
  std::array<Coverage, 3> coverage;
  for (int r = 0; r < repetitions; ++r) {
    study.seed = seed + static_cast<std::uint64_t>(r);
    const auto result = run_study(study, model, PoseSet(1, {0.5}), {.threads = 1});
    const auto& found = result->as<sobol::Result>();
    for (std::size_t p = 0; p < 3; ++p) coverage[p].add({found.Sh.ci_low(0, p), found.Sh.ci_high(0, p)}, effects[p]);
  }
  return coverage;
}

}  // namespace poesy::test
