#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "models/lie/se3.h"

namespace {

using poesy::lie::Screw;
using poesy::lie::Transform;

constexpr std::size_t kInputs = 1024;

/// Random screws of sizes from about 1e-6 to 2, so that the processor cannot predict branches that depend on the size.
std::vector<Screw<double>> screws() {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> exponent(-6.0, 0.3), part(-1.0, 1.0);
  std::vector<Screw<double>> list(kInputs);
  for (auto& screw : list) {
    for (double& value : screw) value = part(engine);
    screw *= std::pow(10.0, exponent(engine));
  }
  return list;
}

void exp_of_screw(benchmark::State& state) {
  const auto inputs = screws();
  std::size_t n = 0;
  for (auto _ : state) benchmark::DoNotOptimize(poesy::lie::exp(inputs[n++ % kInputs]));
}

void log_of_transform(benchmark::State& state) {
  std::vector<Transform<double>> inputs;
  for (const auto& screw : screws()) inputs.push_back(poesy::lie::exp(screw));
  std::size_t n = 0;
  for (auto _ : state) benchmark::DoNotOptimize(poesy::lie::log(inputs[n++ % kInputs]));
}

void product(benchmark::State& state) {
  std::vector<Transform<double>> inputs;
  for (const auto& screw : screws()) inputs.push_back(poesy::lie::exp(screw));
  std::size_t n = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(inputs[n % kInputs] * inputs[(n + 1) % kInputs]);
    ++n;
  }
}

}  // namespace

BENCHMARK(exp_of_screw)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(log_of_transform)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(product)->UseRealTime()->MeasureProcessCPUTime();
