#include "models/three_prs/closure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/linalg/decompositions.h"
#include "engine/linalg/downhill.h"

namespace poesy::three_prs {
namespace {

using Vector3 = lie::Vector3<double>;
using Matrix3 = lie::Matrix3<double>;
using Matrix6 = lie::Matrix6<double>;
using Step = lie::Screw<double>;
using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

const PlatformMotion kNoMotion{Matrix3::Identity(), Vector3::Zero()};

/// The six equations of close_limbs() without swings, and their derivative with respect to [delta; dr]: a further small
/// rotation delta of the platform (E becomes exp(delta) E) and the displacement dr of P.
struct Equations {
  Step residual;
  Matrix6 jacobian;
};

void evaluate(const std::array<LimbWithErrors, kLimbs>& limbs, const Vector3& r, const PlatformMotion& motion,
              Equations& equations) {
  const Vector3 p = r + motion.dr;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const LimbWithErrors& limb = limbs[i];
    const Vector3 joint = motion.E * limb.joint;
    const Vector3 rod = p + joint - limb.carriage;
    const Vector3 axis = limb.base_R_revolute.col(1);
    const auto row = static_cast<Eigen::Index>(i);
    equations.residual[row] = 0.5 * (rod.squaredNorm() - limb.rod.squaredNorm());
    equations.residual[row + 3] = axis.dot(rod) - limb.rod.y();
    equations.jacobian.row(row) << joint.cross(rod).transpose(), rod.transpose();
    equations.jacobian.row(row + 3) << joint.cross(axis).transpose(), axis.transpose();
  }
}

bool is_singular(const linalg::LuFactors6& factors) {
  const lie::Screw<double> pivots = factors.pivots().cwiseAbs();
  return pivots.minCoeff() <= 64.0 * kEpsilon * pivots.maxCoeff();
}

PlatformMotion moved(const PlatformMotion& motion, const Step& step) {
  return {lie::exp(Vector3(step.head<3>())) * motion.E, motion.dr + step.tail<3>()};
}

/// Returns true if a solve that ends with this status may have failed because the limbs cannot be assembled.
bool may_be_impossible(SolveStatus status) {
  return status == SolveStatus::iteration_cap || status == SolveStatus::singular;
}

/// The descent of the platform to the least mismatch of its limbs, for linalg::comes_to_rest(). The equations of rods
/// are divided by the rods' lengths, so that all mismatches are lengths (m).
class Descent {
 public:
  Descent(const std::array<LimbWithErrors, kLimbs>& limbs, const Vector3& r, const PlatformMotion& start)
      : limbs_(&limbs), r_(r), motion_(start), here_(equations_at(start)) {}

  double sum_of_squares() const { return here_.residual.squaredNorm(); }
  double tried_sum_of_squares() const { return there_.residual.squaredNorm(); }

  double try_step(double damping) {
    Matrix6 normal = here_.jacobian.transpose() * here_.jacobian;
    normal.diagonal() *= 1.0 + damping;
    const Step step = -linalg::LuFactors6(normal).solve(here_.jacobian.transpose() * here_.residual);
    if (!step.allFinite()) return kNaN;
    tried_ = moved(motion_, step);
    there_ = equations_at(tried_);
    return step.cwiseAbs().maxCoeff();
  }

  void take_step() {
    motion_ = tried_;
    here_ = there_;
  }

 private:
  Equations equations_at(const PlatformMotion& motion) const {
    Equations equations;
    evaluate(*limbs_, r_, motion, equations);
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kLimbs); ++i) {
      const double length = (*limbs_)[static_cast<std::size_t>(i)].rod.norm();
      equations.residual[i] /= length;
      equations.jacobian.row(i) /= length;
    }
    return equations;
  }

  const std::array<LimbWithErrors, kLimbs>* limbs_;
  Vector3 r_;
  PlatformMotion motion_;
  PlatformMotion tried_;
  Equations here_;
  Equations there_;
};

/// Newton's iteration in close_limbs().
Closing iterate(const std::array<LimbWithErrors, kLimbs>& limbs, const Vector3& r, double orientation,
                const SolverOptions& options, PlatformMotion& motion, const ClosureObserver& observe) {
  const double rounding = rounding_level(r);
  Equations equations;
  double smallest = std::numeric_limits<double>::infinity();
  for (int iteration = 1; iteration <= options.max_iterations; ++iteration) {
    const auto done = static_cast<std::uint32_t>(iteration);
    evaluate(limbs, r, motion, equations);
    if (!equations.residual.allFinite()) return {SolveStatus::non_finite, done - 1};
    const linalg::LuFactors6 factors(equations.jacobian);
    if (is_singular(factors)) return {SolveStatus::singular, done - 1};
    const Step step = -factors.solve(equations.residual);
    motion = moved(motion, step);
    if (observe) observe({equations.residual, step});
    const double change = step.cwiseAbs().maxCoeff();
    const bool converged = change < options.tolerance;
    if (converged || (change <= rounding && change >= smallest)) {
      if (factors.determinant() * orientation < 0.0) return {SolveStatus::singular, done};
      return {converged ? SolveStatus::converged : SolveStatus::stagnated, done};
    }
    smallest = std::min(smallest, change);
  }
  return {SolveStatus::iteration_cap, static_cast<std::uint32_t>(options.max_iterations)};
}

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

/// Sets the constant errors of a pose, and for each varied error the row of SampleBlock::values that contains its
/// values.
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

