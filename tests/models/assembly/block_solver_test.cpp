#include "models/assembly/block_solver.h"

#include <gtest/gtest.h>

#include <bit>
#include <numeric>

#include "tests/models/assembly/made.h"
#include "tests/support/isa.h"

// The kernel against plain Newton, and against itself: a sample does not depend on its neighbours.
namespace poesy::assembly {
namespace {

/// Samples of all errors.
struct Samples {
  std::vector<std::vector<double>> errors;  ///< [count][F]
  std::vector<double> values = {};          ///< [F x count]
  std::vector<FactorIndex> varied = {};
  std::vector<double> constant = {};

  SampleBlock block() {
    constant.assign(errors.front().size(), 0.0);
    values.clear();
    varied.clear();
    for (std::size_t f = 0; f < constant.size(); ++f) {
      varied.emplace_back(f);
      for (const std::vector<double>& sample : errors) values.push_back(sample[f]);
    }
    return {{}, constant, varied, values, errors.size()};
  }
};

Samples drawn(const AssemblyModel& model, double size, std::size_t count) {
  Samples samples;
  for (std::size_t b = 0; b < count; ++b) samples.errors.push_back(random_errors(model, size, unsigned(100 + b)));
  return samples;
}

/// All that a solution says: bodies, displacements, wrenches.
std::vector<double> numbers_of(const Solution& solution) {
  std::vector<double> all;
  for (const Transform& body : solution.bodies) {
    all.insert(all.end(), body.R.data(), body.R.data() + 9);
    all.insert(all.end(), body.p.begin(), body.p.end());
  }
  all.insert(all.end(), solution.displacements.begin(), solution.displacements.end());
  for (const Screw& wrench : solution.wrenches) all.insert(all.end(), wrench.begin(), wrench.end());
  for (const Screw& xi : solution.mismatch) all.insert(all.end(), xi.begin(), xi.end());
  return all;
}

class AssemblyKernel : public test::WithIsa {};

TEST_P(AssemblyKernel, AgreesWithPlainNewton) {
  for (const Case& one : cases()) {
    for (const Metric metric : kMetrics) {
      const AssemblyModel model = made(one.text(), metric);
      const Nominal pose = model.at(one.pose);
      const double reach = model.assembly.reach;
      BlockSolver solver(model, kOptions);
      for (const double size : {0.1, 1.0}) {
        Samples samples = drawn(model, size, 40);
        solver.solve(pose, samples.block(), [&](std::size_t b, const Solution& found) {
          SCOPED_TRACE(std::string(one.name) + (metric == Metric::stiffness ? ", stiffness" : ", platform") +
                       ", size " + std::to_string(size) + ", sample " + std::to_string(b));
          const Solution wanted = solution_of(model, pose, samples.errors[b]);
          EXPECT_EQ(found.status, wanted.status);
          if (!solved(found.status) || !solved(wanted.status)) return;
          for (std::size_t k = kPlatform; k < pose.bodies.size(); ++k) {
            EXPECT_LE((found.bodies[k].p - wanted.bodies[k].p).norm(), 1e-12 * reach);
            EXPECT_LE((found.bodies[k].R - wanted.bodies[k].R).norm(), 1e-12);
          }
          if (metric != Metric::stiffness) return;
          double most = 0.0;
          for (const Screw& wrench : wanted.wrenches) {
            most = std::max({most, wrench.tail<3>().norm(), wrench.head<3>().norm() / reach});
          }
          for (std::size_t e = 0; e < wanted.wrenches.size(); ++e) {
            const Screw apart = found.wrenches[e] - wanted.wrenches[e];
            EXPECT_LE(apart.tail<3>().norm(), 1e-9 * most);
            EXPECT_LE(apart.head<3>().norm(), 1e-9 * most * reach);
          }
        });
      }
    }
  }
}

TEST_P(AssemblyKernel, IsTheSameAtAnyPlace) {
  constexpr std::size_t kCount = 37;
  for (const Case& one : cases()) {
    const AssemblyModel model = made(one.text(), Metric::stiffness);
    const Nominal pose = model.at(one.pose);
    BlockSolver solver(model, kOptions);
    Samples samples = drawn(model, 1.0, kCount);
    std::vector<std::vector<double>> wanted(kCount);
    std::vector<std::uint32_t> rounds(kCount);
    solver.solve(pose, samples.block(), [&](std::size_t b, const Solution& found) {
      wanted[b] = numbers_of(found);
      rounds[b] = found.iterations;
    });
    std::vector<std::size_t> order(kCount);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (const unsigned seed : {1u, 2u, 3u}) {
      std::ranges::shuffle(order, std::mt19937(seed));
      const std::size_t count = kCount - 5 * seed;  // blocks of other sizes, too
      Samples others;
      for (std::size_t k = 0; k < count; ++k) others.errors.push_back(samples.errors[order[k]]);
      solver.solve(pose, others.block(), [&](std::size_t k, const Solution& found) {
        EXPECT_EQ(found.iterations, rounds[order[k]]);
        const std::vector<double> numbers = numbers_of(found);
        for (std::size_t n = 0; n < numbers.size(); ++n) {
          ASSERT_EQ(std::bit_cast<std::uint64_t>(numbers[n]), std::bit_cast<std::uint64_t>(wanted[order[k]][n]))
              << one.name << ", sample " << order[k] << " at " << k << ", number " << n;
        }
      });
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Isa, AssemblyKernel, testing::ValuesIn(test::kEveryIsa), test::isa_name);

}  // namespace
}  // namespace poesy::assembly
