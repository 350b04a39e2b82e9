#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/model/status.h"
#include "models/chain/block_problem.h"
#include "models/simd/math.h"

namespace poesy::chain {

/// A pass is an attempt to solve samples by one method. A sample that a pass does not solve goes to the next one.
/// BlockKernel says when a step is safe.
enum class KernelPass {
  published,  ///< Gauss-Newton with the published stopping rule
  direct,     ///< Newton's method, which stops at the first unsafe step
  follow,     ///< Gauss-Newton, replaced near the root by safe Newton steps
  rescue      ///< a Newton step if the pivots of its matrix are positive, else half a Gauss-Newton step
};

/// The shape of a chain of three limbs with equal numbers of passive joints, whose platform poses are compared in all
/// three pairs. The numbers are compile-time constants, so that loops unroll.
template <std::size_t joints_per_limb>
struct ThreeLimbs {
  static constexpr bool kFixed = true;  ///< the numbers of limbs, joints and pairs are constants
  /// True if every two limbs form exactly one pair. Then each off-diagonal block of the Gauss-Newton matrix J^T J comes
  /// from one pair.
  static constexpr bool kEveryPairOnce = true;
  /// The numbers of limbs, of passive joints of each limb, and of pairs.
  /// @{
  static constexpr std::size_t kLimbs = 3;
  static constexpr std::size_t kJoints = joints_per_limb;
  static constexpr std::size_t kPairs = 3;
  /// @}

  /// Returns true if a chain has this shape.
  static bool fits(const KernelChain& chain) {
    if (chain.limbs != kLimbs || chain.pairs != kPairs) return false;
    unsigned met = 0;
    for (std::size_t n = 0; n < kPairs; ++n) met |= 1u << (chain.pair[n].i + chain.pair[n].k);
    for (std::size_t i = 0; i < kLimbs; ++i) {
      if (chain.limb[i].joints != kJoints) return false;
    }
    return met == 0b1110;  // bit s of `met` is set if the pair whose limbs have the sum s (1, 2 or 3) exists
  }
};

/// Passes the type of a kernel as a function argument.
template <class Kernel>
struct KernelClass {
  using Type = Kernel;  ///< type of the kernel
};

/// The shape of a chain of any number of limbs, joints and pairs.
struct AnyShape {
  /// No number is known at compile time.
  /// @{
  static constexpr bool kFixed = false;
  static constexpr bool kEveryPairOnce = false;
  /// @}
};

/// Solves J(q)^T delta_mu(q) = 0 (Du et al. 2022, Eqs. 40-44) for blocks of samples of a parallel chain, T::kLanes
/// samples at a time. T is simd::Number or a SIMD batch (models/simd); Shape is the shape of the chain. Samples are
/// independent: no operation mixes lanes. Each sample iterates until it is solved or given up. After each round the
/// remaining samples are packed together.
///
/// Method `gauss_newton` (pass `published`): the step is x = N^-1 f with f = J^T delta_mu and N = J^T J; the stopping
/// rule is that of DeformationSolver.
///
/// Method `newton`: the step is x = M^-1 f. M is the negative derivative of f, exact to fourth order in the residual's
/// angle. In addition to N, M contains the rotation of the columns of J (the bracket of an earlier column with a later
/// one) and the curvature of the logarithm (dlog = 1 - ad/2 + ad^2/12). A Newton step is safe if the pivots of M are at
/// least 1e-5 of the diagonal of N, and 2 N - M is positive definite too. Then Gauss-Newton contracts to the same root
/// to which the Newton step leads. A sample goes through up to three passes of KernelPass:
///     direct   up to 12 Newton steps from the starting point. The pass gives up a sample at a step that is not safe,
///              or that is larger than the options allow;
///     follow   Gauss-Newton from nominal displacements, up to 8 max_iterations. A Newton step replaces the
///              Gauss-Newton step if it is safe and below 1e-3 and the Gauss-Newton step is below 2e-3. This pass finds
///              the root to which Gauss-Newton converges, if it converges. The pass gives up a sample whose
///              displacements return to those of an earlier iteration;
///     rescue   from nominal displacements, a Newton step if the pivots of M are positive and the step is not larger
///              than the options allow, else half a Gauss-Newton step; up to max_iterations. This pass finds a root at
///              which M is positive definite, if Gauss-Newton does not converge. Roots more than 0.5 (rad, m) away from
///              nominal displacements are other assembly modes of the chain and are refused.
/// Newton converges quadratically. So a safe step of less than KernelOptions::last_step, about sqrt(tolerance / 10), is
/// the last one, and the residual is updated to first order instead of being evaluated again.
template <class T, class Shape>
class BlockKernel {
 public:
  /// Copies the arguments; the memory to which they point must outlive this object. scratch: [kernel_scratch()],
  /// aligned to 64 bytes.
  BlockKernel(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
              const KernelOptions& options, const KernelOutcome& outcome, double* scratch);

