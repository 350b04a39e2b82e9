#include <benchmark/benchmark.h>

#include <random>
#include <string>
#include <vector>

#include "bench/instruction_sets.h"
#include "models/registry.h"
#include "models/three_prs/closure.h"

namespace {

using namespace poesy;

constexpr std::size_t kPoses = 20;
// Number of blocks of samples. They fit in the second-level cache of a core, where samples that were just drawn would
// also be.
constexpr std::size_t kBlocks = 2;
constexpr std::size_t kSamples = 1000;

/// Solves every sample by close_limbs(), the scalar reference.
class ReferenceEvaluator final : public Evaluator {
 public:
  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    using namespace three_prs;
    const Configuration nominal = configuration({}, {samples.pose[0], samples.pose[1], samples.pose[2]});
    const ClosureStart start({}, nominal);
    for (std::size_t b = 0; b < samples.count; ++b) {
      const auto limbs = limbs_of_sample({}, nominal, samples, b);
      PlatformMotion motion = start(limbs);
      const Closing closing = close_limbs(limbs, nominal.platform.p, start.orientation(), {}, motion);
      const lie::Vector3<double> theta = lie::log(motion.E);
      for (std::size_t k = 0; k < 3; ++k) {
        outcomes.responses[k * samples.count + b] = theta[static_cast<Eigen::Index>(k)];
        outcomes.responses[(k + 3) * samples.count + b] = motion.dr[static_cast<Eigen::Index>(k)];
      }
      outcomes.status[b] = closing.status;
      outcomes.iterations[b] = closing.iterations;
    }
  }
};

/// One case of the benchmark: the errors that vary, and how their samples are solved.
struct Case {
  std::size_t fidelity;
  std::string isa;  ///< instruction set, or "scalar" for ReferenceEvaluator
  std::vector<FactorIndex> varied;
};

std::unique_ptr<Evaluator> evaluator_of(const Case& which, const ModelDescription& description) {
  if (which.isa == "scalar") return std::make_unique<ReferenceEvaluator>();
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : description.geometry) geometry.push_back(parameter.published);
  const auto model = find(registry(), description.name)->build(geometry, which.fidelity);
  return bench::evaluator_with(which.isa, *model, {});
}

/// Measures solves of blocks of samples with normal errors of 0.1 mm and 0.1 mrad (standard deviations), each block at
/// a different pose.
void solves(benchmark::State& state, const Case& which) {
  const ModelDescription& description = find(registry(), "3-prs")->description;
  const std::unique_ptr<Evaluator> evaluator = evaluator_of(which, description);
  std::mt19937_64 engine(1);
  std::vector<double> poses;
  for (std::size_t n = 0; n < 3 * kPoses; ++n) {
    poses.push_back(
        std::uniform_real_distribution<double>(description.pose_lower[n % 3], description.pose_upper[n % 3])(engine));
  }
  std::normal_distribution<double> error(0.0, 1e-4);
  const std::size_t size = which.varied.size() * kSamples;
  std::vector<double> values(kBlocks * size);
  for (double& value : values) value = error(engine);
  const std::vector<double> errors(description.factors.size(), 0.0);
  std::vector<double> responses(description.responses.size() * kSamples);
  std::vector<SolveStatus> status(kSamples);
  std::vector<std::uint32_t> iterations(kSamples);
  double total = 0.0, iterated = 0.0;
  std::size_t n = 0;
  for (auto _ : state) {
    evaluator->evaluate({std::span(poses).subspan(3 * (n % kPoses), 3), errors, which.varied,
                         std::span(values).subspan(n % kBlocks * size, size), kSamples},
                        {responses, status, iterations, {}});
    benchmark::ClobberMemory();
    if (n < kPoses) {
      for (const std::uint32_t each : iterations) iterated += each;
      total += kSamples;
    }
    ++n;
  }
  state.counters["solves/s"] = benchmark::Counter(static_cast<double>(n * kSamples), benchmark::Counter::kIsRate);
  state.counters["iterations/solve"] = benchmark::Counter(iterated / total, benchmark::Counter::kAvgThreads);
}

void add(const std::string& name, const Case& which) {
  benchmark::RegisterBenchmark(("3-prs/" + name + "/" + which.isa).c_str(),
                               [=](benchmark::State& state) { solves(state, which); })
      ->ThreadRange(1, 2)
      ->UseRealTime()
      ->MeasureProcessCPUTime()
      ->Unit(benchmark::kMicrosecond);
}

void add_all() {
  constexpr std::size_t kExact = 0, kFirstOrder = 1;
  const ModelDescription& description = find(registry(), "3-prs")->description;
  const std::vector<FactorIndex>& all = description.find_set("all")->factors;
  const std::vector<FactorIndex> one{*description.find_factor("theta_A_x_2")};
  add("exact, 51 errors", {kExact, "scalar", all});
  add("exact, 1 error", {kExact, "scalar", one});
  for (const std::string& isa : bench::instruction_sets()) {
    add("exact, 51 errors", {kExact, isa, all});
    add("exact, 1 error", {kExact, isa, one});
    add("first order, 51 errors", {kFirstOrder, isa, all});
  }
}

}  // namespace

int main(int argc, char** argv) {
  add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
