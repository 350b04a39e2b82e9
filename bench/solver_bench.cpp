#include <benchmark/benchmark.h>

#include "bench/published_study.h"
#include "engine/run/evaluate_unit.h"

namespace {

using namespace poesy;

/// One thread solving units spread over the published study.
void solver(benchmark::State& state) {
  const Study study = bench::published_study(158, Plan::kUnitSamples);
  const auto model = build_model(study.mechanism);
  const Plan plan(study, select_poses(study.poses, *model));
  UnitEvaluator evaluate(plan, *model);
  std::uint64_t solves = 0;
  std::uint64_t iterations = 0;
  std::size_t u = 0;
  for (auto _ : state) {
    WorkUnit unit = plan.unit(u);
    unit.count = 100;
    const UnitStats stats = evaluate(unit);
    solves += stats.solves.total();
    iterations += stats.solves.iterations;
    u = (u + 1597) % plan.units();  // a stride prime to the table's length visits every factor and pose
  }
  state.counters["solves/s"] = benchmark::Counter(static_cast<double>(solves), benchmark::Counter::kIsRate);
  state.counters["iterations/solve"] = static_cast<double>(iterations) / static_cast<double>(solves);
}

}  // namespace

BENCHMARK(solver)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
