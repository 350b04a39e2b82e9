#include "models/three_prs/closure_solver.h"

#include <algorithm>
#include <cstdint>

#include "engine/base/contract.h"

namespace poesy::three_prs {
namespace {

using Vector3 = lie::Vector3<double>;
using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

double* aligned(std::vector<double>& memory) {
  const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
  return memory.data() + (64 - address % 64) % 64 / sizeof(double);
}

void describe_limb(const Configuration& nominal, std::size_t i, ClosureLimb& limb) {
  const lie::Matrix3<double> R_i = base_R_limb(i);
  limb.cosine = R_i(0, 0);
  limb.sine = R_i(1, 0);
  Eigen::Map<RowMajor3>(limb.base_R_platform_limb) = nominal.platform.R * R_i;
  Eigen::Map<Vector3>(limb.joint) = nominal.limbs[i].c;
  limb.q = nominal.limbs[i].q;
}

/// The rows of `values` that take the place of constant errors.
void vary(ClosurePose& pose, std::span<const double> errors, std::span<const FactorIndex> varied) {
  for (std::size_t i = 0; i < kLimbs; ++i) {
    ClosureLimb& limb = pose.limb[i];
    std::copy_n(errors.data() + i * kSources, kSources, limb.error);
    std::fill_n(limb.varied_row, kSources, -1);
    limb.varies = false;
  }
  for (std::size_t v = 0; v < varied.size(); ++v) {
    ClosureLimb& limb = pose.limb[varied[v].value / kSources];
    limb.varied_row[varied[v].value % kSources] = static_cast<int>(v);
    limb.varies = true;
  }
}

}  // namespace

std::array<LimbWithErrors, kLimbs> limbs_of_sample(const Geometry& geometry, const Configuration& nominal,
                                                   const SampleBlock& samples, std::size_t sample) {
  std::array<double, kFactors> errors;
  std::copy_n(samples.errors.begin(), kFactors, errors.begin());
  for (std::size_t v = 0; v < samples.varied.size(); ++v) {
    errors[samples.varied[v].value] = samples.values[v * samples.count + sample];
  }
  std::array<LimbWithErrors, kLimbs> limbs;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    limbs[i] = limb_with_errors(geometry, nominal, i, std::span(errors).subspan(i * kSources).first<kSources>());
  }
  return limbs;
}

ClosureSolver::ClosureSolver(const Geometry& geometry, const SolverOptions& options)
    : geometry_(geometry),
      options_(options),
      kernels_(simd::for_selected_isa([]<simd::Isa isa> { return kernels<isa>(); })),
      // One alignment's worth more than needed, so that an aligned start fits.
      scratch_(kClosureScratch + kMostLanes) {}

void ClosureSolver::prepare(const Configuration& nominal, const SampleBlock& samples, const ClosureStart& start) {
  POESY_EXPECTS(samples.errors.size() == kFactors);
  for (std::size_t i = 0; i < kLimbs; ++i) describe_limb(nominal, i, pose_.limb[i]);
  vary(pose_, samples.errors, samples.varied);
  pose_.a = geometry_.a;
  pose_.l = geometry_.l;
  Eigen::Map<Vector3>(pose_.r) = nominal.platform.p;
  Eigen::Map<Vector3>(pose_.tool) = tool(geometry_, nominal.platform.R);
  Eigen::Map<RowMajor6>(pose_.start) = start.from_residual();
  std::ranges::copy(start.elimination_order(), pose_.row);
  kernel_options_ = {options_.tolerance, rounding_level(nominal.platform.p),
                     static_cast<std::uint32_t>(std::max(options_.max_iterations, 0))};
}

void ClosureSolver::solve(const Configuration& nominal, const SampleBlock& samples, const OutcomeBlock& outcomes) {
  const ClosureStart start(geometry_, nominal);
  prepare(nominal, samples, start);
  std::size_t given_up = 0;
  tiles_.for_each(samples, outcomes, [&](const Tile& tile) {
    given_up += kernels_.close_tile(pose_, kernel_options_, tile, aligned(scratch_));
  });
  if (given_up == 0) return;
  for (std::size_t b = 0; b < samples.count; ++b) {
    if (outcomes.iterations[b] == 0) close_sample(geometry_, nominal, samples, b, start, options_, outcomes);
  }
}

void close_sample(const Geometry& geometry, const Configuration& nominal, const SampleBlock& samples,
                  std::size_t sample, const ClosureStart& start, const SolverOptions& options,
                  const OutcomeBlock& outcomes, const ClosureObserver& observe) {
  const auto limbs = limbs_of_sample(geometry, nominal, samples, sample);
  PlatformMotion motion = start(limbs);
  const Closing closing = close_limbs(limbs, nominal.platform.p, options, motion, observe);
  const Vector3 to_tip = tool(geometry, nominal.platform.R);
  const std::array<Vector3, 3> vectors{lie::log(motion.E), motion.dr, motion.dr + (motion.E * to_tip - to_tip)};
  for (std::size_t n = 0; n < vectors.size(); ++n) {
    for (std::size_t k = 0; k < 3; ++k) {
      outcomes.responses[(3 * n + k) * samples.count + sample] = vectors[n][static_cast<Eigen::Index>(k)];
    }
    outcomes.responses[(kVectorRows + n) * samples.count + sample] = vectors[n].norm();
  }
  outcomes.status[sample] = closing.status;
  outcomes.iterations[sample] = closing.iterations;
}

}  // namespace poesy::three_prs
