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
#include "models/assembly/model.h"
#include "models/file/branched_model.h"
#include "models/registry.h"

namespace {

using namespace poesy;

constexpr std::size_t kSamples = 1000;

/// A mechanism of tests/data/mechanisms at a pose.
struct Mechanism {
  std::string file;          ///< its name, without ".toml"
  std::string metric;        ///< by which it is solved
  std::vector<double> pose;  ///< SI; empty: the middle of the workspace
};

/// By which code.
enum class Code {
  product,     ///< that which a study takes
  assembly,    ///< limbs against bodies, also where the product compares limbs in pairs
  first_order  ///< limbs against bodies, to first order
};

/// What is measured.
struct Case {
  Mechanism mechanism;
  Code code;
  double size;       ///< standard deviation of errors, mm and deg
  std::string isa;   ///< instruction set
  bool one = false;  ///< whether errors vary one after the other, in ranges that are known, and not all at once
};

std::string text_of(const Mechanism& mechanism) {
  std::ifstream file(POESY_MECHANISMS "/" + mechanism.file + ".toml");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The product's model.
std::unique_ptr<Model> built(const Mechanism& mechanism) {
  const CatalogEntry entry = registry().from_text(text_of(mechanism), mechanism.file);
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  return by_metric(entry, mechanism.metric).build(geometry, 0);
}

assembly::AssemblyModel assembly_of(const Mechanism& mechanism) {
  const file::MechanismFile read = file::read_mechanism_file(text_of(mechanism), mechanism.file);
  const file::Checked found =
      file::checked(file::mechanism(read, file::default_geometry(read)), file::Workspace::as_it_is);
  return file::assembly_model(
      found.mechanism, std::make_shared<const file::Tracker>(found.mechanism), found.home,
      mechanism.metric == "stiffness" ? assembly::Metric::stiffness : assembly::Metric::platform);
}

/// A block of normal errors at one pose, solved again and again.
void solves(benchmark::State& state, const Case& which) {
  const std::unique_ptr<Model> model = built(which.mechanism);
  const assembly::AssemblyModel limbs = assembly_of(which.mechanism);
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
  const bool of_product = which.code == Code::product;
  const std::size_t rows = of_product ? model->description().responses.size() : assembly::responses_of(limbs).size();
  std::vector<double> responses(rows * kSamples);
  std::vector<SolveStatus> status(kSamples);
  std::vector<std::uint32_t> iterations(kSamples);
  bench::choose_instruction_set(which.isa);
  const auto fidelity = which.code == Code::first_order ? chain::Fidelity::first_order : chain::Fidelity::exact;
  const std::unique_ptr<Evaluator> evaluator =
      of_product ? model->evaluator(options) : assembly::assembly_evaluator(limbs, options, fidelity);
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

/// Whether the product compares limbs in pairs, or with one platform where they can meet.
bool is_unbranched(const Mechanism& mechanism) {
  return mechanism.file == "upr2-rpu" || mechanism.file == "tripteron" || mechanism.file == "ups6" ||
         mechanism.file == "rps3" || mechanism.file == "rrr3";
}

}  // namespace

int main(int argc, char** argv) {
  const auto add = [](const Case& one, const std::string& what) {
    const std::string name = one.mechanism.file + "/" + one.mechanism.metric + "/" + what + "/" + one.isa;
    benchmark::RegisterBenchmark(name.c_str(), solves, one);
  };
  for (const Mechanism& mechanism : kMechanisms) {
    for (const std::string& isa : bench::instruction_sets()) {
      add({mechanism, Code::assembly, 0.1, isa}, "0.1");
      add({mechanism, Code::assembly, 1.0, isa}, "1");
      add({mechanism, Code::assembly, 1.0, isa, true}, "one");
      add({mechanism, Code::first_order, 0.1, isa}, "first-order");
      if (!is_unbranched(mechanism)) continue;
      add({mechanism, Code::product, 0.1, isa}, "0.1/pairs");
      add({mechanism, Code::product, 1.0, isa}, "1/pairs");
      add({mechanism, Code::product, 1.0, isa, true}, "one/pairs");
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
