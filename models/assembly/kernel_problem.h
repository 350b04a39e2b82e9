#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// What the kernel of assemblies solves, as plain numbers: no type of another room, so that it is compiled for each
/// instruction set. Lengths are in units of the reach, about the middle of the platform's points and along the axes in
/// which their metric is diagonal; compliances in units of the largest.
namespace poesy::assembly {

/// A rigid motion: rotation by rows, then translation.
struct KernelMotion {
  double r[9];  ///< rotation
  double p[3];  ///< translation
};

/// A constant motion that others are multiplied by.
struct KernelConstant {
  /// What a motion may be.
  enum class Shape : std::uint8_t { identity, translation, any };
  KernelMotion motion;  ///< all of it
  Shape shape;          ///< which parts of it are not those of the identity
};

/// The error of a fixed frame, rotation exp(omega) and translation v, or the inverse of that.
struct KernelError {
  bool turns;          ///< whether an angle varies or is not 0
  bool inverted;       ///< the limb's last one
  int varied[6];       ///< row of the values of each entry of [omega; v]; -1: it is constant
  double unit[6];      ///< by which these values are multiplied
  double constant[6];  ///< of entries that do not vary
};

/// before * error
struct KernelPiece {
  KernelConstant before;  ///< of the error
  KernelError error;      ///< of one frame
};

/// What is between two joints of a limb: pieces * behind. Frames without error and joints that keep their place are in
/// the constants.
struct KernelSegment {
  std::vector<KernelPiece> pieces;  ///< one for each frame with an error
  KernelConstant behind;            ///< of the last error
};

/// A joint that moves, or whose frame is reported.
struct KernelJoint {
  bool slides;          ///< along z; else it turns about z
  double advance;       ///< of one that turns, along z per rad
  int passive;          ///< its place among the limb's passive joints; -1: it keeps its place
  int mark;             ///< its place among the frames that are reported; -1: it is not
  double displacement;  ///< nominal
};

/// Passive joints of a limb in a matrix of its own.
inline constexpr std::size_t kMostOwnJoints = 6;

/// A limb from one body to another, and what its linear equations are made of; see Equilibrium.
struct KernelLimb {
  std::size_t from;                     ///< body
  std::size_t to;                       ///< body
  std::vector<KernelJoint> joints;      ///< [n]
  std::vector<KernelSegment> segments;  ///< [n + 1]; the base's place is in the first one of a limb that begins there
  std::size_t passive;                  ///< how many joints are
  std::size_t first_joint;              ///< where they begin among those of all limbs
  std::size_t first_wrench;             ///< where its lambda begins
  std::size_t carried;                  ///< how many it has
  std::vector<double> carry;            ///< [6 x carried] N, row by row
  std::vector<double> give;             ///< [passive x 6] dq of least norm from a twist
  double compliance[36];                ///< C
  double stiffness[36];                 ///< C^-1, where limbs have matrices of their own
  bool is_diagonal;                     ///< whether C^-1 is
  std::vector<double> idle;             ///< [passive squared] what keeps freedoms that move nothing where they are
};

/// A joint's frame in the report.
struct KernelMark {
  std::size_t limb;   ///< whose wrench acts there
  std::size_t mark;   ///< place of the frame
  KernelJoint joint;  ///< at which it is
};

/// What is reported of a sample, in the order of response_values().
struct KernelReport {
  bool deforms;                             ///< whether mismatch is
  bool has_tool;                            ///< whether the tool's point is
  bool has_forces;                          ///< whether energy, forces and moments are
  double metric[6];                         ///< diagonal of W: a twist's square (m^2)
  double origin[3];                         ///< of the platform, nominal
  double share;                             ///< 2 / independent loops
  double axes[9];                           ///< the base's axes from the kernel's
  double arm[3];                            ///< from the platform's origin to the tool, nominal
  double length;                            ///< unit (m)
  double force;                             ///< unit (N)
  double moment;                            ///< unit (N m); also that of energy (J)
  std::size_t marks;                        ///< frames of joints that are reported
  std::vector<KernelMotion> nominal_marks;  ///< [marks]
  std::vector<std::size_t> moments;         ///< [limbs] mark of the point about which its moment is
  std::vector<KernelMark> drives;           ///< in order
  std::vector<KernelMark> reactions;        ///< in order

