#include <benchmark/benchmark.h>

#include <span>
#include <string>
#include <vector>

#include "bench/instruction_sets.h"
#include "bench/peak.h"

namespace {

using namespace poesy;

/// Measures the largest rate of floating-point operations that this computer reaches, by a loop of multiply-adds.
void peak(benchmark::State& state, std::uint64_t (*multiply_adds)(std::uint64_t)) {
  std::uint64_t operations = 0;
  for (auto _ : state) operations += multiply_adds(100'000);
  state.counters["operations/s"] = benchmark::Counter(static_cast<double>(operations), benchmark::Counter::kIsRate);
}

/// Measures the largest rate at which this computer reads numbers from a cache or from memory. bytes: size of the
/// array, which decides where it is stored.
void read(benchmark::State& state, double (*sum)(std::span<const double>), std::size_t bytes) {
  const std::vector<double> numbers(bytes / sizeof(double), 1.0);
  std::uint64_t passes = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sum(numbers));
    ++passes;
  }
  state.counters["bytes/s"] =
      benchmark::Counter(static_cast<double>(passes) * static_cast<double>(bytes), benchmark::Counter::kIsRate);
}

template <class Case>
void add(const std::string& name, Case run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->ThreadRange(1, 2)->UseRealTime()->MeasureProcessCPUTime();
}

void add_all() {
  for (const std::string& isa : bench::instruction_sets()) {
    auto* multiply_adds = bench::multiply_adds_plain;
    auto* sum = bench::sum_plain;
#ifdef __x86_64__
    if (isa == "avx2") {
      multiply_adds = bench::multiply_adds_avx2;
      sum = bench::sum_avx2;
    } else if (isa == "avx512") {
      multiply_adds = bench::multiply_adds_avx512;
      sum = bench::sum_avx512;
    }
#endif
    add("peak/" + isa, [=](benchmark::State& state) { peak(state, multiply_adds); });
    add("read/second_cache/" + isa, [=](benchmark::State& state) { read(state, sum, std::size_t{512} << 10); });
    add("read/memory/" + isa, [=](benchmark::State& state) { read(state, sum, std::size_t{512} << 20); });
  }
}

}  // namespace

int main(int argc, char** argv) {
  add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
