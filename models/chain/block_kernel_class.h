#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/model/status.h"
#include "models/chain/block_problem.h"
#include "models/simd/math.h"

namespace poesy::chain {

/// The stages of a sample's solve. See BlockKernel.
enum class KernelPass {
  published,  ///< Gauss-Newton with the published stopping rule
  direct,     ///< Newton; stops at the first step that is not safe
  follow,     ///< Gauss-Newton, with Newton steps once they are small and safe
  rescue      ///< Newton wherever its matrix is positive definite, else half a Gauss-Newton step
};

/// Three limbs, paired with each other, with equal numbers of passive joints. These numbers are compile-time constants,
/// so that loops unroll.
template <std::size_t joints_per_limb>
struct ThreeLimbs {
  static constexpr bool kFixed = true;  ///< the numbers of limbs, joints and pairs are constants
  /// Every two limbs form exactly one pair, so each off-diagonal block of N belongs to one pair.
  static constexpr bool kEveryPairOnce = true;
  /// The numbers for which the kernel is compiled.
  /// @{
  static constexpr std::size_t kLimbs = 3;
  static constexpr std::size_t kJoints = joints_per_limb;
  static constexpr std::size_t kPairs = 3;
  /// @}

  /// Whether a chain has this shape.
  static bool fits(const KernelChain& chain) {
    if (chain.limbs != kLimbs || chain.pairs != kPairs) return false;
    unsigned met = 0;
    for (std::size_t n = 0; n < kPairs; ++n) met |= 1u << (chain.pair[n].i + chain.pair[n].k);
    for (std::size_t i = 0; i < kLimbs; ++i) {
      if (chain.limb[i].joints != kJoints) return false;
    }
    return met == 0b1110;  // the pairs of three limbs, numbered by their sums 1, 2, 3
  }
};

/// The published weight of residuals: W = 1 in radians and metres at the base's origin.
struct Published {
  static constexpr bool kWeighted = false;  ///< W is not read
};
/// The weight of residuals by the chain's metric.
struct Weighted {
  static constexpr bool kWeighted = true;  ///< W is KernelChain::metric
};

/// Passes the type of a kernel as a value.
template <class Kernel>
struct KernelClass {
  using Type = Kernel;  ///< the kernel
};

/// Chains of any number of limbs, joints and pairs.
struct AnyShape {
  /// No number is known at compile time.
  /// @{
  static constexpr bool kFixed = false;
  static constexpr bool kEveryPairOnce = false;
  /// @}
};

/// Solves blocks of samples of a parallel chain for J(q)^T delta_mu(q) = 0 (Du et al. 2022, Eqs. 40-44), T::kLanes
/// samples at a time. T is simd::Number or a SIMD batch (models/simd); Shape and Measure select the chains and the
/// weight of residuals. Samples are independent: no operation mixes lanes. With the published weight each sample is
/// iterated until it is done, and the remaining ones are packed together after every round; by a metric a batch is
/// iterated until its last sample is done.
///
/// published: x = N^-1 f with f = J^T delta_mu and N = J^T J, stopping rule as in DeformationSolver.
///
/// Newton: x = M^-1 f with M the negative derivative of f, exact to fourth order in the residual's angle. Beyond N it
/// contains the rotation of the columns of J (the bracket of an earlier column with a later one) and the curvature of
/// the logarithm (dlog = 1 - ad/2 + ad^2/12). A Newton step is safe when the pivots of M are at least 1e-5 of the
/// diagonal of N, and 2 N - M is positive definite too: then Gauss-Newton contracts to the root that Newton is about to
/// find, so both methods give the same root. A sample goes through up to three passes:
///     direct   Newton from the start; refused at a step that is not safe or larger than the options allow;
///     follow   Gauss-Newton from nominal displacements, up to 8 max_iterations, and Newton as soon as its step is
///              safe and below 1e-3, and Gauss-Newton's below 2e-3: finds the root of Gauss-Newton, if there is one.
///              Given up where the displacements return to those of an earlier iteration;
///     rescue   Newton from nominal displacements with positive pivots, else half a Gauss-Newton step, up to
///              max_iterations: finds a root with positive derivative where Gauss-Newton finds none. Roots more than
///              0.5 (rad, m) away from nominal displacements are other assembly modes of the chain and are refused.
/// Newton converges quadratically: a safe step of less than sqrt(tolerance / 10) is the last one, and the residual is
/// updated to first order instead of being evaluated again.
///
/// By a metric (Weighted) the equation is J^T W delta_mu = 0, f = J^T W delta_mu and N = J^T W J. The length s of a
/// step is the largest distance by which one joint's part of it moves the platform's points, divided by the reach. The
/// first pass solves nearly every sample:
///     direct   Newton from a start in proportion to the errors, or from a fit. From a fit a step with N at nominal
///              displacements comes first and is the last one if s < 10 tolerance. Newton's matrix is computed in
///              every fourth round and used in four; a lane is refused where a matrix is not safe, and after 12 rounds;
///     follow   as above, with s as the size of steps, from the start of Gauss-Newton. Where Gauss-Newton converges
///              although Newton is not safe, its own root is taken;
///     rescue   as above, with 0.5 of the reach instead of 0.5 (rad, m).
/// A Newton step is the last one where s < max(sqrt(tolerance) / 100, 1e-10) with a new matrix, or where s is below
/// 1000 tolerance and s^2 divided by the previous step is below tolerance / 10.
///
/// By a metric a root may belong to a machine that cannot be assembled. A root is doubted where N - 2 C, C = M - N, is
/// not positive definite at it or was not on the way, and wherever the first pass did not find it. A doubted sample
/// gets the status not_assembled until Assembly decides.
template <class T, class Shape, class Measure>
class BlockKernel {
 public:
  /// Keeps references to all arguments. scratch: [kernel_scratch()], aligned to 64 bytes.
  BlockKernel(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
              const KernelOptions& options, const KernelOutcome& outcome, double* scratch);

