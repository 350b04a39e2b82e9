#include <benchmark/benchmark.h>

#include <functional>

#include "bench/instruction_sets.h"
#include "bench/published_study.h"
#include "bench/reference_model.h"
#include "engine/run/evaluate_unit.h"

namespace {

using namespace poesy;

void report(benchmark::State& state, const SolveCounts& counts) {
  const auto solves = static_cast<double>(counts.total());
  const auto average = [](double value) { return benchmark::Counter(value, benchmark::Counter::kAvgThreads); };
  state.counters["solves/s"] = benchmark::Counter(solves, benchmark::Counter::kIsRate);
  state.counters["iterations/solve"] = average(static_cast<double>(counts.iterations) / solves);
  state.counters["not_converged"] = average(static_cast<double>(counts.not_converged()) / solves);
}

using MakeStudy = std::function<Study(std::size_t poses, std::size_t samples)>;

Study platform_study(std::size_t poses, std::size_t samples) { return bench::platform_study(poses, samples); }
Study first_order_study(std::size_t poses, std::size_t samples) { return bench::platform_study(poses, samples, 1); }

/// Measures the drawing and solving of work units (WorkUnit) from all parts of a study. isa: instruction set, or
/// "scalar" for ReferenceModel.
void units(benchmark::State& state, const MakeStudy& make, SolverOptions::Method method, const std::string& isa) {
  Study study = make(bench::kPublishedPoses, bench::kPublishedSamples);
  study.solver.method = method;
  const auto model = build_model(study.mechanism);
  const bench::ReferenceModel reference(*model);
  const Plan plan(study, select_poses(study.poses, *model).poses);
  const bool is_reference = isa == "scalar";
  if (!is_reference) bench::choose_instruction_set(isa);
  UnitEvaluator evaluate(plan, is_reference ? static_cast<const Model&>(reference) : *model);
  SolveCounts counts;
  std::size_t n = 0;
  for (auto _ : state) counts.merge(evaluate(bench::scattered_unit(plan, n++)).solves);
  report(state, counts);
}

/// Measures solves in which all errors vary at once, in blocks of 1000 samples, each block at a different pose. Every
/// thread solves the same blocks. The time of drawing is not included. scale: factor of the study's errors.
void all_errors(benchmark::State& state, const MakeStudy& make, const std::string& isa, double scale) {
  constexpr std::size_t kBlocks = 8;  // number of different blocks of samples, used in turn
  constexpr std::size_t kCount = 1000;
  const Study study = make(bench::kPublishedPoses, kCount);
  const auto model = build_model(study.mechanism);
  const PoseSet poses = select_poses(study.poses, *model).poses;
  const std::unique_ptr<Evaluator> evaluator = bench::evaluator_with(isa, *model, study.solver);
  const std::size_t factors = model->description().factors.size();
  std::vector<FactorIndex> varied;
  for (std::size_t f = 0; f < factors; ++f) varied.emplace_back(f);
  std::vector<std::vector<double>> blocks;
  for (std::size_t n = 0; n < kBlocks; ++n) {
    blocks.push_back(bench::samples_of_all_errors(study, scale, PoseIndex(n), kCount));
  }
  const std::vector<double> zeros(factors, 0.0);
  std::vector<double> responses(model->description().responses.size() * kCount);
  std::vector<SolveStatus> status(kCount);
  std::vector<std::uint32_t> iterations(kCount);
  SolveCounts counts;
  std::size_t n = 0;
  for (auto _ : state) {
    // The stride 31 and the number of poses have no common factor, so even a few blocks are spread over the workspace.
    evaluator->evaluate({poses[PoseIndex(31 * n % poses.size())], zeros, varied, blocks[n % kBlocks], kCount},
                        {responses, status, iterations, {}});
    for (std::size_t b = 0; b < kCount; ++b) counts.add(status[b], iterations[b]);
    ++n;
  }
  report(state, counts);
}

template <class Case>
auto add(const std::string& name, Case run) {
  return benchmark::RegisterBenchmark(name.c_str(), run)
      ->UseRealTime()
      ->MeasureProcessCPUTime()
      ->Unit(benchmark::kMillisecond);
}

/// Adds the cases of one metric on one instruction set: work units by each method, and all errors at two sizes.
void add_metric(const std::string& metric, const MakeStudy& make, const std::string& isa) {
  using Method = SolverOptions::Method;
  const auto add_units = [&](const std::string& method, Method which) {
    add(metric + "/units/" + method + "/" + isa, [=](benchmark::State& state) {
      units(state, make, which, isa);
    })->ThreadRange(1, 2);
  };
  add_units("gauss-newton", Method::gauss_newton);
  add_units("newton", Method::newton);
  // Solves with large errors take longer, so these cases solve fewer blocks.
  add(metric + "/all_errors/1_mm_1_deg/" + isa, [=](benchmark::State& state) { all_errors(state, make, isa, 1.0); })
      ->ThreadRange(1, 2)
      ->Iterations(isa == "plain" ? 8 : 40);
  add(metric + "/all_errors/0.1_mm_0.1_deg/" + isa, [=](benchmark::State& state) { all_errors(state, make, isa, 0.1); })
      ->ThreadRange(1, 2)
      ->Iterations(bench::kPublishedPoses);
}

void add_all() {
  using Method = SolverOptions::Method;
  add("published/units/reference/scalar",
      [](benchmark::State& state) { units(state, bench::published_study, Method::gauss_newton, "scalar"); });
  for (const std::string& isa : bench::instruction_sets()) {
    add_metric("published", bench::published_study, isa);
    add_metric("platform", platform_study, isa);
    add("first-order/units/" + isa, [=](benchmark::State& state) {
      units(state, first_order_study, Method::newton, isa);
    })->ThreadRange(1, 2);
    add("first-order/all_errors/" + isa, [=](benchmark::State& state) {
      all_errors(state, first_order_study, isa, 1.0);
    })->ThreadRange(1, 2);
  }
}

}  // namespace

int main(int argc, char** argv) {
  add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
