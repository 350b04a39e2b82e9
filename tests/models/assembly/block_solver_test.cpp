#include "models/assembly/block_solver.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "models/assembly/first_order.h"
#include "tests/models/assembly/made.h"
#include "tests/support/isa.h"

// Compares the SIMD kernel with the plain Newton solver and the plain first-order solution. Also tests that a sample
// does not depend on the other samples of its block.
namespace poesy::assembly {
namespace {

/// Samples in which all errors vary.
struct Samples {
  std::vector<std::vector<double>> errors;  ///< [count][errors]
  std::vector<double> values = {};          ///< [errors x count]
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

/// The model of a case that reports all components of each limb's wrench.
AssemblyModel with_reactions(const Case& one, Metric metric) {
  AssemblyModel model = made(one.text(), metric);
  model.report.reactions.clear();
  for (std::size_t e = 0; e < model.assembly.limbs.size(); ++e) model.report.reactions.push_back({e, 0, "first"});
  return model;
}

/// The outcomes of a block of samples.
struct Block {
  std::vector<double> responses;  ///< [responses x count]
  std::vector<SolveStatus> status;
  std::vector<std::uint32_t> iterations;

  /// The responses of sample b.
  std::vector<double> of(std::size_t b) const {
    std::vector<double> values;
    for (std::size_t at = b; at < responses.size(); at += status.size()) values.push_back(responses[at]);
    return values;
  }
};

enum class How { solve, map };

Block block_of(const AssemblyModel& model, PoseProblem& problem, How how, Samples& samples,
               const SolverOptions& options = kOptions) {
  const std::size_t count = samples.errors.size();
  Block made{std::vector<double>(responses_of(model).size() * count), std::vector<SolveStatus>(count),
             std::vector<std::uint32_t>(count)};
  BlockSolver solver(model, options);
  const OutcomeBlock outcomes{made.responses, made.status, made.iterations, {}};
  how == How::solve ? solver.solve(problem, samples.block(), outcomes) : solver.map(problem, samples.block(), outcomes);
  return made;
}

/// Expects the same responses of one sample. of_reach: tolerance of lengths divided by the reach, and of angles (rad).
/// of_forces: tolerance of other responses, relative to the largest one of their kind.
void expect_same_responses(const AssemblyModel& model, const std::vector<double>& found,
                           const std::vector<double>& wanted, double of_reach, double of_forces) {
  const std::vector<Response> responses = responses_of(model);
  ASSERT_EQ(found.size(), responses.size());
  Answers all{responses, wanted, model.assembly.reach};
  const std::map<Dimension, double> largest = largest_of(all);
  const auto tolerance = [&](Dimension dimension) {
    if (dimension == Dimension::length) return of_reach * model.assembly.reach;
    if (dimension == Dimension::angle) return of_reach;
    return of_forces * largest.at(dimension);
  };
  for (std::size_t r = 0; r < found.size(); ++r) {
    EXPECT_NEAR(found[r], wanted[r], tolerance(responses[r].dimension)) << responses[r].name;
  }
}

class AssemblyKernel : public test::WithIsa {};

template <class Check>
void for_each_sample(std::size_t count, Check check) {
  for (const Case& one : cases()) {
    for (const Metric metric : kMetrics) {
      const AssemblyModel model = with_reactions(one, metric);
      PoseProblem problem(model, model.at(one.pose), kOptions);
      for (const double size : {0.1, 1.0}) {
        Samples samples = drawn(model, size, count);
        SCOPED_TRACE(std::string(one.name) + (metric == Metric::stiffness ? ", stiffness" : ", platform") + ", size " +
                     std::to_string(size));
        check(model, problem, samples);
      }
    }
  }
}

TEST_P(AssemblyKernel, AgreesWithPlainNewton) {
  for_each_sample(40, [](const AssemblyModel& model, PoseProblem& problem, Samples& samples) {
    const Block found = block_of(model, problem, How::solve, samples);
    for (std::size_t b = 0; b < samples.errors.size(); ++b) {
      SCOPED_TRACE("sample " + std::to_string(b));
      const Nominal& pose = problem.pose();
      Solution wanted = solution_of(model, pose, samples.errors[b]);
      // Plain Newton neglects that joints turn under wrenches. With large wrenches it therefore needs many small steps.
      const bool is_hard = solved(found.status[b]) && !solved(wanted.status);
      if (is_hard) wanted = solution_of(model, pose, samples.errors[b], 100 * kOptions.max_iterations);
      EXPECT_EQ(found.status[b], is_hard ? SolveStatus::converged : wanted.status);
      EXPECT_EQ(solved(found.status[b]), solved(wanted.status));
      if (!solved(found.status[b]) || !solved(wanted.status)) continue;
      const Outcome outcome = outcome_of(model.assembly, pose, wanted);
      expect_same_responses(model, found.of(b),
                            response_values(model.assembly, model.report, model.deforms, pose, outcome),
                            is_hard ? 1e-10 : 2e-12, 1e-9);
    }
  });
}

TEST_P(AssemblyKernel, MapsAsThePlainFirstOrder) {
  for_each_sample(13, [](const AssemblyModel& model, PoseProblem& problem, Samples& samples) {
    const Block found = block_of(model, problem, How::map, samples);
    const Nominal& pose = problem.pose();
    const FirstOrder first_order(model.assembly, pose, model.ranks);
    const Eigen::MatrixXd twists = error_twists(model, pose);
    for (std::size_t b = 0; b < samples.errors.size(); ++b) {
      SCOPED_TRACE("sample " + std::to_string(b));
      const Eigen::Map<const Eigen::VectorXd> errors(samples.errors[b].data(), twists.cols());
      Balance wanted = first_order.effect(twists * errors);
      wanted.twists += first_order.by_load().twists;
      wanted.wrenches += first_order.by_load().wrenches;
      const Outcome outcome = outcome_of(model.assembly, pose, wanted, 0);
      expect_same_responses(model, found.of(b),
                            response_values(model.assembly, model.report, model.deforms, pose, outcome), 1e-13, 1e-10);
    }
  });
}

void expect_same_bits(const std::vector<double>& found, const std::vector<double>& wanted) {
  for (std::size_t n = 0; n < found.size(); ++n) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(found[n]), std::bit_cast<std::uint64_t>(wanted[n])) << "response " << n;
  }
}

/// Expects the same bits for each sample in other orders and in blocks of other sizes.
void expect_same_at_any_place(const AssemblyModel& model, PoseProblem& problem, How how, Samples& samples) {
  const Block wanted = block_of(model, problem, how, samples);
  std::vector<std::size_t> order(samples.errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (const unsigned seed : {1u, 2u, 3u}) {
    std::ranges::shuffle(order, std::mt19937(seed));
    Samples others;
    for (std::size_t k = 0; k < order.size() - 5 * seed; ++k) others.errors.push_back(samples.errors[order[k]]);
    const Block found = block_of(model, problem, how, others);
    for (std::size_t k = 0; k < others.errors.size(); ++k) {
      EXPECT_EQ(found.iterations[k], wanted.iterations[order[k]]);
      expect_same_bits(found.of(k), wanted.of(order[k]));
    }
  }
}

TEST_P(AssemblyKernel, IsTheSameAtAnyPlace) {
  for_each_sample(37, [](const AssemblyModel& model, PoseProblem& problem, Samples& samples) {
    expect_same_at_any_place(model, problem, How::solve, samples);
    expect_same_at_any_place(model, problem, How::map, samples);
  });
}

/// Samples with NaN, infinite or far too large errors do not change the other samples of their block.
TEST_P(AssemblyKernel, IgnoresWrongNeighbours) {
  for_each_sample(19, [](const AssemblyModel& model, PoseProblem& problem, Samples& samples) {
    for (const How how : {How::solve, How::map}) {
      const Block wanted = block_of(model, problem, how, samples);
      for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity(), 1e200}) {
        Samples spoilt = samples;
        for (std::size_t b = 0; b < spoilt.errors.size(); b += 3) std::ranges::fill(spoilt.errors[b], wrong);
        const Block found = block_of(model, problem, how, spoilt);
        for (std::size_t b = 0; b < spoilt.errors.size(); ++b) {
          if (b % 3 == 0) {
            const bool is_linear = how == How::map && std::isfinite(wrong);
            EXPECT_TRUE(is_linear || !solved(found.status[b])) << wrong;
            continue;
          }
          EXPECT_EQ(found.status[b], wanted.status[b]);
          EXPECT_EQ(found.iterations[b], wanted.iterations[b]);
          expect_same_bits(found.of(b), wanted.of(b));
        }
      }
    }
  });
}