  /// Solves all samples of the block.
  void solve();
  /// Maps all samples to first order.
  void map(const KernelMap& map);
  /// Finds the motion of the platform for all samples.
  void move_platform(const KernelPlatform& platform);

 private:
  static constexpr std::size_t kLanes = T::kLanes;
  static constexpr unsigned kAllLanes = (1u << kLanes) - 1u;
  static constexpr double kSafePivot = 1e-5;
  static constexpr double kFollowStep = 1e-3;
  static constexpr double kNearStep = 2e-3;
  static constexpr double kRestingStep = 1e-12;
  static constexpr double kSameBranch = 0.5;
  static constexpr double kSamePlace = 1e-9;
  static constexpr double kMet = 1e-9;         ///< limbs closer than this, relative to the reach, have met
  static constexpr double kShortLength = 1e3;  ///< in units of the tolerance
  static constexpr double kShortStart = 3e-4;  ///< a shorter first step counts as short
  static constexpr std::uint32_t kFirstMemory = 16;
  static constexpr std::uint32_t kDirectIterations = 12;
  static constexpr std::uint32_t kFollowFactor = 8;
  static constexpr std::uint32_t kMatrixRounds = 4;
  static constexpr std::size_t kMapErrors = 8;
  static constexpr std::size_t kStartJoints = 9;

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
  /// First passive joint of limb i, or one past the last joint.
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
  /// The results of a round, one bit for each lane.
  struct Verdict {
    unsigned converged = 0;
    unsigned stagnated = 0;
    unsigned singular = 0;
    unsigned non_finite = 0;
    unsigned refused = 0;
    unsigned doubted = 0;  ///< lanes that have converged and are doubted

    bool solved(std::size_t lane) const { return ((converged | stagnated) >> lane & 1u) != 0; }
    bool ended(std::size_t lane) const {
      return ((converged | stagnated | singular | non_finite | refused) >> lane & 1u) != 0;
    }
    SolveStatus status(std::size_t lane) const {
      const auto says = [lane](unsigned lanes) { return (lanes >> lane & 1u) != 0; };
      if (says(non_finite)) return SolveStatus::non_finite;
      if (says(converged)) return says(doubted) ? SolveStatus::not_assembled : SolveStatus::converged;
      if (says(stagnated)) return SolveStatus::stagnated;
      return says(singular) ? SolveStatus::singular : SolveStatus::iteration_cap;
    }
  };

  // block_kernel_passes.h: the loop over samples.
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
  template <std::size_t count>
  void follow_slopes(std::size_t at, std::size_t first);
  void pad(std::size_t count);
  void evaluate(std::size_t at);
  typename T::MaskType finite_residual() const;
  Verdict published_round(std::size_t at, std::uint32_t round, bool last_round);
  template <KernelPass pass>
  Verdict newton_round(std::size_t at, std::uint32_t round);
  typename T::MaskType cycles(std::size_t at, std::uint32_t round);
  T largest(const T* x) const;
  void take_step(std::size_t at, const T* x);
  void advance(std::size_t at);
  void finish(std::size_t at, std::size_t lane, SolveStatus status, std::uint32_t iterations);
  template <KernelPass pass>
  void move(std::size_t from, std::size_t to);

