#pragma once

#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "engine/random/distribution.h"
#include "engine/random/stream.h"
#include "engine/stats/main_effects.h"

// Functions of independent errors with known first-order indices and main effects, and experiments with them.

namespace poesy::test {

/// A function of independent errors that all have the same distribution.
struct EffectFunction {
  std::string name;
  Distribution distribution;
  std::function<double(std::span<const double>)> value;  ///< argument: [errors]
  std::vector<double> first_order;                       ///< [errors] indices S1
  /// The main effect E[y | error p has this value], as a function of p and the value.
  std::function<double(std::size_t, double)> main_effect;

  std::size_t errors() const { return first_order.size(); }
};

/// y = sum of sqrt(shares_p) z_p with standard normal errors z. The shares are the indices S1.
inline EffectFunction linear(std::vector<double> shares) {
  const auto value = [shares](std::span<const double> z) {
    double sum = 0.0;
    for (std::size_t p = 0; p < shares.size(); ++p) sum += std::sqrt(shares[p]) * z[p];
    return sum;
  };
  const auto effect = [shares](std::size_t p, double z) { return std::sqrt(shares[p]) * z; };
  return {"linear", Distribution::normal(1.0), value, shares, effect};
}

/// y = sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1 with errors that are uniform between -pi and pi.
inline EffectFunction ishigami() {
  const auto value = [](std::span<const double> x) {
    const double square = x[2] * x[2];
    return std::sin(x[0]) * (1.0 + 0.1 * square * square) + 7.0 * std::sin(x[1]) * std::sin(x[1]);
  };
  const auto effect = [](std::size_t p, double x) {
    const double fourth = std::pow(std::numbers::pi, 4.0) / 5.0;
    if (p == 0) return 3.5 + std::sin(x) * (1.0 + 0.1 * fourth);
    return p == 1 ? 7.0 * std::sin(x) * std::sin(x) : 3.5;
  };
  return {"Ishigami", Distribution::uniform(std::numbers::pi), value, {.31390519114781, .44241114479004, 0.0}, effect};
}

/// y = |sqrt(.8) z1 + sqrt(.2) z2| with standard normal errors z.
inline EffectFunction folded() {
  const auto value = [](std::span<const double> z) { return std::abs(std::sqrt(0.8) * z[0] + std::sqrt(0.2) * z[1]); };
  const auto effect = [](std::size_t p, double z) {
    const double centre = std::sqrt(p == 0 ? 0.8 : 0.2) * z;
    const double rest = std::sqrt(p == 0 ? 0.2 : 0.8);
    return rest * std::sqrt(2.0 / std::numbers::pi) * std::exp(-0.5 * centre * centre / (rest * rest)) +
           centre * std::erf(centre / rest / std::numbers::sqrt2);
  };
  return {"folded", Distribution::normal(1.0), value, {.59887592, .03515699}, effect};
}

/// y = exp(size x sum of sqrt(shares_p) z_p) with standard normal errors z. The shares add up to 1.
inline EffectFunction exponential(double size, std::vector<double> shares) {
  const double square = size * size;
  std::vector<double> indices;
  for (const double share : shares) indices.push_back(std::expm1(share * square) / std::expm1(square));
  const auto value = [size, shares](std::span<const double> z) {
    double sum = 0.0;
    for (std::size_t p = 0; p < shares.size(); ++p) sum += std::sqrt(shares[p]) * z[p];
    return std::exp(size * sum);
  };
  const auto effect = [=](std::size_t p, double z) {
    return std::exp(size * std::sqrt(shares[p]) * z + 0.5 * square * (1.0 - shares[p]));
  };
  return {"exp(" + std::to_string(size).substr(0, 3) + " z)", Distribution::normal(1.0), value, indices, effect};
}

/// How the values of an error with this distribution scatter within the bins.
inline BinSpread spread_of(const Distribution& distribution) {
  std::vector<double> values = bin_spread_grid();
  distribution.transform(values);
  return bin_spread(values);
}

/// Draws random samples of the errors and evaluates functions at them.
class EffectExperiment {
 public:
  explicit EffectExperiment(std::uint64_t seed) : engine_(seed) {}

  /// Sums over `samples` samples. All functions have the same number of errors and the same distribution, and are
  /// evaluated at the same samples.
  MainEffectSums sums(std::span<const EffectFunction> functions, std::size_t samples) {
    const std::size_t errors = functions.front().errors();
    MainEffectSums sums(errors, functions.size());
    constexpr std::size_t kBlock = 1000;
    for (std::size_t done = 0; done < samples; done += kBlock) {
      const std::size_t block = std::min(kBlock, samples - done);
      std::vector<double> uniforms(errors * block);
      for (double& uniform : uniforms) uniform = uniform_from_bits(engine_());
      const EffectBins bins(uniforms, errors);
      functions.front().distribution.transform(uniforms);
      std::vector<double> responses(functions.size() * block);
      std::vector<double> sample(errors);
      for (std::size_t b = 0; b < block; ++b) {
        for (std::size_t p = 0; p < errors; ++p) sample[p] = uniforms[p * block + b];
        for (std::size_t r = 0; r < functions.size(); ++r) responses[r * block + b] = functions[r].value(sample);
      }
      sums.add(bins, responses, std::vector<std::uint8_t>(block, 1));
    }
    return sums;
  }
  MainEffectSums sums(const EffectFunction& function, std::size_t samples) {
    return sums(std::span(&function, 1), samples);
  }

 private:
  boost::random::mt19937_64 engine_;
};

/// The mean of a function's main effect in each bin of one error, exact to about 1e-6 of the effect's range.
inline std::array<double, kEffectBins> bin_means(const EffectFunction& function, std::size_t error,
                                                 std::size_t grid = 4096) {
  std::array<double, kEffectBins> means{};
  for (std::size_t b = 0; b < kEffectBins; ++b) {
    std::vector<double> values(grid);
    for (std::size_t k = 0; k < grid; ++k) {
      values[k] = (static_cast<double>(b) + (static_cast<double>(k) + 0.5) / static_cast<double>(grid)) / kEffectBins;
    }
    function.distribution.transform(values);
    for (const double value : values) means[b] += function.main_effect(error, value) / static_cast<double>(grid);
  }
  return means;
}

}  // namespace poesy::test