LimbWithErrors limb_with_errors(const Geometry& geometry, const Configuration& nominal, std::size_t limb,
                                std::span<const double, kSources> errors) {
  const auto vector = [&](Source source) {
    return Vector3(Eigen::Map<const Vector3>(errors.data() + static_cast<std::size_t>(source)));
  };
  const auto scalar = [&](Source source) { return errors[static_cast<std::size_t>(source)]; };
  const Matrix3 R_i = base_R_limb(limb);
  const Matrix3 rail = R_i * lie::exp(vector(Source::theta_A));
  LimbWithErrors out;
  out.base_R_revolute = rail * lie::exp(vector(Source::theta_B));
  out.carriage = R_i * (geometry.a * Vector3::UnitX() + vector(Source::a)) +
                 (nominal.limbs[limb].q + scalar(Source::q)) * rail.col(2) + out.base_R_revolute * vector(Source::b);
  out.rod = (geometry.l + scalar(Source::l)) * lie::exp(vector(Source::theta_Bp)).col(2);
  out.joint = nominal.limbs[limb].c + nominal.platform.R * (R_i * vector(Source::c));
  return out;
}

ClosureStart::ClosureStart(const Geometry& geometry, const Configuration& nominal) : r_(nominal.platform.p) {
  constexpr std::array<double, kSources> kNone{};
  std::array<LimbWithErrors, kLimbs> limbs;
  for (std::size_t i = 0; i < kLimbs; ++i) limbs[i] = limb_with_errors(geometry, nominal, i, kNone);
  Equations equations;
  evaluate(limbs, r_, kNoMotion, equations);
  const linalg::LuFactors6 factors(equations.jacobian);
  from_residual_ = is_singular(factors) ? Matrix6::Zero() : Matrix6(-factors.inverse());
  Matrix6 swapped;
  swapped << equations.jacobian.rightCols<3>(), equations.jacobian.leftCols<3>();
  const linalg::LuFactors6 eliminated(swapped);
  if (!is_singular(factors)) {
    orientation_ = std::copysign(1.0, factors.determinant());
    pivot_sign_ = std::copysign(1.0, eliminated.pivots().prod());
  }
  const linalg::LuFactors6::Places& places = eliminated.row_places();
  for (std::size_t n = 0; n < order_.size(); ++n) {
    order_[n] = static_cast<std::size_t>(places[static_cast<Eigen::Index>(n)]);
  }
}

PlatformMotion ClosureStart::operator()(const std::array<LimbWithErrors, kLimbs>& limbs) const {
  Equations equations;
  evaluate(limbs, r_, kNoMotion, equations);
  const Step step = from_residual_ * equations.residual;
  return {lie::exp(Vector3(step.head<3>())), step.tail<3>()};
}

double rounding_level(const Vector3& r) { return 64.0 * kEpsilon * std::max(1.0, r.norm()); }

Closing close_limbs(const std::array<LimbWithErrors, kLimbs>& limbs, const Vector3& r, double orientation,
                    const SolverOptions& options, PlatformMotion& motion, const ClosureObserver& observe) {
  const PlatformMotion start = motion;
  Closing end = iterate(limbs, r, orientation, options, motion, observe);
  const bool is_asked = orientation != 0.0 && may_be_impossible(end.status);
  if (is_asked && is_impossible(limbs, r, start)) end.status = SolveStatus::not_assembled;
  return end;
}

bool is_impossible(const std::array<LimbWithErrors, kLimbs>& limbs, const Vector3& r, const PlatformMotion& start) {
  constexpr double kRest = 1e-9;
  constexpr double kMet = 1e-9;
  Descent descent(limbs, r, start);
  return linalg::comes_to_rest(descent, kRest) && std::sqrt(descent.sum_of_squares()) > kMet * r.norm();
}

double swing(const LimbWithErrors& limb, const Vector3& r, const PlatformMotion& motion) {
  const Vector3 from = limb.rod;
  const Vector3 to = limb.base_R_revolute.transpose() * (r + motion.dr + motion.E * limb.joint - limb.carriage);
  return std::atan2(to.x() * from.z() - to.z() * from.x(), to.x() * from.x() + to.z() * from.z());
}

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
      // The extra kMostLanes numbers leave room to begin at an aligned address.
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
  pose_.pivot_sign = start.pivot_sign();
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
  review(nominal, samples, start, outcomes);
  if (given_up == 0) return;
  for (std::size_t b = 0; b < samples.count; ++b) {
    if (outcomes.iterations[b] == 0) close_sample(geometry_, nominal, samples, b, start, options_, outcomes);
  }
}

/// Examines the samples that the kernel ended with the status iteration_cap or singular. Sets the status not_assembled
/// for those whose limbs cannot be assembled.
void ClosureSolver::review(const Configuration& nominal, const SampleBlock& samples, const ClosureStart& start,
                           const OutcomeBlock& outcomes) const {
  if (start.orientation() == 0.0) return;
  for (std::size_t b = 0; b < samples.count; ++b) {
    if (outcomes.iterations[b] == 0 || !may_be_impossible(outcomes.status[b])) continue;
    const auto limbs = limbs_of_sample(geometry_, nominal, samples, b);
    if (is_impossible(limbs, nominal.platform.p, start(limbs))) outcomes.status[b] = SolveStatus::not_assembled;
  }
}

void close_sample(const Geometry& geometry, const Configuration& nominal, const SampleBlock& samples,
                  std::size_t sample, const ClosureStart& start, const SolverOptions& options,
                  const OutcomeBlock& outcomes, const ClosureObserver& observe) {
  const auto limbs = limbs_of_sample(geometry, nominal, samples, sample);
  PlatformMotion motion = start(limbs);
  const Closing closing = close_limbs(limbs, nominal.platform.p, start.orientation(), options, motion, observe);
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
