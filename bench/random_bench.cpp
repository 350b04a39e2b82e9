#include <benchmark/benchmark.h>

#include <vector>

#include "engine/random/distribution.h"
#include "engine/random/stream.h"

namespace {

constexpr std::size_t kDraws = 1000;

poesy::StreamAddress address_of(std::size_t pose) {
  return {.seed = 1, .factor = poesy::FactorIndex(7), .pose = poesy::PoseIndex(pose)};
}

/// Reports the time (s) for one draw. Google Benchmark prints it with a unit prefix, such as n for nano.
void report_draws(benchmark::State& state) {
  state.counters["time_per_draw"] = benchmark::Counter(
      static_cast<double>(kDraws), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void RandomBits(benchmark::State& state) {
  std::size_t pose = 0;
  for (auto _ : state) {
    const poesy::StreamAddress address = address_of(pose++);
    std::uint64_t all = 0;
    for (std::size_t k = 0; k < kDraws; ++k) all ^= poesy::random_bits(address, poesy::SampleIndex(k));
    benchmark::DoNotOptimize(all);
  }
  report_draws(state);
}

void FillUniforms(benchmark::State& state) {
  std::vector<double> draws(kDraws);
  std::size_t pose = 0;
  for (auto _ : state) {
    poesy::fill_uniforms(address_of(pose++), poesy::SampleIndex(0), draws);
    benchmark::DoNotOptimize(draws.data());
    benchmark::ClobberMemory();
  }
  report_draws(state);
}

/// Measures the drawing of uniforms and their conversion to errors together, so that every iteration converts new
/// values.
void FillAndTransform(benchmark::State& state, const poesy::Distribution& distribution) {
  std::vector<double> draws(kDraws);
  std::size_t pose = 0;
  for (auto _ : state) {
    poesy::fill_uniforms(address_of(pose++), poesy::SampleIndex(0), draws);
    distribution.transform(draws);
    benchmark::DoNotOptimize(draws.data());
    benchmark::ClobberMemory();
  }
  report_draws(state);
}

BENCHMARK(RandomBits)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(FillUniforms)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(FillAndTransform, normal, poesy::Distribution::normal(1.0))->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(FillAndTransform, truncated_normal, poesy::Distribution::truncated_normal(1.0, 2.0))
    ->UseRealTime()
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(FillAndTransform, uniform, poesy::Distribution::uniform(1.0))->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(FillAndTransform, triangular, poesy::Distribution::triangular(1.0))
    ->UseRealTime()
    ->MeasureProcessCPUTime();

}  // namespace
