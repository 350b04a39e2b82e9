#include <benchmark/benchmark.h>

#include <array>
#include <random>

#include "models/chain/limb.h"
#include "models/two_upr_rpu/kinematics.h"

namespace {

using namespace poesy;

constexpr std::size_t kInputs = 256;

std::vector<two_upr_rpu::Pose> poses() {
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<double> z(-0.30, -0.18), beta(-0.5, 0.5), gamma(-0.6, 0.6);
  std::vector<two_upr_rpu::Pose> list;
  for (std::size_t n = 0; n < kInputs; ++n) list.push_back({z(engine), beta(engine), gamma(engine)});
  return list;
}

void inverse_kinematics(benchmark::State& state) {
  const auto inputs = poses();
  std::size_t n = 0;
  for (auto _ : state) benchmark::DoNotOptimize(two_upr_rpu::joint_displacements({}, inputs[n++ % kInputs]));
}

void limb_pose_and_jacobian(benchmark::State& state) {
  const chain::Limb limb = two_upr_rpu::parallel_chain({}).limbs[0];
  std::vector<std::array<double, 12>> inputs;
  for (const auto& pose : poses()) inputs.push_back(two_upr_rpu::joint_displacements({}, pose));
  std::array<lie::Screw<double>, 3> columns;
  std::size_t n = 0;
  for (auto _ : state) {
    const std::span<const double> q(inputs[n++ % kInputs].data(), 4);
    benchmark::DoNotOptimize(chain::forward_kinematics<double>(
        limb, limb.home, q, [&](std::size_t k, const lie::Screw<double>& column) { columns[k] = column; }));
    benchmark::DoNotOptimize(columns);
  }
}

void frame_with_error(benchmark::State& state) {
  const chain::Limb limb = two_upr_rpu::parallel_chain({}).limbs[0];
  chain::FrameError<double> error = chain::FrameError<double>::Zero();
  double value = 1e-3;
  for (auto _ : state) {
    error[0] = value = -1.01 * value;
    if (value > 0.05) value = 1e-3;
    benchmark::DoNotOptimize(chain::frame_with_error(limb, 1, error));
  }
}

}  // namespace

BENCHMARK(inverse_kinematics)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(limb_pose_and_jacobian)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(frame_with_error)->UseRealTime()->MeasureProcessCPUTime();
