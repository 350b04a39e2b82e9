// Tests that the hot loop does not allocate memory. Every operator new of this program is counted.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <random>
#include <vector>

#include "bench/published_study.h"
#include "engine/model/own_responses.h"
#include "engine/model/platform_points.h"
#include "engine/run/evaluate_unit.h"
#include "models/registry.h"
#include "tests/models/chain/block_samples.h"
#include "tests/support/kinds.h"

namespace {

std::atomic<std::size_t> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  // aligned_alloc requires a size that is a multiple of the alignment.
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded)) return memory;
  throw std::bad_alloc();
}

/// Not inlined, because GCC would warn about free() where it expects delete.
[[gnu::noinline]] void release(void* memory) noexcept { std::free(memory); }

}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new[](std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace poesy {
namespace {

template <class Work>
std::size_t allocations_of(const Work& work) {
  const std::size_t before = allocations;
  work();
  return allocations - before;
}

TEST(Allocation, IsCounted) {
  std::unique_ptr<double> kept;
  EXPECT_EQ(allocations_of([&] { kept = std::make_unique<double>(1.0); }), 1u);
}

/// Blocks of samples with small errors. With large errors chain::Assembly allocates when it decides whether a machine
/// can be assembled.
std::vector<chain::BlockSamples> blocks(std::size_t count) {
  std::mt19937_64 engine(61);
  std::vector<chain::BlockSamples> all;
  for (std::size_t factor = 0; factor < 71; factor += 5) {
    all.push_back(chain::single_error_samples(chain::random_pose(engine), factor, 0.01, count, engine));
    all.back().range = 4.0 * chain::unit_of(all.back().varied[0]);
  }
  all.push_back(chain::all_error_samples(chain::random_pose(engine), 0.01, count, engine));
  return all;
}

void expect_no_allocations(const std::vector<chain::BlockSamples>& all, const SolverOptions& options,
                           chain::Fidelity fidelity) {
  chain::BlockSolver solver(all[0].chain, options, fidelity);
  const auto solve_all = [&] {
    for (const chain::BlockSamples& samples : all) {
      chain::prepare(solver, samples);
      solver.solve(samples.values, samples.count);
    }
  };
  EXPECT_GT(allocations_of(solve_all), 0u);
  EXPECT_EQ(allocations_of(solve_all), 0u);
}

TEST(Allocation, NoneInAWarmBlockSolver) {
  const std::vector<chain::BlockSamples> all = blocks(1000);
  expect_no_allocations(all, {}, chain::Fidelity::exact);
  expect_no_allocations(all, chain::gauss_newton(), chain::Fidelity::exact);
  expect_no_allocations(all, {}, chain::Fidelity::first_order);
}

/// The factors of a set in reverse order, so that the errors of the head and of the slides are not in the order of the
/// model.
std::vector<FactorIndex> reversed(const ModelDescription& model, const char* set) {
  const std::vector<FactorIndex>& factors = model.find_set(set)->factors;
  return {factors.rbegin(), factors.rend()};
}

TEST(Allocation, NoneInAWarmHybridMachine) {
  constexpr std::size_t kCount = 1000;
  const CatalogEntry& entry = *find(registry(), "xy-3-prs");
  const ModelDescription& description = entry.description;
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : description.geometry) geometry.push_back(parameter.published);
  const std::vector<double> pose{0.1, -0.2, 0.8, 0.1, -0.1}, errors(description.factors.size(), 1e-4);
  std::vector<double> responses(description.responses.size() * kCount), details(3 * kCount);
  std::vector<SolveStatus> status(kCount);
  std::vector<std::uint32_t> iterations(kCount);
  for (std::size_t fidelity = 0; fidelity < description.fidelities.size(); ++fidelity) {
    const auto evaluator = entry.build(geometry, fidelity)->evaluator({});
    for (const std::vector<FactorIndex>& varied :
         {reversed(description, "all"), description.find_set("head")->factors, reversed(description, "slides")}) {
      const std::vector<double> values(varied.size() * kCount, 1e-3);
      const auto evaluate = [&] {
        evaluator->evaluate({pose, errors, varied, values, kCount}, {responses, status, iterations, details});
      };
      evaluate();
      EXPECT_EQ(allocations_of(evaluate), 0u);
    }
  }
}

TEST(Allocation, NoneByResponsesOfOnesOwn) {
  constexpr std::size_t kCount = 200;
  const CatalogEntry& entry = *find(registry(), "3-prs");
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  const auto no_turn = [](std::span<const double>) { return std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}; };
  std::vector<OwnResponse> own{{"far", Dimension::length, false, {{2}}}, {"step", Dimension::length, false, {{3}}}};
  own[0].relative_to = ReferencePose{{0.0, 0.0, 0.65}, {}};
  own[1].relative_to = ReferencePose{};
  const std::unique_ptr<Model> model = with_responses(
      with_platform_points(entry.build(geometry, 0), {{"nozzle", {0.0, 0.0, 0.1}}}, no_turn, false), std::move(own));
  const std::vector<FactorIndex>& varied = entry.description.find_set("all")->factors;
  const std::vector<double> errors(varied.size(), 0.0), values(varied.size() * kCount, 1e-5);
  std::vector<double> responses(model->description().responses.size() * kCount);
  std::vector<SolveStatus> status(kCount);
  std::vector<std::uint32_t> iterations(kCount);
  const std::array<std::vector<double>, 2> poses{{{0.1, 0.0, 0.6}, {0.0, 0.1, 0.62}}};
  const auto evaluator = model->evaluator({});
  const auto evaluate = [&] {
    evaluator->evaluate({poses[0], errors, varied, values, kCount}, {responses, status, iterations, {}});
    evaluator->evaluate({poses[1], errors, varied, values, kCount, 0.0, poses[0]}, {responses, status, iterations, {}});
  };
  evaluate();
  evaluate();
  EXPECT_EQ(allocations_of(evaluate), 0u);
}

/// The mean number of allocations in a unit of a warm evaluator, without the list of failed samples in units that have
/// any. The errors are small, as in blocks().
template <class UnitOfWork>
double allocations_per_unit(test::KindOfStudy kind, std::size_t samples) {
  Study study = bench::published_study(4, samples);
  study.analysis.kind = kind;
  for (Distribution& error : study.errors.by_factor) error = Distribution::normal(0.1 * error.standard_deviation());
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const Plan plan(study, select_poses(study.poses, *model).poses);
  UnitOfWork evaluate(plan, *model);
  std::size_t with_failures = 0;
  const auto evaluate_all = [&] {
    with_failures = 0;
    for (std::size_t u = 0; u < plan.units(); ++u) {
      if (!evaluate(plan.unit(u)).failed.first().empty()) ++with_failures;
    }
  };
  evaluate_all();
  const std::size_t warm = allocations_of(evaluate_all) - with_failures;
  return static_cast<double>(warm) / static_cast<double>(plan.units());
}

TEST(Allocation, NonePerSampleInAUnit) {
  // Allocations of a unit: the nominal displacements of the pose, the moments of the three responses, and the indices
  // within the unit.
  const auto count = [](std::size_t samples) {
    return allocations_per_unit<UnitEvaluator>(&sensitivity::kStudy, samples);
  };
  EXPECT_LE(count(Plan::kUnitSamples), 5.0);
  EXPECT_EQ(count(101), count(Plan::kUnitSamples));
  EXPECT_EQ(count(101), std::floor(count(101))) << "every unit allocates alike";
}

TEST(Allocation, NonePerSampleInAMonteCarloUnit) {
  // In addition to those of a sensitivity unit: the buckets of the quantile sketches of the three responses, and the
  // sums for the main effects.
  const auto count = [](std::size_t samples) {
    return allocations_per_unit<PoseUnitEvaluator>(&monte_carlo::kStudy, samples);
  };
  EXPECT_LE(count(10), 32.0);
  EXPECT_LE(count(Plan::kUnitSamples), 32.0);
}

}  // namespace
}  // namespace poesy
