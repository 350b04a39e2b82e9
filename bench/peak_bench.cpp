#include <benchmark/benchmark.h>

#include "bench/instruction_sets.h"
#include "bench/peak.h"

namespace {

using namespace poesy;

/// The machine's limit for kernels that do nothing but multiply-adds.
void peak(benchmark::State& state, std::uint64_t (*multiply_adds)(std::uint64_t)) {
  std::uint64_t operations = 0;
  for (auto _ : state) operations += multiply_adds(100'000);
  state.counters["operations/s"] = benchmark::Counter(static_cast<double>(operations), benchmark::Counter::kIsRate);
}

void add_all() {
  for (const std::string& isa : bench::instruction_sets()) {
    auto* multiply_adds = bench::multiply_adds_plain;
#ifdef __x86_64__
    if (isa == "avx2") multiply_adds = bench::multiply_adds_avx2;
    if (isa == "avx512") multiply_adds = bench::multiply_adds_avx512;
#endif
    benchmark::RegisterBenchmark(("peak/" + isa).c_str(), [=](benchmark::State& state) { peak(state, multiply_adds); })
        ->ThreadRange(1, 2)
        ->UseRealTime()
        ->MeasureProcessCPUTime();
  }
}

}  // namespace

int main(int argc, char** argv) {
  add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
