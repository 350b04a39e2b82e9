#include <benchmark/benchmark.h>

#include <random>
#include <string_view>
#include <vector>

#include "models/registry.h"

namespace {

using namespace poesy;

constexpr std::size_t kSamples = 1000;

/// Blocks of normal errors of 0.1 mm and 0.1 mrad at one pose, one thread.
class Blocks {
 public:
  Blocks(std::size_t fidelity, std::string_view factors) : entry_(*find(registry(), "3-prs")) {
    std::vector<double> geometry;
    for (const GeometryParameter& parameter : entry_.description.geometry) geometry.push_back(parameter.published);
    model_ = entry_.build(geometry, fidelity);
    evaluator_ = model_->evaluator({});
    varied_ = entry_.description.find_set(factors)->factors;
    errors_.assign(entry_.description.factors.size(), 0.0);
    responses_.resize(entry_.description.responses.size() * kSamples);
    std::mt19937_64 engine(1);
    std::normal_distribution<double> error(0.0, 1e-4);
    values_.resize(varied_.size() * kSamples);
    for (double& value : values_) value = error(engine);
  }

  void evaluate() {
    evaluator_->evaluate({pose_, errors_, varied_, values_, kSamples}, {responses_, status_, iterations_, {}});
  }

  double mean_iterations() const {
    double sum = 0.0;
    for (const std::uint32_t iterations : iterations_) sum += iterations;
    return sum / kSamples;
  }

 private:
  const CatalogEntry& entry_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<FactorIndex> varied_;
  std::vector<double> pose_{0.1, -0.2, 0.8}, errors_, values_, responses_;
  std::vector<SolveStatus> status_ = std::vector<SolveStatus>(kSamples);
  std::vector<std::uint32_t> iterations_ = std::vector<std::uint32_t>(kSamples);
};

void solves(benchmark::State& state, std::size_t fidelity, std::string_view factors) {
  Blocks blocks(fidelity, factors);
  for (auto _ : state) {
    blocks.evaluate();
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
  state.counters["iterations"] = blocks.mean_iterations();
}

}  // namespace

BENCHMARK_CAPTURE(solves, exact_all_errors, 0, "all")->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(solves, exact_three_errors, 0, "rod-length")->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(solves, first_order_all_errors, 1, "all")->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(solves, first_order_three_errors, 1, "rod-length")->UseRealTime()->MeasureProcessCPUTime();
