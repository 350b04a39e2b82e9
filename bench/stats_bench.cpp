#include <benchmark/benchmark.h>

#include <limits>
#include <vector>

#include "engine/random/stream.h"
#include "engine/stats/machines.h"
#include "engine/stats/main_effects.h"
#include "engine/stats/yield_gradient.h"

namespace {

constexpr std::size_t kErrors = 71;
constexpr std::size_t kSamples = 1000;

std::vector<double> uniforms(std::size_t rows, std::size_t pose) {
  std::vector<double> draws(rows * kSamples);
  for (std::size_t k = 0; k < rows; ++k) {
    poesy::fill_uniforms({.seed = 1, .factor = poesy::FactorIndex(k), .pose = poesy::PoseIndex(pose)},
                         poesy::SampleIndex(0), std::span(draws).subspan(k * kSamples, kSamples));
  }
  return draws;
}

/// Reports the time (s) of an iteration of the benchmark divided by the number of things that it processes. Google
/// Benchmark prints it with a unit prefix, such as n for nano.
void report(benchmark::State& state, std::size_t things) {
  state.counters["time_for_each"] = benchmark::Counter(
      static_cast<double>(things), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const std::vector<std::uint8_t> kAllCount(kSamples, 1);

/// Measures the time in which EffectBins finds the bin of a sample, for each error and sample.
void FindBins(benchmark::State& state) {
  const std::vector<double> draws = uniforms(kErrors, 0);
  for (auto _ : state) benchmark::DoNotOptimize(poesy::EffectBins(draws, kErrors));
  report(state, kErrors * kSamples);
}

/// Measures the time of MainEffectSums::add() for each response, error and sample.
void AddToBins(benchmark::State& state) {
  const auto responses = static_cast<std::size_t>(state.range(0));
  const poesy::EffectBins bins(uniforms(kErrors, 0), kErrors);
  const std::vector<double> values = uniforms(responses, 1);
  poesy::MainEffectSums sums(kErrors, responses);
  for (auto _ : state) {
    sums.add(bins, values, kAllCount);
    benchmark::ClobberMemory();
  }
  report(state, responses * kErrors * kSamples);
}

/// Measures the time of MainEffectSums::merge() for each response and error.
void MergeBins(benchmark::State& state) {
  const auto responses = static_cast<std::size_t>(state.range(0));
  poesy::MainEffectSums sums(kErrors, responses);
  sums.add(poesy::EffectBins(uniforms(kErrors, 0), kErrors), uniforms(responses, 1), kAllCount);
  const poesy::MainEffectSums other = sums;
  for (auto _ : state) {
    sums.merge(other);
    benchmark::ClobberMemory();
  }
  report(state, responses * kErrors);
}

/// Measures the time of MainEffectSums::variance() for each error of one response.
void VarianceOfBins(benchmark::State& state) {
  poesy::MainEffectSums sums(kErrors, 1);
  sums.add(poesy::EffectBins(uniforms(kErrors, 0), kErrors), uniforms(1, 1), kAllCount);
  const poesy::BinSpread spread = poesy::bin_spread(poesy::bin_spread_grid());
  for (auto _ : state) {
    for (std::size_t p = 0; p < kErrors; ++p) benchmark::DoNotOptimize(sums.variance(0, p, spread));
  }
  report(state, kErrors);
}

/// Measures the time of MachineBlock::add_pose() for each response and machine.
void AddMachinesAtPose(benchmark::State& state) {
  constexpr std::size_t kResponses = 4;
  poesy::MachineBlock block(std::vector<poesy::ValueLimit>(kResponses, 0.9), kSamples);
  const std::vector<double> values = uniforms(kResponses, 1);
  for (auto _ : state) {
    block.add_pose(values, kAllCount);
    benchmark::ClobberMemory();
  }
  report(state, kResponses * kSamples);
}

/// Measures the time of ScoreSums::add() for each error and machine. One of every state.range(0) machines is a reject.
void AddScores(benchmark::State& state) {
  const auto one_in = static_cast<std::size_t>(state.range(0));
  const poesy::NormalScore normal{1.0, std::numeric_limits<double>::infinity()};
  poesy::ScoreSums scores({std::vector<poesy::ErrorScore>(kErrors, normal)});
  const std::vector<double> errors = uniforms(kErrors, 0);
  std::vector<std::uint8_t> rejected(kSamples);
  for (std::size_t b = 0; b < kSamples; b += one_in) rejected[b] = 1;
  for (auto _ : state) {
    scores.add(errors, rejected);
    benchmark::ClobberMemory();
  }
  report(state, kErrors * kSamples);
}

BENCHMARK(FindBins);
BENCHMARK(AddToBins)->Arg(1)->Arg(3)->Arg(4)->Arg(8);
BENCHMARK(MergeBins)->Arg(4);
BENCHMARK(VarianceOfBins);
BENCHMARK(AddMachinesAtPose);
BENCHMARK(AddScores)->Arg(1)->Arg(20);

}  // namespace
