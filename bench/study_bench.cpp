#include <benchmark/benchmark.h>

#include "bench/instruction_sets.h"
#include "bench/published_study.h"
#include "bench/reference_model.h"
#include "engine/run/runner.h"

namespace {

using namespace poesy;

/// The published study on a number of threads. Slow solvers see every step-th pose only.
void study(benchmark::State& state, SolverOptions::Method method, const std::string& isa, std::size_t step) {
  Study study = bench::published_study(bench::kPublishedPoses, bench::kPublishedSamples);
  study.solver.method = method;
  std::unique_ptr<Model> model = build_model(study.mechanism);
  const Plan plan(study, bench::every(step, select_poses(study.poses, *model).poses));
  const bench::ReferenceModel reference(*model);
  const bool is_reference = isa == "scalar";
  if (!is_reference) bench::choose_instruction_set(isa);
  RunOptions options;
  options.threads = static_cast<std::size_t>(state.range(0));
  SolveCounts counts;
  for (auto _ : state) {
    const Model& solved = is_reference ? static_cast<const Model&>(reference) : *model;
    counts = run_sensitivity(plan, solved, 0.95, options)->total();
  }
  const auto solves = static_cast<double>(plan.solves());
  state.counters["solves/s"] = benchmark::Counter(solves, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["iterations/solve"] = static_cast<double>(counts.iterations) / solves;
  state.counters["not_converged"] = static_cast<double>(counts.not_converged()) / solves;
}

void add(const std::string& solver, SolverOptions::Method method, const std::string& isa, std::size_t step) {
  const std::size_t poses = (bench::kPublishedPoses + step - 1) / step;
  const std::string name = solver + "/" + isa + "/poses:" + std::to_string(poses);
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { study(state, method, isa, step); })
      ->Arg(1)
      ->Arg(2)
      ->ArgName("threads")
      ->UseRealTime()
      ->MeasureProcessCPUTime()
      ->Unit(benchmark::kSecond);
}

/// Cases of about the same length.
void add_all() {
  using Method = SolverOptions::Method;
  add("reference", Method::gauss_newton, "scalar", 40);
  for (const std::string& isa : bench::instruction_sets()) {
    const bool vectors = isa != "plain";
    add("gauss-newton", Method::gauss_newton, isa, vectors ? 8 : 40);
    add("newton", Method::newton, isa, vectors ? 1 : 8);
  }
}

}  // namespace

int main(int argc, char** argv) {
  add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