  // block_kernel_metric.h: solves by a metric.
  void solve_by_metric();
  template <KernelPass pass>
  unsigned iterate(std::size_t at, unsigned open, std::uint32_t rounds);
  template <KernelPass pass>
  void start(std::size_t at);
  T nominal_step(T* x) const;
  typename T::MaskType new_newton_step(T* x);
  unsigned first_step(T& length);
  unsigned finish_fitted(std::size_t at, unsigned open);
  Verdict newton_by_metric(std::size_t at, std::uint32_t round, T& before, typename T::MaskType& safe);
  template <KernelPass pass>
  Verdict careful_by_metric(std::size_t at);
  Verdict gauss_newton_by_metric(std::size_t at, std::uint32_t round);
  unsigned doubted(unsigned converged) const;
  void judge_by_metric(std::size_t at);
  Screw weighted(const Screw& screw) const;
  void weigh();
  template <class Diagonal>
  T step_length(const T* x, Diagonal diagonal) const;

  // block_kernel_meeting.h: solves of limbs that can meet.
  struct Meeting {
    T matrix[6][6];  ///< lower triangle of the sum of P_i, later its factor
    T pivot[6];      ///< 1 / diagonal of the factor
    T margin;        ///< smallest pivot minus its rounding error
    T length;        ///< of the last step
  };
  void solve_meeting();
  template <bool is_new>
  Verdict meeting_round(Meeting& meeting);
  void project_limb(std::size_t i, Meeting& meeting);
  T* limb_factor(std::size_t i) const;
  void add_pull(std::size_t i, T* pull) const;
  void factor_platform(Meeting& meeting) const;
  void solve_platform(const Meeting& meeting, const T* pull, Screw& motion) const;
  void step_limb(std::size_t i, const Screw& motion, T& left2, T& length2);
  Screw measured(const Screw& screw) const;

  // block_kernel_platform.h: how the platform moves.
  Screw platform_motion(const KernelPlatform& platform, std::size_t at);
  void displace(const Screw& motion, const double* point, bool is_linear, double* rows, double* length) const;
  void finish_platform(const KernelPlatform& platform, const Screw& motion, std::size_t at) const;

  // block_kernel_geometry.h: residuals and columns.
  Motion error_motion(const KernelPiece& piece, std::size_t at) const;
  T varied(const KernelPiece& piece, int entry, std::size_t at) const;
  void load_constant_segments();
  static Motion constant_motion(const KernelPiece& piece);
  bool is_constant(const KernelSegment& segment) const;
  void vary_segment(const KernelSegment& segment, std::size_t at, Motion& product) const;
  void vary_segments(std::size_t at, std::size_t end);
  void set_column(const KernelJoint& joint, const T* axis, const T* point, Screw& column) const;
  template <bool with_columns = true>
  void limb_pose(std::size_t i, Motion& pose);
  void residuals();
  // Inlined, because residuals take a tenth of the time of a solve and a call would cost a third of that.
  [[gnu::always_inline]] static inline Screw log(const Motion& g);

  // block_kernel_equations.h: matrices and steps.
  void gradient();
  void gauss_newton_matrix();
  void newton_matrix();
  template <class Entry>
  T factor(Entry entry, double ratio);
  typename T::MaskType is_positive(double of_n, double of_m);
  typename T::MaskType contracts();
  typename T::MaskType gauss_newton_step(T* x);
  typename T::MaskType newton_step(T* x);
  void newton_step_again(T* x) const;
  void carry_residual(const T* x, typename T::MaskType lanes);

  const KernelChain chain_;
  const KernelSamples samples_;
  const KernelStart start_;
  const KernelOptions options_;
  const KernelOutcome outcome_;
  const std::size_t capacity_;

  // Rows of capacity_ with a value for each sample.
  double* value_;  ///< [varied] varied errors, except of the first in_place_ samples
  double* q_;
  double*
      memory_;  ///< published: residual of the last round; follow: displacements of an earlier round; map: coordinates
  double* smallest_;      ///< published: smallest change so far
  double* flat_;          ///< published: rounds since the smallest change; direct: -1 where the start comes from a fit
  std::uint32_t* index_;  ///< position of the sample in the block
  std::uint32_t* left_;   ///< samples to solve; after a pass, those that it did not solve

  // Values of the current lanes.
  Motion* segment_;
  Motion* pose_;
  Screw* column_;
  Screw* row_;   ///< W times each column (published: the column itself); of limbs that meet: measured()
  Screw* rows_;  ///< of limbs that meet: L^-1 C^T
  Screw* mu_;
  Screw* pull_;
  T* joint_;
  T* f_;
  T* step_;
  T* gauss_newton_;
  T* n_;
  T* m_;
  T* work_;
  T* pivot_;  ///< 1 / pivot of Newton's matrix
  std::size_t in_place_ = 0;
  std::uint32_t spent_ = 0;  ///< iterations of earlier passes
  unsigned clear_ = 0;       ///< lanes where N - 2 C was positive definite at every call of contracts()
};

}  // namespace poesy::chain