  /// Solves all samples of the block.
  void solve();
  /// Computes residuals and responses of all samples to first order.
  void map(const KernelMap& map);
  /// Finds the motion of the platform for all samples.
  void move_platform(const KernelPlatform& platform);

 private:
  static constexpr std::size_t kLanes = T::kLanes;
  static constexpr double kSafePivot = 1e-5;
  static constexpr double kFollowStep = 1e-3;
  static constexpr double kNearStep = 2e-3;
  static constexpr double kRestingStep = 1e-12;
  static constexpr double kSameBranch = 0.5;
  static constexpr double kSamePlace = 1e-9;
  static constexpr std::uint32_t kFirstMemory = 16;
  static constexpr std::uint32_t kDirectIterations = 12;
  static constexpr std::uint32_t kFollowFactor = 8;
  static constexpr std::size_t kMapErrors = 8;

  std::size_t limbs() const {
    if constexpr (Shape::kFixed) return Shape::kLimbs;
    if constexpr (!Shape::kFixed) return chain_.limbs;
  }
  std::size_t pairs() const {
    if constexpr (Shape::kFixed) return Shape::kPairs;
    if constexpr (!Shape::kFixed) return chain_.pairs;
  }
  std::size_t joints() const {
    if constexpr (Shape::kFixed) return Shape::kLimbs * Shape::kJoints;
    if constexpr (!Shape::kFixed) return chain_.joints;
  }
  /// The index of the first passive joint of limb i among the passive joints of all limbs; for i = limbs(), the
  /// number of all passive joints.
  std::size_t first_joint(std::size_t i) const {
    if constexpr (Shape::kFixed) return i * Shape::kJoints;
    if constexpr (!Shape::kFixed) return i == chain_.limbs ? chain_.joints : chain_.limb[i].first_joint;
  }

  struct Motion {
    T r[9];
    T p[3];
  };
  struct Screw {
    T w[3];
    T v[3];
  };
  /// The decisions after a round (one iteration of a batch of samples). Bit n of each member belongs to the sample in
  /// lane n.
  struct Verdict {
    unsigned converged = 0;
    unsigned stagnated = 0;
    unsigned singular = 0;
    unsigned non_finite = 0;
    unsigned refused = 0;

    bool solved(std::size_t lane) const { return ((converged | stagnated) >> lane & 1u) != 0; }
    bool ended(std::size_t lane) const {
      return ((converged | stagnated | singular | non_finite | refused) >> lane & 1u) != 0;
    }
    SolveStatus status(std::size_t lane) const {
      const auto says = [lane](unsigned lanes) { return (lanes >> lane & 1u) != 0; };
      if (says(non_finite)) return SolveStatus::non_finite;
      if (says(converged)) return SolveStatus::converged;
      if (says(stagnated)) return SolveStatus::stagnated;
      return says(singular) ? SolveStatus::singular : SolveStatus::iteration_cap;
    }
  };