TEST_P(AssemblyKernel, SaysWhatIsNotSolved) {
  const AssemblyModel model = with_reactions(cases()[1], Metric::platform);
  PoseProblem problem(model, model.at(cases()[1].pose), kOptions);
  Samples samples = drawn(model, 0.1, 11);
  samples.errors[4].front() = std::nan("");
  const Block found = block_of(model, problem, How::solve, samples);
  SolverOptions capped = kOptions;
  capped.max_iterations = 1;
  PoseProblem capped_problem(model, model.at(cases()[1].pose), capped);
  const Block given_up = block_of(model, capped_problem, How::solve, samples, capped);
  for (std::size_t b = 0; b < samples.errors.size(); ++b) {
    EXPECT_EQ(found.status[b], b == 4 ? SolveStatus::non_finite : SolveStatus::converged);
    EXPECT_EQ(given_up.status[b], b == 4 ? SolveStatus::non_finite : SolveStatus::iteration_cap);
  }
  const Block mapped = block_of(model, problem, How::map, samples);
  for (std::size_t b = 0; b < samples.errors.size(); ++b) {
    EXPECT_EQ(mapped.status[b], b == 4 ? SolveStatus::non_finite : SolveStatus::converged);
  }
}

TEST(AssemblyKernels, HaveTheSameBitsByAllSetsThatFuse) {
  if (!test::machine_has("avx2") || !test::machine_has("avx512"))
    GTEST_SKIP() << "this machine has one of them at most";
  for_each_sample(21, [](const AssemblyModel& model, PoseProblem& problem, Samples& samples) {
    for (const How how : {How::solve, How::map}) {
      std::vector<Block> blocks;
      for (const char* isa : {"avx2", "avx512"}) {
        const test::ForcedIsa forced(isa);
        blocks.push_back(block_of(model, problem, how, samples));
      }
      EXPECT_EQ(blocks[0].iterations, blocks[1].iterations);
      for (std::size_t k = 0; k < blocks[0].responses.size(); ++k) {
        ASSERT_EQ(std::bit_cast<std::uint64_t>(blocks[0].responses[k]),
                  std::bit_cast<std::uint64_t>(blocks[1].responses[k]));
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Isa, AssemblyKernel, testing::ValuesIn(test::kEveryIsa), test::isa_name);

}  // namespace
}  // namespace poesy::assembly
