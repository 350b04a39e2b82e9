#include <fmt/format.h>

#include "bench/counting_number.h"
#include "bench/instruction_sets.h"
#include "bench/published_study.h"
#include "engine/run/evaluate_unit.h"
#include "models/assembly/kernel.h"
#include "models/assembly/kernels.h"
#include "models/chain/block_kernel.h"
#include "models/chain/block_kernels.h"

// In this program, the kernels of the instruction set "plain" are compiled for CountingNumber. The linker takes these
// definitions instead of the library's; all other code is that of the library.
namespace poesy::assembly {

template <>
Kernels kernels<simd::Isa::plain>() {
  return {solve_assemblies<bench::CountingNumber>, map_assemblies<bench::CountingNumber>};
}

}  // namespace poesy::assembly

namespace poesy::chain {

template <>
Kernels kernels<simd::Isa::plain>() {
  return {solve_block<bench::CountingNumber>, map_block<bench::CountingNumber>,
          move_platform_block<bench::CountingNumber>};
}

}  // namespace poesy::chain

namespace {

using namespace poesy;

/// Prints the numbers of operations and bytes as a line of JSON. varied: number of errors that vary in a solve.
/// responses: number of responses of a solve.
void print(const char* name, const SolveCounts& counts, std::size_t varied, std::size_t responses) {
  const auto solves = static_cast<double>(counts.total());
  const auto iterations = static_cast<double>(counts.iterations);
  const bench::OperationCounts& did = bench::operation_counts;
  const auto total = static_cast<double>(did.total());
  const auto share = [total](std::uint64_t operations) { return static_cast<double>(operations) / total; };
  fmt::print(R"({{"case": "{}", "operations_per_solve": {:.0f}, "operations_per_iteration": {:.0f}, )"
             R"("iterations_per_solve": {:.3f}, "share_in_multiply_adds": {:.3f}, "share_of_divisions": {:.4f}, )"
             R"("bytes_per_solve": {}}})"
             "\n",
             name, total / solves, total / iterations, iterations / solves, 2.0 * share(did.multiply_adds),
             share(did.divisions + did.roots), sizeof(double) * (varied + responses));
}

/// Counts the operations of work units (WorkUnit) of a study that varies one error at a time, including the prediction
/// of starting points. units: number of units.
void count_units(const char* name, Study study, SolverOptions::Method method, std::size_t units) {
  study.solver.method = method;
  const auto model = build_model(study.mechanism);
  const Plan plan(study, select_poses(study.poses, *model).poses);
  UnitEvaluator evaluate(plan, *model);
  SolveCounts counts;
  bench::operation_counts = {};
  for (std::size_t n = 0; n < units; ++n) counts.merge(evaluate(bench::scattered_unit(plan, n)).solves);
  print(name, counts, 1, study.model().responses.size());
}

constexpr std::size_t kCount = 100;

void count_all_errors(const char* name, const Study& study, double scale) {
  const auto model = build_model(study.mechanism);
  const PoseSet poses = select_poses(study.poses, *model).poses;
  const auto evaluator = model->evaluator(study.solver);
  const std::vector<double> zeros(study.model().factors.size(), 0.0);
  std::vector<FactorIndex> varied;
  for (std::size_t f = 0; f < zeros.size(); ++f) varied.emplace_back(f);
  std::vector<double> responses(study.model().responses.size() * kCount);
  std::vector<SolveStatus> status(kCount);
  std::vector<std::uint32_t> iterations(kCount);
  SolveCounts counts;
  bench::operation_counts = {};
  for (std::size_t m = 0; m < poses.size(); ++m) {
    const std::vector<double> values = bench::samples_of_all_errors(study, scale, PoseIndex(m), kCount);
    evaluator->evaluate({poses[PoseIndex(m)], zeros, varied, values, kCount}, {responses, status, iterations, {}});
    for (std::size_t b = 0; b < kCount; ++b) counts.add(status[b], iterations[b]);
  }
  print(name, counts, varied.size(), study.model().responses.size());
}

}  // namespace

/// Counts the floating-point operations of solves, one sample at a time, and the bytes that a solve must read and write
/// (values of the varied errors and responses). Prints a JSON object in each line.
int main() {
  bench::choose_instruction_set("plain");
  using Method = SolverOptions::Method;
  const Study published = bench::published_study(bench::kPublishedPoses, bench::kPublishedSamples);
  const Study platform = bench::platform_study(bench::kPublishedPoses, bench::kPublishedSamples);
  const Study first_order = bench::platform_study(bench::kPublishedPoses, bench::kPublishedSamples, 1);
  count_units("gauss-newton", published, Method::gauss_newton, 50);
  count_units("newton", published, Method::newton, 200);
  count_all_errors("published/all_errors/1_mm_1_deg", published, 1.0);
  count_all_errors("published/all_errors/0.1_mm_0.1_deg", published, 0.1);
  count_units("platform gauss-newton", platform, Method::gauss_newton, 200);
  count_units("platform newton", platform, Method::newton, 200);
  count_units("platform first-order", first_order, Method::newton, 200);
  count_all_errors("platform/all_errors/1_mm_1_deg", platform, 1.0);
  count_all_errors("platform/all_errors/0.1_mm_0.1_deg", platform, 0.1);
  count_all_errors("first-order/all_errors", first_order, 1.0);
}
