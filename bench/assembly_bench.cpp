#include <benchmark/benchmark.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "bench/instruction_sets.h"
#include "models/chain/block_solver.h"
#include "models/registry.h"

namespace {

using namespace poesy;

constexpr std::size_t kSamples = 1000;

/// Indices in ModelDescription::fidelities for mechanisms from files.
/// @{
constexpr std::size_t kExact = static_cast<std::size_t>(chain::Fidelity::exact);
constexpr std::size_t kFirstOrder = static_cast<std::size_t>(chain::Fidelity::first_order);
/// @}

/// A mechanism of tests/data/mechanisms at a pose.
struct Mechanism {
  std::string file;          ///< name of the file, without ".toml"
  std::string metric;        ///< metric of the model: "platform" or "stiffness"
  std::vector<double> pose;  ///< pose (SI); empty: the middle of the workspace
};

struct Case {
  Mechanism mechanism;
  std::size_t fidelity;  ///< index in ModelDescription::fidelities
  double size;           ///< standard deviation of errors, mm and deg
  std::string isa;       ///< instruction set
  bool one = false;      ///< true: only one error varies in each block, in a known range; false: all errors vary
};

std::string text_of(const Mechanism& mechanism) {
  std::ifstream file(POESY_MECHANISMS "/" + mechanism.file + ".toml");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::unique_ptr<Model> built(const Mechanism& mechanism, std::size_t fidelity) {
  const CatalogEntry entry = registry().from_text(text_of(mechanism), mechanism.file);
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  return by_metric(entry, mechanism.metric).build(geometry, fidelity);
}

/// Measures solves of a block of kSamples samples with normal errors at one pose.
void solves(benchmark::State& state, const Case& which) {
  const std::unique_ptr<Model> model = built(which.mechanism, which.fidelity);
  std::vector<double> pose = which.mechanism.pose;
  for (std::size_t k = pose.size(); k < model->description().pose_lower.size(); ++k) {
    pose.push_back(0.5 * (model->description().pose_lower[k] + model->description().pose_upper[k]));
  }
  const SolverOptions options{.tolerance = model->description().tolerance};
  const std::size_t errors = model->description().factors.size();
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  std::vector<double> values;
  std::vector<FactorIndex> varied;
  for (const Factor& factor : model->description().factors) {
    varied.emplace_back(varied.size());
    const double unit = factor.dimension == Dimension::length ? 1e-3 : 1.7453292519943295e-2;
    for (std::size_t b = 0; b < kSamples; ++b) values.push_back(which.size * unit * normal(engine));
  }
  const std::vector<double> none(errors, 0.0);
  std::vector<double> responses(model->description().responses.size() * kSamples);
  std::vector<SolveStatus> status(kSamples);
  std::vector<std::uint32_t> iterations(kSamples);
  bench::choose_instruction_set(which.isa);
  const std::unique_ptr<Evaluator> evaluator = model->evaluator(options);
  std::size_t n = 0;
  for (auto _ : state) {
    SampleBlock block{pose, none, varied, values, kSamples};
    if (which.one) {
      block.varied = block.varied.subspan(n, 1);
      block.values = block.values.subspan(n * kSamples, kSamples);
      block.range = *std::ranges::max_element(block.values);
      n = (n + 1) % errors;
    }
    evaluator->evaluate(block, {responses, status, iterations, {}});
    benchmark::DoNotOptimize(responses.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
  const auto rounds = std::accumulate(iterations.begin(), iterations.end(), 0.0);
  state.counters["rounds"] = rounds / static_cast<double>(kSamples);
}

const std::vector<Mechanism> kMechanisms{{"linear-delta", "platform", {0.03, -0.02, 0.2}},
                                         {"linear-delta", "stiffness", {0.03, -0.02, 0.2}},
                                         {"delta-parallelogram", "platform", {-0.03, 0.04, 0.16}},
                                         {"upr2-rpu-beams", "stiffness", {-0.25, 0.2, -0.15}},
                                         {"upr2-rpu", "platform", {-0.25, 0.2, -0.15}},
                                         {"tripteron", "platform", {}},
                                         {"ups6", "platform", {}},
                                         {"rps3", "platform", {}},
                                         {"rrr3", "platform", {}}};

}  // namespace

int main(int argc, char** argv) {
  const auto add = [](const Case& one, const std::string& what) {
    const std::string name = one.mechanism.file + "/" + one.mechanism.metric + "/" + what + "/" + one.isa;
    benchmark::RegisterBenchmark(name.c_str(), solves, one);
  };
  for (const Mechanism& mechanism : kMechanisms) {
    for (const std::string& isa : bench::instruction_sets()) {
      add({mechanism, kExact, 0.1, isa}, "0.1");
      add({mechanism, kExact, 1.0, isa}, "1");
      add({mechanism, kExact, 1.0, isa, true}, "one");
      add({mechanism, kFirstOrder, 0.1, isa}, "first-order");
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
