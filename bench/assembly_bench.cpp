#include <benchmark/benchmark.h>

#include <fstream>
#include <iterator>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "bench/instruction_sets.h"
#include "models/registry.h"

namespace {

using namespace poesy;

constexpr std::size_t kSamples = 1000;

/// How the linear Delta with 48 errors is solved.
struct Case {
  std::string metric;  ///< "stiffness": with forces and load
  double size;         ///< standard deviation, mm and mrad
  std::string isa;     ///< instruction set
};

std::unique_ptr<Model> linear_delta(const std::string& metric) {
  std::ifstream file(POESY_LINEAR_DELTA);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const CatalogEntry entry = registry().from_text(text, POESY_LINEAR_DELTA);
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  return by_metric(entry, metric).build(geometry, 0);
}

/// A block of normal errors at one pose, solved again and again.
void solves(benchmark::State& state, const Case& which) {
  const std::unique_ptr<Model> model = linear_delta(which.metric);
  const ModelDescription& description = model->description();
  const std::size_t errors = description.factors.size();
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal(0.0, 1e-3 * which.size);
  std::vector<double> values(errors * kSamples);
  for (double& value : values) value = normal(engine);
  std::vector<FactorIndex> varied;
  for (std::size_t f = 0; f < errors; ++f) varied.emplace_back(f);
  const std::vector<double> pose{0.03, -0.02, 0.2};
  const std::vector<double> none(errors, 0.0);
  std::vector<double> responses(description.responses.size() * kSamples);
  std::vector<SolveStatus> status(kSamples);
  std::vector<std::uint32_t> iterations(kSamples);
  const SolverOptions options{.tolerance = description.tolerance};
  const std::unique_ptr<Evaluator> evaluator = bench::evaluator_with(which.isa, *model, options);
  for (auto _ : state) {
    evaluator->evaluate({pose, none, varied, values, kSamples}, {responses, status, iterations, {}});
    benchmark::DoNotOptimize(responses.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
  const auto rounds = std::accumulate(iterations.begin(), iterations.end(), 0.0);
  state.counters["rounds"] = rounds / static_cast<double>(kSamples);
}

}  // namespace

int main(int argc, char** argv) {
  for (const char* metric : {"platform", "stiffness"}) {
    for (const double size : {0.1, 1.0}) {
      for (const std::string& isa : bench::instruction_sets()) {
        const std::string name = std::string(metric) + "/" + (size < 1.0 ? "0.1" : "1") + "/" + isa;
        benchmark::RegisterBenchmark(name.c_str(), solves, Case{metric, size, isa});
      }
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