  // Defined in block_kernel_passes.h: the loop over samples.
  void judge(std::size_t at);
  template <KernelPass pass>
  std::size_t run(std::size_t count, std::uint32_t rounds);
  void load_all();
  T value(std::size_t v, std::size_t at) const;
  void map_rows(const KernelMap& map);
  template <std::size_t errors>
  void add_mapped(const KernelMap& map, std::size_t first, std::size_t v);
  template <std::size_t known_rows>
  void finish_mapped(const KernelMap& map, std::size_t at);
  void begin(std::size_t count, bool predicted);
  void predict(std::size_t at);
  void pad(std::size_t count);
  void evaluate(std::size_t at);
  typename T::MaskType finite_residual() const;
  Verdict published_round(std::size_t at, std::uint32_t round, bool last_round);
  template <KernelPass pass>
  Verdict newton_round(std::size_t at, std::uint32_t round);
  typename T::MaskType cycles(std::size_t at, std::uint32_t round);
  T largest(const T* x) const;
  void take_step(std::size_t at, const T* x);
  void finish(std::size_t at, std::size_t lane, SolveStatus status, std::uint32_t iterations);
  template <KernelPass pass>
  void move(std::size_t from, std::size_t to);

  // Defined in block_kernel_platform.h: the motion of the platform.
  Screw platform_motion(const KernelPlatform& platform, std::size_t at);
  void displace(const Screw& motion, const double* point, bool is_linear, double* rows, double* length) const;
  void finish_platform(const KernelPlatform& platform, const Screw& motion, std::size_t at) const;

  // Defined in block_kernel_geometry.h: residuals and columns.
  Motion error_motion(const KernelPiece& piece, std::size_t at) const;
  T varied(const KernelPiece& piece, int entry, std::size_t at) const;
  void load_constant_segments();
  static Motion constant_motion(const KernelPiece& piece);
  bool is_constant(const KernelSegment& segment) const;
  void vary_segment(const KernelSegment& segment, std::size_t at, Motion& product) const;
  void vary_segments(std::size_t at, std::size_t end);
  void set_column(const KernelJoint& joint, const T* axis, const T* point, Screw& column) const;
  void limb_pose(std::size_t i, Motion& pose);
  void residuals();
  // Inlined, because residuals take a tenth of the time of a solve, and a call would cost a third of that tenth.
  [[gnu::always_inline]] static inline Screw log(const Motion& g);

  // Defined in block_kernel_equations.h: matrices and steps.
  void gradient();
  void gauss_newton_matrix();
  void newton_matrix();
  template <class Entry>
  T factor(Entry entry, double ratio);
  typename T::MaskType is_positive(double of_n, double of_m);
  typename T::MaskType contracts();
  typename T::MaskType gauss_newton_step(T* x);
  typename T::MaskType newton_step(T* x);
  void carry_residual(const T* x, typename T::MaskType lanes);

  const KernelChain chain_;
  const KernelSamples samples_;
  const KernelStart start_;
  const KernelOptions options_;
  const KernelOutcome outcome_;
  const std::size_t capacity_;

  // Rows of length capacity_, with a value for each sample.
  double* value_;  ///< values of varied errors, a row for each error; the first in_place_ samples are read from
                   ///< samples_ instead
  double* q_;
  /// Scratch memory. Pass `published`: residual of the last round. Pass `follow`: displacements of an earlier round.
  /// First order: coordinates y (KernelMap).
  double* memory_;
  double* smallest_;  ///< pass `published`: smallest change of the residual in all rounds so far
  double* flat_;      ///< pass `published`: rounds since the smallest change; pass `direct`: -1 if a fit gave the start
  std::uint32_t* index_;  ///< index of each sample in the block
  std::uint32_t* left_;   ///< samples to solve; after a pass, the samples that it did not solve

  // Values of the batch that is being solved, one number in each lane.
  Motion* segment_;
  Motion* pose_;
  Screw* column_;
  Screw* mu_;
  Screw* pull_;
  T* joint_;
  T* f_;
  T* step_;
  T* gauss_newton_;
  T* n_;
  T* m_;
  T* work_;
  T* pivot_;  ///< reciprocal pivots of Newton's matrix
  std::size_t in_place_ = 0;
  std::uint32_t spent_ = 0;  ///< iterations of earlier passes
};

}  // namespace poesy::chain
