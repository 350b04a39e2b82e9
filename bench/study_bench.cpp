#include <benchmark/benchmark.h>

#include "bench/published_study.h"
#include "engine/run/runner.h"

namespace {

using namespace poesy;

/// The published study with a tenth of its samples, on a number of threads.
void study(benchmark::State& state) {
  const Study study = bench::published_study(158, 100);
  const auto model = build_model(study.mechanism);
  const Plan plan(study, select_poses(study.poses, *model));
  RunOptions options;
  options.threads = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(run_sensitivity(plan, *model, 0.95, options));
  state.counters["solves/s"] =
      benchmark::Counter(static_cast<double>(plan.solves()), benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

BENCHMARK(study)->Arg(1)->Arg(2)->ArgName("threads")->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kSecond);
