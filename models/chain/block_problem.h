#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/model/status.h"

// The plain data that goes into and comes out of a block kernel. Nothing but pointers and numbers: this header is
// also read by translation units compiled for one instruction set, which must not share inline functions.

namespace poesy::chain {

/// A passive joint, in the order of the limbs, base to platform.
struct KernelJoint {
  bool revolute;
  double nominal;  ///< displacement from which a solve starts unless told otherwise (rad, m)
};

/// A rigid motion between two passive joints, or before the first or behind the last one of a limb, as a product of
/// pieces: constant motions and errors of frames that vary from sample to sample.
struct KernelPiece {
  bool is_error;
  bool inverted;        ///< the error's inverse is meant
  double constant[12];  ///< of a constant motion: R by rows, then p
  double error[6];      ///< of an error: its constant part, [omega; v]
  int varied_row[6];    ///< row of KernelSamples::values that replaces that entry; -1 where it stays
};

struct KernelSegment {
  std::size_t first_piece;
  std::size_t pieces;
};

struct KernelLimb {
  std::size_t first_joint;  ///< among passive joints
  std::size_t joints;       ///< passive ones; the limb has joints + 1 segments
  double meetings;          ///< pairs it takes part in
};

struct KernelPair {
  std::size_t k;
  std::size_t i;
};

/// A parallel chain at one pose with its constant errors.
struct KernelChain {
  const KernelLimb* limb;
  std::size_t limbs;
  const KernelPair* pair;
  std::size_t pairs;
  const KernelJoint* joint;
  std::size_t joints;
  const KernelSegment* segment;  ///< [joints + limbs], limb by limb
  std::size_t segments;
  const KernelPiece* piece;
};

/// Samples in rows: entry (v, b) at v * stride + b.
struct KernelSamples {
  const double* values;
  std::size_t varied;
  std::size_t stride;
  std::size_t count;
};

/// /// Where solves start whose one varied error lies within half_width of center: a Chebyshev series of each passive
/// joint's displacement in (value - center) / half_width, [joints x kStartTerms].
struct KernelFit {
  double center;
  double half_width;
  const double* coefficients;
};
inline constexpr std::size_t kStartTerms = 16;

/// Fits for ranges of the error. Outside of all of them solves start from nominal displacements.
struct KernelStart {
  const KernelFit* fit;
  std::size_t fits;
};

enum class KernelMethod {
  gauss_newton,  ///< as published
  newton,
  newton_direct  ///< its first pass alone
};

struct KernelOptions {
  KernelMethod method;
  double tolerance;       ///< on the change of the residual
  double rounding_level;  ///< below which a change may be rounding
  double last_step;       ///< a safe Newton step below this is the last one
  double largest_step;    ///< that Newton may take from a start
  std::uint32_t max_iterations;
};

/// Rows as in KernelSamples, for all samples. The stride is at least kernel_capacity(count): entries behind the last
/// sample are overwritten.
struct KernelOutcome {
  double* delta_mu;       ///< [6 pairs x stride]
  double* responses;      ///< [3 x stride]: angular, linear, max
  double* displacements;  ///< [joints x stride], of passive joints; or null
  SolveStatus* status;
  std::uint32_t* iterations;
  std::size_t stride;
};

/// No instruction set has more lanes.
inline constexpr std::size_t kMostLanes = 8;

/// Samples that fit into rows of scratch, with room for the lanes behind the last one.
static constexpr std::size_t kernel_capacity(std::size_t count) { return (count / kMostLanes + 2) * kMostLanes; }

/// /// Rows that a pass may keep of earlier rounds: residuals, or displacements.
static constexpr std::size_t kernel_memory(const KernelChain& chain) {
  return 6 * chain.pairs > chain.joints ? 6 * chain.pairs : chain.joints;
}

/// Doubles of scratch that a solve needs, for any instruction set.
static constexpr std::size_t kernel_scratch(const KernelChain& chain, const KernelSamples& samples) {
  const std::size_t rows = samples.varied + chain.joints + kernel_memory(chain) + 2 + 1;
  const std::size_t motions = 12 * (chain.segments + chain.limbs);
  const std::size_t screws = 6 * (chain.joints + chain.pairs + chain.limbs);
  const std::size_t equations = 3 * chain.joints * chain.joints + 5 * chain.joints;
  return rows * kernel_capacity(samples.count) + (motions + screws + equations) * kMostLanes;
}

/// Solves a block. scratch: aligned to 64 bytes.
using KernelSolve = void (*)(const KernelChain&, const KernelSamples&, const KernelStart&, const KernelOptions&,
                             const KernelOutcome&, double* scratch);

}  // namespace poesy::chain
