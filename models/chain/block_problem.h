#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/model/status.h"

// The plain data that goes into and comes out of a block kernel: nothing but pointers and numbers. This header is also
// read by translation units compiled for one instruction set, which must not share inline functions.

namespace poesy::chain {

/// A passive joint. Joints are ordered limb by limb, base to platform. Its displacement counts from its position
/// without errors, to which the preceding segment leads.
struct KernelJoint {
  bool revolute;   ///< else prismatic
  double advance;  ///< m per rad along the axis if the joint is helical (revolute is then true), else 0
  double start;    ///< default start of a solve (rad, m)
};

/// A rigid motion between two passive joints, or before the first or behind the last one of a limb, as a product of
/// pieces: constant motions and errors of frames that vary from sample to sample.
struct KernelPiece {
  bool is_error;        ///< else a constant motion
  bool turns;           ///< whether the error has a rotation
  bool inverted;        ///< whether the inverse of the error is applied
  double constant[12];  ///< of a constant motion: R by rows, then p
  double error[6];      ///< of an error: its constant part, [omega; v]
  int varied_row[6];    ///< row of KernelSamples::values that replaces that entry; -1 if the entry is constant
};

/// Consecutive pieces that make the motion from one joint to the next.
struct KernelSegment {
  std::size_t first_piece;  ///< position among the chain's pieces
  std::size_t pieces;       ///< number of pieces
};

/// The joints and segments of a limb.
struct KernelLimb {
  std::size_t first_joint;  ///< position among the passive joints
  std::size_t joints;       ///< number of passive joints; the limb has joints + 1 segments
  double meetings;          ///< number of pairs that contain the limb
};

/// Two limbs whose platform poses are compared. Positions count from 0.
struct KernelPair {
  std::size_t k;  ///< limb k of delta_mu_ki = log(g_k g_i^-1)
  std::size_t i;  ///< limb i
};

/// A parallel chain at one pose with its constant errors.
struct KernelChain {
  const KernelLimb* limb;        ///< [limbs]
  std::size_t limbs;             ///< number of limbs
  const KernelPair* pair;        ///< [pairs]
  std::size_t pairs;             ///< number of pairs
  const KernelJoint* joint;      ///< [joints]
  std::size_t joints;            ///< passive joints of all limbs
  const KernelSegment* segment;  ///< [joints + limbs], limb by limb
  std::size_t segments;          ///< number of segments
  const KernelPiece* piece;      ///< pieces of all segments
  const double* idle;            ///< [idle_freedoms x joints]; see NormalEquations::idle()
  std::size_t idle_freedoms;     ///< number of idle freedoms
  const double* metric;          ///< [36] W by rows, see Metric; null: the published weight
  double origin[3];              ///< platform origin (m); used with a metric
  double middle[3];              ///< of the metric's points (m)
  double spread[6];  ///< U by rows, upper triangular: U^T U is the mean moment of the points about the middle (m)
  double reach;      ///< reach of the chain (m); used with a metric, or if the limbs meet
  bool meets;        ///< whether all limbs can hold the platform in one pose, whatever the errors
};

/// Samples in rows: entry (v, b) at v * stride + b.
struct KernelSamples {
  const double* values;  ///< [varied x stride], SI
  std::size_t varied;    ///< V
  std::size_t stride;    ///< distance between rows, in numbers
  std::size_t count;     ///< B
};

/// Start of solves whose one varied error lies within half_width of center: a Chebyshev series of each passive joint's
/// displacement in (value - center) / half_width, [joints x kStartTerms].
struct KernelFit {
  double center;               ///< of the error's range, SI
  double half_width;           ///< of the error's range, SI
  const double* coefficients;  ///< [joints x kStartTerms]
};
inline constexpr std::size_t kStartTerms = 16;

/// Starts of solves: fits for ranges of the error. Outside all ranges solves start in proportion to the errors if there
/// are slopes, else from nominal displacements.
struct KernelStart {
  const KernelFit* fit;  ///< [fits], with disjoint ranges
  std::size_t fits;      ///< number of fits
  const double* slopes;  ///< [varied x joints] first-order displacement of the joints per unit of an error; null: none
  /// The matrix N at nominal displacements without errors, for the first step from a fit by a metric; null if singular.
  /// @{
  const double* inverse;   ///< [joints x joints], of N
  const double* diagonal;  ///< [joints], of N
  /// @}
};

/// The number of rows of a map is a multiple of this; the last rows are zero.
inline constexpr std::size_t kMapRows = 3;

/// Residuals to first order by their coordinates y = constant + sum over v of effects[v] x value v; see ResidualSpace.
struct KernelMap {
  std::size_t rows;        ///< number of components of y
  const double* constant;  ///< [rows]
  const double* effects;   ///< [varied x rows]
  const double* delta_mu;  ///< [6 pairs x rows] delta_mu per unit of each row; null by a metric if it is not wanted
  const double* norms;  ///< [3 x rows x rows] upper triangles R: each response is |R y|; null with the published weight
};

/// The motion of the platform. Limb i moves it by xi_i = log(g_i g_nominal^-1), the platform moves by their mean xi and
/// is displaced by D = exp(xi). All in the base frame (m).
struct KernelPlatform {
  double nominal[12];           ///< platform pose without errors: R by rows, then p
  double tool[3];               ///< second reported point; valid if has_tool
  bool has_tool;                ///< whether a tool point is reported
  const double* displacements;  ///< [joints x stride] solved displacements of passive joints; not used with a map
  const KernelMap* map;         ///< first order: the 6 components of xi; null: solved displacements are used
  double* responses;            ///< [platform_rows() x stride]
};

/// Number of rows of a platform's motion: x, y, z of D p - p; theta_x, theta_y, theta_z of D's rotation vector; their
/// lengths position and rotation; and x, y, z and length of the tool's displacement.
static constexpr std::size_t platform_rows(bool has_tool) { return has_tool ? 12 : 8; }

enum class KernelMethod {
  gauss_newton,  ///< as published
  newton,
  newton_direct  ///< the first pass of newton alone
};

/// How a kernel iterates; see SolverOptions.
struct KernelOptions {
  KernelMethod method;    ///< the iteration
  double tolerance;       ///< on the change of the residual; by a metric relative to the reach, like all lengths below
  double rounding_level;  ///< smaller changes may be rounding
  double last_step;       ///< a shorter safe Newton step is the last one
  double largest_step;    ///< longest Newton step of the first pass; not used with a metric
  std::uint32_t max_iterations;  ///< a sample that needs more is given up
};

/// Results in rows as in KernelSamples. The stride is at least kernel_capacity(count), because entries behind the last
/// sample are overwritten.
struct KernelOutcome {
  double* delta_mu;           ///< [6 pairs x stride]
  double* responses;          ///< [3 x stride]: angular, linear, max; by a metric gap, angular, linear
  double* displacements;      ///< [joints x stride] of passive joints; null: not wanted
  SolveStatus* status;        ///< [stride]; not_assembled: solved but doubted, see BlockKernel
  std::uint32_t* iterations;  ///< [stride]
  std::size_t stride;         ///< distance between rows, in numbers
};

/// The largest number of lanes of any instruction set.
inline constexpr std::size_t kMostLanes = 8;

/// Length of a row of scratch for `count` samples, with room for the lanes behind the last one.
static constexpr std::size_t kernel_capacity(std::size_t count) { return (count / kMostLanes + 2) * kMostLanes; }

/// Number of rows that a pass keeps: residuals or displacements of earlier rounds, or the coordinates of a map.
static constexpr std::size_t kernel_memory(const KernelChain& chain) {
  return 6 * chain.pairs > chain.joints ? 6 * chain.pairs : chain.joints;
}

/// Doubles of scratch that a solve needs with any instruction set.
static constexpr std::size_t kernel_scratch(const KernelChain& chain, const KernelSamples& samples) {
  const std::size_t rows = samples.varied + chain.joints + kernel_memory(chain) + 2 + 1;
  const std::size_t motions = 12 * (chain.segments + chain.limbs);
  const std::size_t screws = 6 * (3 * chain.joints + chain.pairs + chain.limbs);
  const std::size_t equations = 3 * chain.joints * chain.joints + 6 * chain.joints;
  return rows * kernel_capacity(samples.count) + (motions + screws + equations) * kMostLanes;
}

/// Maps a block to first order. scratch: see KernelSolve.
using KernelMapBlock = void (*)(const KernelChain&, const KernelSamples&, const KernelMap&, const KernelOutcome&,
                                double* scratch);

/// Finds the motion of the platform. Uses only the stride of the outcome. scratch: see KernelSolve.
using KernelMovePlatform = void (*)(const KernelChain&, const KernelSamples&, const KernelPlatform&,
                                    const KernelOutcome&, double* scratch);

/// Solves a block. scratch: [kernel_scratch()], aligned to 64 bytes.
using KernelSolve = void (*)(const KernelChain&, const KernelSamples&, const KernelStart&, const KernelOptions&,
                             const KernelOutcome&, double* scratch);

}  // namespace poesy::chain
