#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// What the kernel of assemblies solves, as plain numbers: no type of another room, so that it is compiled for each
/// instruction set. Lengths are in units of the reach about the platform's origin, compliances in units of the largest.
namespace poesy::assembly {

/// A rigid motion: rotation by rows, then translation.
struct KernelMotion {
  double r[9];  ///< rotation
  double p[3];  ///< translation
};

/// A joint, nominally displaced.
struct KernelJoint {
  bool slides;          ///< along z; else it turns about z
  double advance;       ///< of one that turns, along z per rad
  int passive;          ///< its place among the limb's passive joints; -1: a drive holds it
  double displacement;  ///< nominal
};

/// A fixed frame, before * error * behind, or before * error^-1 * behind.
struct KernelFrame {
  KernelMotion before;  ///< of the error
  KernelMotion behind;  ///< of the error; without one the whole frame is in `before`
  bool has_error;       ///< whether any entry varies or is not 0
  bool turns;           ///< whether an angle does
  bool inverted;        ///< the limb's last one
  int varied[6];        ///< row of the values of each entry of [omega; v]; -1: it is constant
  double constant[6];   ///< of entries that do not vary
};

/// A limb from one body to another, and what its linear equations are made of; see Equilibrium.
struct KernelLimb {
  std::size_t from;                 ///< body
  std::size_t to;                   ///< body
  std::vector<KernelJoint> joints;  ///< [n]
  std::vector<KernelFrame> frames;  ///< [n + 1]
  std::size_t first_joint;          ///< among all joints
  std::size_t first_wrench;         ///< where its lambda begins
  std::size_t carried;              ///< how many it has
  std::vector<double> carry;        ///< [6 x carried] N, row by row
  std::vector<double> give;         ///< [passive x 6] dq of least norm from a twist
  double compliance[36];            ///< C
};

/// An assembly at a pose, with its errors.
struct KernelProblem {
  std::vector<KernelMotion> bodies;  ///< nominal; the base too
  std::vector<KernelLimb> limbs;     ///< in the order of the file
  std::size_t joints;                ///< of all limbs
  std::size_t size;                  ///< of the linear equations: all lambda, then 6 for each body but the base
  std::vector<double> inverse;       ///< [size x size] of their matrix, row by row
  std::vector<double> load;          ///< [6 x bodies]
  bool wants_wrenches;               ///< whether wrenches must have settled too
  double tolerance;                  ///< of a body's move
  int most_rounds;                   ///< then a sample is left to another solver

  /// Rows of numbers that a sample gives: 12 of each body, all displacements, 6 wrenches and 6 mismatches of each limb.
  std::size_t rows() const { return 12 * bodies.size() + joints + 12 * limbs.size(); }
};

/// How the kernel left a sample.
enum class KernelEnd : std::uint8_t { converged, left };

/// A block of samples. stride: at least count, and a multiple of the lanes of every instruction set.
struct KernelBlock {
  std::size_t count;          ///< samples
  std::size_t stride;         ///< from row to row
  const double* values;       ///< [entries x stride] errors that vary
  double* rows;               ///< [KernelProblem::rows() x stride]
  KernelEnd* ends;            ///< [stride]
  std::uint32_t* iterations;  ///< [stride]
};

/// Lanes of the widest instruction set.
inline constexpr std::size_t kKernelLanes = 8;

/// Solves a block.
using KernelSolve = void (*)(const KernelProblem& problem, const KernelBlock& block);

}  // namespace poesy::assembly
