#include <benchmark/benchmark.h>

#include "bench/instruction_sets.h"
#include "bench/published_study.h"
#include "bench/reference_model.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/run/run_options.h"

namespace {

using namespace poesy;

/// One case of the benchmark: how the published study is solved, and at which of its poses.
struct Solver {
  std::string name;
  bool by_platform;
  std::size_t fidelity;  ///< index in the fidelities of the platform's metric; used only if by_platform is true
  SolverOptions::Method method;
  std::string isa;
  std::size_t step;  ///< only every step-th pose is solved; above 1 for slow solvers
};

Study study_of(const Solver& solver) {
  Study study = solver.by_platform
                    ? bench::platform_study(bench::kPublishedPoses, bench::kPublishedSamples, solver.fidelity)
                    : bench::published_study(bench::kPublishedPoses, bench::kPublishedSamples);
  study.solver.method = solver.method;
  return study;
}

/// Measures a run of the published study on state.range(0) threads.
void run(benchmark::State& state, const Solver& solver) {
  const Study study = study_of(solver);
  std::unique_ptr<Model> model = build_model(study.mechanism);
  const Plan plan(study, bench::every(solver.step, select_poses(study.poses, *model).poses));
  const bench::ReferenceModel reference(*model);
  const bool is_reference = solver.isa == "scalar";
  if (!is_reference) bench::choose_instruction_set(solver.isa);
  RunOptions options;
  options.threads = static_cast<std::size_t>(state.range(0));
  SolveCounts counts;
  for (auto _ : state) {
    const Model& solved = is_reference ? static_cast<const Model&>(reference) : *model;
    counts = sensitivity::run_sensitivity(plan, solved, 0.95, options)->total();
  }
  const auto solves = static_cast<double>(plan.solves());
  state.counters["solves/s"] = benchmark::Counter(solves, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["iterations/solve"] = static_cast<double>(counts.iterations) / solves;
  state.counters["not_converged"] = static_cast<double>(counts.not_converged()) / solves;
}

void add(const Solver& solver) {
  const std::size_t poses = (bench::kPublishedPoses + solver.step - 1) / solver.step;
  const std::string name = solver.name + "/" + solver.isa + "/poses:" + std::to_string(poses);
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { run(state, solver); })
      ->Arg(1)
      ->Arg(2)
      ->ArgName("threads")
      ->UseRealTime()
      ->MeasureProcessCPUTime()
      ->Unit(benchmark::kSecond);
}

/// Adds the cases. Their steps are chosen so that all cases take about the same time.
void add_all() {
  using Method = SolverOptions::Method;
  add({"reference", false, 0, Method::gauss_newton, "scalar", 40});
  for (const std::string& isa : bench::instruction_sets()) {
    const bool vectors = isa != "plain";
    add({"gauss-newton", false, 0, Method::gauss_newton, isa, vectors ? std::size_t{8} : 40});
    add({"newton", false, 0, Method::newton, isa, vectors ? std::size_t{1} : 8});
    add({"platform gauss-newton", true, 0, Method::gauss_newton, isa, vectors ? std::size_t{8} : 40});
    add({"platform newton", true, 0, Method::newton, isa, vectors ? std::size_t{1} : 8});
    add({"platform first-order", true, 1, Method::newton, isa, 1});
  }
}

}  // namespace

int main(int argc, char** argv) {
  add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