  /// Responses of an assembly of that many bodies, with the base, and limbs.
  std::size_t rows(std::size_t bodies, std::size_t limbs) const {
    const std::size_t of_forces = has_forces ? 1 + 2 * limbs + drives.size() + 6 * reactions.size() : 0;
    return (deforms ? 3 : 0) + 8 * (bodies - 1) + (has_tool ? 4 : 0) + of_forces;
  }
};

/// The first order of samples: coordinates = offset + matrix * values that vary. Coordinates are the twists of bodies
/// without the base [6 x (bodies - 1)], stresses, displacements of passive joints.
struct KernelMap {
  static constexpr std::size_t kRows = 12;  ///< that are multiplied at once
  std::size_t entries;                      ///< values that vary
  std::size_t stresses;                     ///< coordinates of the wrenches that limbs put on each other
  std::vector<double> units;                ///< [entries] by which values are multiplied
  std::vector<double> offset;               ///< [rows, padded]
  std::vector<double> matrix;               ///< [rows / kRows, padded][entries][kRows]
  std::vector<double> wrenches;             ///< [6 limbs x stresses] of a unit of each stress, row by row
  std::vector<double> by_load;              ///< [6 limbs] of the load
};

/// Where solves with one varied error start: Chebyshev series of the state in t
/// = scale (value - centre), for |t| <= 1. A state has the twists of bodies
/// without the base [6 x (bodies - 1)], the wrenches of limbs [6 x limbs], and
/// what passive joints are displaced by from the nominal pose.
struct KernelStart {
  static constexpr std::size_t kTerms = 16;  ///< of a series
  bool is_used;                              ///< by these samples
  double centre;                             ///< of the error's range
  double scale;                              ///< 1 / half of its width
  std::vector<double> coefficients;          ///< [rows of a state x kTerms]
};

/// With which matrices rounds step.
enum class KernelStep : std::uint8_t {
  constant,  ///< the inverse of the nominal pose
  meet,      ///< projections of each sample, where limbs have no wrenches
  own        ///< matrices of each sample
};

/// An assembly at a pose, with its errors.
struct KernelProblem {
  std::vector<KernelMotion> bodies;  ///< nominal; the base too
  std::vector<KernelLimb> limbs;     ///< in the order of the file
  std::size_t joints;                ///< that are passive, of all limbs
  std::size_t size;                  ///< of the linear equations: all lambda, then 6 for each body but the base
  std::vector<double> inverse;       ///< [size x size] of their nominal matrix, row by row
  std::vector<double> load;          ///< [6 x bodies]
  bool carries;                      ///< whether there are wrenches: limbs deform each other, or a load acts
  KernelStep step;                   ///< of rounds
  double measured[6];                ///< from a twist to that by which its mismatch is measured, at most 1
  double unmeasured[6];              ///< and back
  bool wants_wrenches;               ///< whether wrenches must have settled too
  double tolerance;                  ///< of a body's move
  int most_rounds;                   ///< then a sample is left to another solver
  KernelReport report;               ///< of each sample
  KernelMap map;                     ///< first order
  KernelStart start;                 ///< of one varied error

  /// Rows of a state.
  std::size_t rows_of_state() const { return 6 * (bodies.size() - 1 + limbs.size()) + joints; }
};

/// How the kernel left a sample.
enum class KernelEnd : std::uint8_t { converged, left };

/// A block of samples. stride: at least count, and a multiple of the lanes of every instruction set.
struct KernelBlock {
  std::size_t count;          ///< samples
  std::size_t stride;         ///< from row to row
  const double* values;       ///< [entries x stride] errors that vary
  double* responses;          ///< [responses x stride] SI; of samples that are left, anything
  KernelEnd* ends;            ///< [stride]; first order does not write it
  std::uint32_t* iterations;  ///< [stride]; first order does not write it
  double* states = nullptr;   ///< [rows of a state x stride] where solves ended;
                              ///< null: nobody asks
};

/// Lanes of the widest instruction set.
inline constexpr std::size_t kKernelLanes = 8;

/// Works on a block.
using KernelWork = void (*)(const KernelProblem& problem, const KernelBlock& block);

/// Of one instruction set.
struct Kernels {
  KernelWork solve;  ///< exactly
  KernelWork map;    ///< to first order
};

}  // namespace poesy::assembly
