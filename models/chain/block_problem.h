#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/model/status.h"

// The plain data that goes into and comes out of a block kernel. Nothing but pointers and numbers: this header is
// also read by translation units compiled for one instruction set, which must not share inline functions.

namespace poesy::chain {

/// A passive joint, in the order of the limbs, base to platform. Its displacement counts from where it is without
/// errors; the segment before it takes it there.
struct KernelJoint {
  bool revolute;   ///< else prismatic
  double advance;  ///< m per rad along the axis of a helical joint, which is revolute otherwise; else 0
  double start;    ///< displacement from which a solve starts unless told otherwise (rad, m)
};

/// A rigid motion between two passive joints, or before the first or behind the last one of a limb, as a product of
/// pieces: constant motions and errors of frames that vary from sample to sample.
struct KernelPiece {
  bool is_error;        ///< else a constant motion
  bool turns;           ///< the error has a rotation
  bool inverted;        ///< the error's inverse is meant
  double constant[12];  ///< of a constant motion: R by rows, then p
  double error[6];      ///< of an error: its constant part, [omega; v]
  int varied_row[6];    ///< row of KernelSamples::values that replaces that entry; -1 where it stays
};

/// Pieces in a row: a motion from joint to joint.
struct KernelSegment {
  std::size_t first_piece;  ///< among the chain's
  std::size_t pieces;       ///< how many
};

/// Which joints and segments are a limb's.
struct KernelLimb {
  std::size_t first_joint;  ///< among passive joints
  std::size_t joints;       ///< passive ones; the limb has joints + 1 segments
  double meetings;          ///< pairs it takes part in
};

/// Two limbs whose platform poses are compared; positions from 0.
struct KernelPair {
  std::size_t k;  ///< the one that is compared
  std::size_t i;  ///< the one it is compared with
};

/// A parallel chain at one pose with its constant errors.
struct KernelChain {
  const KernelLimb* limb;        ///< [limbs]
  std::size_t limbs;             ///< how many
  const KernelPair* pair;        ///< [pairs]
  std::size_t pairs;             ///< how many
  const KernelJoint* joint;      ///< [joints]
  std::size_t joints;            ///< passive ones of all limbs
  const KernelSegment* segment;  ///< [joints + limbs], limb by limb
  std::size_t segments;          ///< how many
  const KernelPiece* piece;      ///< of all segments
  const double* idle;            ///< [idle_freedoms x joints] see NormalEquations::idle()
  std::size_t idle_freedoms;     ///< how many
  const double* metric;          ///< [36] W by rows, see Metric; null: as published
  double origin[3];              ///< of the platform (m), by a metric
  double middle[3];              ///< of the metric's points (m)
  double spread[6];              ///< U by rows, upper triangular: U^T U is the mean moment of the points about it (m)
  double reach;                  ///< m, by a metric, or where limbs meet
  bool meets;                    ///< whether all limbs can hold the platform in one place, whatever the errors
};

/// Samples in rows: entry (v, b) at v * stride + b.
struct KernelSamples {
  const double* values;  ///< [varied x stride], SI
  std::size_t varied;    ///< V
  std::size_t stride;    ///< distance between rows, in numbers
  std::size_t count;     ///< B
};

/// Where solves start whose one varied error lies within half_width of center: a Chebyshev series of each passive
/// joint's displacement in (value - center) / half_width, [joints x kStartTerms].
struct KernelFit {
  double center;               ///< of the error's range, SI
  double half_width;           ///< of the error's range, SI
  const double* coefficients;  ///< [joints x kStartTerms]
};
inline constexpr std::size_t kStartTerms = 16;

/// Fits for ranges of the error. Outside of all of them solves start from nominal displacements, or in proportion.
struct KernelStart {
  const KernelFit* fit;  ///< [fits], with ranges that do not overlap
  std::size_t fits;      ///< how many
  const double* slopes;  ///< [varied x joints] by how much joints give way to an error, to first order; or null
  /// Of N at nominal displacements without errors, for the first step from a fit by a metric; null if singular.
  /// @{
  const double* inverse;   ///< [joints x joints]
  const double* diagonal;  ///< [joints], of N itself
  /// @}
};

/// Rows of a map are a multiple of this, the last ones zero.
inline constexpr std::size_t kMapRows = 3;

/// Residuals to first order, by their coordinates y = constant + sum over v of effects[v] x value v; see ResidualSpace.
struct KernelMap {
  std::size_t rows;        ///< of y
  const double* constant;  ///< [rows]
  const double* effects;   ///< [varied x rows]
  const double* delta_mu;  ///< [6 pairs x rows] of a unit of each row; null by a metric: not wanted
  const double* norms;     ///< [3 x rows x rows] upper triangles R: each response is |R y|; null as published
};

/// How the platform moves, each limb's by xi_i = log(g_i g_nominal^-1) and the platform by the mean xi of these, so
/// that it is displaced by D = exp(xi). In the base frame (m).
struct KernelPlatform {
  double nominal[12];           ///< where it is without errors: R by rows, then p
  double tool[3];               ///< a second point that is reported; with has_tool
  bool has_tool;                ///< whether there is one
  const double* displacements;  ///< [joints x stride] of passive joints, solved; not used with a map
  const KernelMap* map;         ///< to first order: of xi by its components, 6 rows; null: solved
  double* responses;            ///< [platform_rows() x stride]
};

/// Rows of a platform's motion: x, y, z of D p - p, theta_x, theta_y, theta_z of D's rotation vector, their lengths
/// position and rotation, and x, y, z and length of the tool's displacement.
static constexpr std::size_t platform_rows(bool has_tool) { return has_tool ? 12 : 8; }

enum class KernelMethod {
  gauss_newton,  ///< as published
  newton,
  newton_direct  ///< its first pass alone
};

/// How a kernel iterates; see SolverOptions.
struct KernelOptions {
  KernelMethod method;           ///< which iteration
  double tolerance;              ///< on the change of the residual; by a metric relative to the reach, as all below
  double rounding_level;         ///< below which a change may be rounding
  double last_step;              ///< a safe Newton step below this is the last one
  double largest_step;           ///< that Newton may take from a start; not used by a metric
  std::uint32_t max_iterations;  ///< after which a sample is given up
};

/// Rows as in KernelSamples, for all samples. The stride is at least kernel_capacity(count): entries behind the last
/// sample are overwritten.
struct KernelOutcome {
  double* delta_mu;           ///< [6 pairs x stride]
  double* responses;          ///< [3 x stride]: angular, linear, max; by a metric gap, angular, linear
  double* displacements;      ///< [joints x stride], of passive joints; or null
  SolveStatus* status;        ///< [stride]; not_assembled: solved, but doubted, see BlockKernel
  std::uint32_t* iterations;  ///< [stride]
  std::size_t stride;         ///< distance between rows, in numbers
};

/// No instruction set has more lanes.
inline constexpr std::size_t kMostLanes = 8;

/// Samples that fit into rows of scratch, with room for the lanes behind the last one.
static constexpr std::size_t kernel_capacity(std::size_t count) { return (count / kMostLanes + 2) * kMostLanes; }

/// Rows that a pass keeps: residuals or displacements of earlier rounds, or the coordinates of a map.
static constexpr std::size_t kernel_memory(const KernelChain& chain) {
  return 6 * chain.pairs > chain.joints ? 6 * chain.pairs : chain.joints;
}

/// Doubles of scratch that a solve needs, for any instruction set.
static constexpr std::size_t kernel_scratch(const KernelChain& chain, const KernelSamples& samples) {
  const std::size_t rows = samples.varied + chain.joints + kernel_memory(chain) + 2 + 1;
  const std::size_t motions = 12 * (chain.segments + chain.limbs);
  const std::size_t screws = 6 * (3 * chain.joints + chain.pairs + chain.limbs);
  const std::size_t equations = 3 * chain.joints * chain.joints + 6 * chain.joints;
  return rows * kernel_capacity(samples.count) + (motions + screws + equations) * kMostLanes;
}

/// Maps a block to first order. scratch: as for a solve.
using KernelMapBlock = void (*)(const KernelChain&, const KernelSamples&, const KernelMap&, const KernelOutcome&,
                                double* scratch);

/// Finds how the platform moves. Of the outcome only the stride counts. scratch: as for a solve.
using KernelMovePlatform = void (*)(const KernelChain&, const KernelSamples&, const KernelPlatform&,
                                    const KernelOutcome&, double* scratch);

/// Solves a block. scratch: aligned to 64 bytes.
using KernelSolve = void (*)(const KernelChain&, const KernelSamples&, const KernelStart&, const KernelOptions&,
                             const KernelOutcome&, double* scratch);

}  // namespace poesy::chain
