#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string_view>

#include "bench/published_study.h"
#include "engine/app/mpi_ranks.h"
#include "engine/kinds/monte_carlo/collector.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/sensitivity/collector.h"
#include "engine/run/fold.h"
#include "engine/run/run_options.h"
#include "tests/support/fake_ranks.h"

// Measures how many work units (WorkUnit) per second rank 0 can hand out, receive, unpack and merge. The ranks solve
// nothing: each unit has the same prepared output. Rank 0 sleeps 2 ms for each unit that it takes itself, so nearly all
// outputs come from other ranks. Usage: rank_bench [RANKS [UNITS_PER_CELL]]. Under mpirun, the ranks are the processes
// that it started, and RANKS is ignored; otherwise they are threads of this process. A cell of the sensitivity study is
// one error at one pose.

namespace {

using namespace poesy;

constexpr std::size_t kResponsesOfMonteCarlo = 12;
constexpr std::size_t kEveryPose = 16;
constexpr std::size_t kUnitsPerPose = 50;

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Normal numbers with mean 0, which serve as the values of a response in one unit.
std::vector<double> numbers() {
  std::vector<double> values(Plan::kUnitSamples);
  fill_uniforms({1, Purpose::error_samples, FactorIndex(0), PoseIndex(0)}, SampleIndex(0), values);
  Distribution::normal(1e-3).transform(values);
  return values;
}

SolveCounts counts() {
  SolveCounts solves;
  for (std::size_t n = 0; n < Plan::kUnitSamples; ++n) solves.add(SolveStatus::converged, 2);
  return solves;
}

/// Runs a study on all ranks, in which every work unit has the output `unit` without a solve. add: merges the output of
/// a unit. state: writes or reads an output as a message. Rank 0 prints the rates.
template <class Output, class Add, class State>
void measure(const char* kind, const Plan& plan, Output unit, Team& team, const Add& add, const State& state) {
  RunOptions options;
  options.threads = 1;
  options.team = &team;
  Stage stage(nullptr, &team);
  stage.begin([](std::span<const std::byte>) {});
  ByteWriter packed;
  Archive archive(packed);
  state(archive, unit);
  const std::size_t bytes = packed.take().size();
  const bool leads = team.leads();
  const double cpu = thread_seconds();
  const auto start = std::chrono::steady_clock::now();
  run_in_order(
      plan.units(), options, [] { return 0; },
      [&](int, std::size_t) {
        if (leads) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        return unit;
      },
      [&](std::size_t n, const Output& output) { add(plan.unit(n), output); },
      [&](Archive& of_unit, std::size_t, Output& output) { state(of_unit, output); });
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double writer = thread_seconds() - cpu;
  stage.end(
      true, [] { return SolveCounts(); }, [](ByteWriter& to) { to.number(1); }, [](std::span<const std::byte>) {});
  if (!leads) return;
  const auto units = static_cast<double>(plan.units());
  fmt::print("{:12} {} ranks, {} units of {} bytes: {:.0f} units/s; writer {:.2f} us of CPU time for a unit\n", kind,
             team.ranks().size(), plan.units(), bytes, units / wall, 1e6 * writer / units);
  std::fflush(stdout);
}

void measure_both(Team& team, std::size_t units_per_cell) {
  Study study = bench::published_study(bench::kPublishedPoses, units_per_cell * Plan::kUnitSamples);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const PoseSet poses = select_poses(study.poses, *model).poses;
  {
    const Plan plan(study, poses);
    const std::size_t responses = model->description().responses.size();
    const CellUnit unit{{std::vector(responses, Moments::of(numbers())), counts(), {}}, {}};
    sensitivity::Collector collect(plan, responses, study.analysis.conf_level);
    measure(
        "sensitivity", plan, unit, team, [&](const WorkUnit& of, const CellUnit& found) { collect.add(of, found); },
        [&](Archive& archive, CellUnit& one) {
          one.responses.resize(responses);
          one.state(archive, 0);
        });
  }
  // Many units at few poses, because in a long study the work that is done once for each pose is negligible.
  study.analysis.kind = &monte_carlo::kStudy;
  study.analysis.samples *= kUnitsPerPose;
  const Plan plan(study, bench::every(kEveryPose, poses));
  const ResponseUnit response{Moments::of(numbers()), NumberBlock(numbers())};
  const PoseUnit unit{std::vector(kResponsesOfMonteCarlo, response), counts(), {}, {}};
  monte_carlo::Collector collect(plan, kResponsesOfMonteCarlo, study.analysis);
  measure(
      "monte-carlo", plan, unit, team, [&](const WorkUnit& of, const PoseUnit& found) { collect.add(of, found); },
      [&](Archive& archive, PoseUnit& one) {
        one.responses.resize(kResponsesOfMonteCarlo);
        one.state(archive, plan.factors().size(), 0);
      });
}

std::size_t argument(int argc, char** argv, int at, std::size_t otherwise) {
  if (argc <= at) return otherwise;
  const std::string_view text = argv[at];
  std::from_chars(text.data(), text.data() + text.size(), otherwise);
  return otherwise;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t units_per_cell = argument(argc, argv, 2, 20);
  const auto launch = app::find_launch();
  if (!launch || launch->size == 1) {
    test::run_on_fake_ranks(argument(argc, argv, 1, 3), [&](Team& team) { measure_both(team, units_per_cell); });
    return 0;
  }
  const auto ranks = app::connect_ranks(*launch);
  Team team(*ranks);
  if (!team.leads()) return team.follow([&] { measure_both(team, units_per_cell); });
  measure_both(team, units_per_cell);
  return team.dismiss(0, std::chrono::seconds(60)) ? 0 : 1;
}
