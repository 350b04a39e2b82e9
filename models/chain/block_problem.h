#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/model/status.h"
#include "models/simd/isa.h"

// The plain data that a block kernel reads and writes: only pointers and numbers. Translation units compiled for one
// instruction set also include this header. Its functions are static, so that code for one instruction set cannot be
// linked into another.

namespace poesy::chain {

/// A passive joint. Joints are ordered limb by limb, from base to platform. Displacements are counted from the nominal
/// displacement in the perfect mechanism; the motion by the nominal displacement is part of the segment before the
/// joint.
struct KernelJoint {
  bool revolute;   ///< revolute or helical if true, else prismatic
  double advance;  ///< advance along the axis of a helical joint (which has revolute = true), m per rad; else 0
  double start;    ///< default displacement at which a solve starts (rad, m)
};

/// A rigid motion that is a factor of a segment. It is either a constant motion, or a frame's error, which may vary
/// from sample to sample.
struct KernelPiece {
  bool is_error;        ///< error of a frame if true, else a constant motion
  bool turns;           ///< true if the error has a rotation
  bool inverted;        ///< true if the inverse of the error is applied
  double constant[12];  ///< for a constant motion: rotation matrix row by row, then translation (m)
  double error[6];      ///< for an error: its constant part [omega; v] (rad, m)
  /// Row of KernelSamples::values with the values of each component of the error; -1 if the component is constant.
  int varied_row[6];
};

/// The motion from one passive joint to the next, before the first joint of a limb, or behind its last joint. The
/// motion is a product of consecutive pieces.
struct KernelSegment {
  std::size_t first_piece;  ///< index of the segment's first piece among all pieces
  std::size_t pieces;       ///< number of pieces
};

/// The joints and segments of a limb.
struct KernelLimb {
  std::size_t first_joint;  ///< index of the limb's first passive joint among those of all limbs
  std::size_t joints;       ///< number of passive joints; the limb has joints + 1 segments
  double meetings;          ///< number of pairs that contain the limb
};

/// Two limbs whose platform poses are compared. Indices count from 0.
struct KernelPair {
  std::size_t k;  ///< limb k of delta_mu_ki = log(g_k g_i^-1)
  std::size_t i;  ///< limb i
};

/// A parallel chain at one pose with its constant errors.
struct KernelChain {
  const KernelLimb* limb;        ///< [limbs] the limbs
  std::size_t limbs;             ///< number of limbs
  const KernelPair* pair;        ///< [pairs] the pairs of limbs
  std::size_t pairs;             ///< number of pairs
  const KernelJoint* joint;      ///< [joints] the passive joints, limb by limb
  std::size_t joints;            ///< number of passive joints of all limbs
  const KernelSegment* segment;  ///< [joints + limbs] segments, limb by limb
  std::size_t segments;          ///< number of segments
  const KernelPiece* piece;      ///< pieces of all segments, in order
  const double* idle;            ///< [idle_freedoms x joints] directions; see NormalEquations::idle()
  std::size_t idle_freedoms;     ///< number of idle freedoms (ParallelChain::idle)
};

/// The values of a block of samples, one row for each varied error: the value of error v in sample b is at v * stride +
/// b.
struct KernelSamples {
  const double* values;  ///< [varied x stride] values of the varied errors, SI
  std::size_t varied;    ///< number of varied errors
  std::size_t stride;    ///< distance between rows, in numbers
  std::size_t count;     ///< number of samples
};

/// Starting points of solves in which one error varies and its value lies within half_width of center. The starting
/// points are a Chebyshev series in (value - center) / half_width for each passive joint's displacement.
struct KernelFit {
  double center;               ///< middle of the error's range, SI
  double half_width;           ///< half the width of the error's range, SI
  const double* coefficients;  ///< [joints x kStartTerms] coefficients of the series (rad, m)
};
inline constexpr std::size_t kStartTerms = 16;

/// Starting points of solves: fits for ranges of the varied error. Outside all ranges, solves start from nominal
/// displacements.
struct KernelStart {
  const KernelFit* fit;  ///< [fits] fits with disjoint ranges
  std::size_t fits;      ///< number of fits
};

/// The number of coordinates of a KernelMap is a multiple of this; coordinates that only fill up the last multiple are
/// zero.
inline constexpr std::size_t kMapRows = 3;

/// A linear map from errors to delta_mu (first order). delta_mu is the mismatch of each pair of limbs, a twist [omega;
/// v] (rad, m). The map computes a few coordinates y of delta_mu (see ResidualSpace): y = constant + sum over the
/// varied errors v of effects[v] x (value of v).
struct KernelMap {
  std::size_t rows;        ///< number of components of y
  const double* constant;  ///< [rows] coordinates y of a sample whose varied errors are 0
  const double* effects;   ///< [varied x rows] change of y per unit of each varied error
  const double* delta_mu;  ///< [6 pairs x rows] change of delta_mu per unit of each component of y
};

/// The motion of the platform in the base frame (m, rad). Limb i alone puts the platform at the pose g_i, so this limb
/// moves the platform by xi_i = log(g_i g_nominal^-1). The motion of the platform is the mean xi of all xi_i; its
/// displacement is D = exp(xi).
struct KernelPlatform {
  double nominal[12];  ///< pose base_T_platform without errors: rotation matrix row by row, then translation (m)
  double tool[3];      ///< tool point (m, base frame), the second reported point; valid if has_tool
  bool has_tool;       ///< true if a tool point is reported
  /// [joints x stride] Solved displacements of the passive joints; unused if there is a map.
  const double* displacements;
  const KernelMap* map;  ///< first order: map to the 6 components of xi; null: solved displacements are used
  double* responses;     ///< [platform_rows() x stride] displacements of the platform and the tool (m, rad)
};

/// The number of rows of KernelPlatform::responses: x, y, z of D p - p, where D is the platform's displacement and p
/// its nominal origin; theta_x, theta_y, theta_z of D's rotation vector; the lengths of these two vectors; with a tool
/// also x, y, z and length of the tool's displacement.
static constexpr std::size_t platform_rows(bool has_tool) { return has_tool ? 12 : 8; }

enum class KernelMethod {
  gauss_newton,  ///< Gauss-Newton iteration, as published
  newton,
  newton_direct  ///< only the first pass of newton, KernelPass::direct
};

/// How a kernel iterates; see SolverOptions.
struct KernelOptions {
  KernelMethod method;           ///< method of iteration
  double tolerance;              ///< tolerance on the change of the residual in an iteration (rad, m)
  double rounding_level;         ///< a change of the residual below this may be rounding (rad, m)
  double last_step;              ///< ends after a shorter Newton step that is safe (BlockKernel) (rad, m)
  double largest_step;           ///< longest Newton step of the passes direct and rescue (rad, m)
  std::uint32_t max_iterations;  ///< number of iterations after which a sample is given up
};

/// The results of a block, with one value for each sample in each row. The stride is at least kernel_capacity(count),
/// because numbers behind the last sample are overwritten.
struct KernelOutcome {
  double* delta_mu;           ///< [6 pairs x stride] residuals (rad, m)
  double* responses;          ///< [3 x stride] angular (rad), linear (m) and largest deformation (norm over rad and m)
  double* displacements;      ///< [joints x stride] displacements of the passive joints (rad, m); null if not wanted
  SolveStatus* status;        ///< [stride] status of each sample
  std::uint32_t* iterations;  ///< [stride] iterations of each sample
  std::size_t stride;         ///< distance between rows, in numbers
};

using simd::kMostLanes;

/// The length of a row of scratch memory for `count` samples. It leaves room for the unused lanes of the last batch.
static constexpr std::size_t kernel_capacity(std::size_t count) { return (count / kMostLanes + 2) * kMostLanes; }

/// The number of rows of BlockKernel::memory_, which holds residuals or displacements of earlier rounds, or the
/// coordinates y of a KernelMap.
static constexpr std::size_t kernel_memory(const KernelChain& chain) {
  return 6 * chain.pairs > chain.joints ? 6 * chain.pairs : chain.joints;
}

/// The number of doubles of scratch memory that a solve needs with any instruction set.
static constexpr std::size_t kernel_scratch(const KernelChain& chain, const KernelSamples& samples) {
  const std::size_t rows = samples.varied + chain.joints + kernel_memory(chain) + 2 + 1;
  const std::size_t motions = 12 * (chain.segments + chain.limbs);
  const std::size_t screws = 6 * (chain.joints + chain.pairs + chain.limbs);
  const std::size_t equations = 3 * chain.joints * chain.joints + 6 * chain.joints;
  return rows * kernel_capacity(samples.count) + (motions + screws + equations) * kMostLanes;
}

/// Computes residuals and responses of a block of samples to first order. scratch: as for KernelSolve.
using KernelMapBlock = void (*)(const KernelChain&, const KernelSamples&, const KernelMap&, const KernelOutcome&,
                                double* scratch);

/// Finds the motion of the platform for a block of samples. Uses only the stride of the outcome. scratch: as for
/// KernelSolve.
using KernelMovePlatform = void (*)(const KernelChain&, const KernelSamples&, const KernelPlatform&,
                                    const KernelOutcome&, double* scratch);

/// Solves a block of samples. scratch: [kernel_scratch()], aligned to 64 bytes.
using KernelSolve = void (*)(const KernelChain&, const KernelSamples&, const KernelStart&, const KernelOptions&,
                             const KernelOutcome&, double* scratch);

}  // namespace poesy::chain
