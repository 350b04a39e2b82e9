#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// The problem that the kernels of assemblies solve. It consists of plain numbers and uses no types of other folders,
/// because the kernels are compiled for each instruction set. Lengths are in units of the reach. The origin is the
/// centroid of the platform's points, and the axes are those in which their metric is diagonal. The unit of compliances
/// is the largest entry of the limbs' compliances.
namespace poesy::assembly {

/// A rigid motion.
struct KernelMotion {
  double r[9];  ///< rotation matrix, row by row
  double p[3];  ///< translation
};

/// A constant factor of a product of motions.
struct KernelConstant {
  /// The form of a motion: the identity, only a translation, or any motion.
  enum class Shape : std::uint8_t { identity, translation, any };
  KernelMotion motion;  ///< the whole motion
  Shape shape;          ///< form of the motion; a product skips the parts of the computation that would change nothing
};

/// The error of a fixed frame, with rotation exp(omega) and translation v, or its inverse.
struct KernelError {
  bool turns;          ///< true if the error has a rotation: an angle varies or is not zero
  bool inverted;       ///< true if the inverse is applied, as in the limb's last frame
  int varied[6];       ///< row of KernelBlock::values for each component of [omega; v]; -1 if the component is constant
  double unit[6];      ///< factor from each varied value to the component (rad, or units of the reach)
  double constant[6];  ///< value of each constant component (rad, or units of the reach)
};

/// A constant motion, followed by the error of a frame.
struct KernelPiece {
  KernelConstant before;  ///< motion before the error
  KernelError error;      ///< error of one frame
};

/// The motion between two joints of a limb: the product of all pieces and of `behind`. The constant motions include
/// frames without errors, and joints that are neither passive nor reported.
struct KernelSegment {
  std::vector<KernelPiece> pieces;  ///< a piece for each frame with an error
  KernelConstant behind;            ///< motion behind the last error
};

/// A passive joint, or an actuated joint whose frame is reported.
struct KernelJoint {
  bool slides;          ///< true: it slides along z; false: it rotates about z
  double advance;       ///< displacement along z (in units of the reach) per rad of a rotating joint; else 0
  int passive;          ///< index among the limb's passive joints; -1 if the joint is not passive
  int mark;             ///< index among the reported joint frames; -1 if this frame is not reported
  double displacement;  ///< nominal displacement (rad, or units of the reach)
};

/// The largest number of passive joints of a limb in problems whose samples have matrices of their own
/// (KernelStep::meet and KernelStep::own).
inline constexpr std::size_t kMostOwnJoints = 6;

/// A limb from one body to another, with the data of its linear equations; see Equilibrium for carry, give and lambda.
struct KernelLimb {
  std::size_t from;                 ///< index of the body at which the limb begins
  std::size_t to;                   ///< index of the body at which the limb ends
  std::vector<KernelJoint> joints;  ///< joints that are passive or reported
  /// Motions before, between and behind these joints. If the limb begins at the base, the first motion includes the
  /// pose of the base in the kernel's frame.
  std::vector<KernelSegment> segments;
  std::size_t passive;       ///< number of passive joints
  std::size_t first_joint;   ///< index of the limb's first passive joint among those of all limbs
  std::size_t first_wrench;  ///< index of the limb's first lambda (wrench coordinate) among all
  std::size_t carried;       ///< number of wrenches that the limb can carry, each with one lambda
  /// [6 x carried] Basis of the wrenches that the limb can carry (N of Equilibrium), row by row.
  std::vector<double> carry;
  std::vector<double> give;  ///< [passive x 6] matrix from a twist to the passive joints' displacements of least norm
  double compliance[36];     ///< compliance of the limb, row by row
  double stiffness[36];      ///< inverse of the compliance, row by row; set only for KernelStep::own
  bool is_diagonal;          ///< true if the matrix `stiffness` is diagonal
  /// [passive x passive] Terms that make the limb's matrix regular although some passive joints can move without moving
  /// a body (idle freedoms).
  std::vector<double> idle;
};

/// A joint whose frame is reported.
struct KernelMark {
  std::size_t limb;   ///< index of the limb whose wrench acts on the joint
  std::size_t mark;   ///< index among the reported joint frames
  KernelJoint joint;  ///< the joint itself
};

/// The data from which the responses of a sample are computed. The responses have the order of response_values().
struct KernelReport {
  bool deforms;      ///< true if mismatch is reported
  bool has_motions;  ///< true if displacements of bodies are reported
  bool has_tool;     ///< true if the displacement of the tool point is reported
  bool has_forces;   ///< true if energy, forces and moments are reported
  double metric[6];  ///< diagonal of the metric W: xi^T W xi is in m^2 for a twist xi in the kernel's units
  double origin[3];  ///< nominal origin of the platform
  double share;  ///< factor by which sums over the limbs of squared mismatches are multiplied before the root is taken:
                 ///< 2 / (number of independent loops)
  double axes[9];                           ///< rotation from the kernel's axes to the base's axes
  double arm[3];                            ///< nominal vector from the platform's origin to the tool point
  double length;                            ///< unit of lengths (m)
  double force;                             ///< unit of forces (N)
  double moment;                            ///< unit of moments (N m) and of energy (J)
  std::size_t marks;                        ///< number of joint frames that are reported
  std::vector<KernelMotion> nominal_marks;  ///< [marks] nominal joint frames
  /// [limbs] Index of the reported frame about whose origin each limb's moment is taken.
  std::vector<std::size_t> moments;
  std::vector<KernelMark> drives;     ///< driven joints, in the order of the responses
  std::vector<KernelMark> reactions;  ///< joints whose reactions are reported

  /// The number of responses (rows of KernelBlock::responses) of an assembly with this number of bodies (including the
  /// base) and limbs.
  std::size_t rows(std::size_t bodies, std::size_t limbs) const {
    const std::size_t of_forces = has_forces ? 1 + 2 * limbs + drives.size() + 6 * reactions.size() : 0;
    const std::size_t of_motions = has_motions ? 8 * (bodies - 1) + (has_tool ? 4 : 0) : 0;
    return (deforms ? 3 : 0) + of_motions + of_forces;
  }
};

/// The map from the varied values to first-order outcomes: coordinates = offset + matrix * u, where u is the vector of
/// the varied values, each multiplied by its factor in `units`. The coordinates are, in this order, the twists of the
/// bodies without the base [6 x (bodies - 1)], the stresses, and the displacements of passive joints.
struct KernelMap {
  static constexpr std::size_t kRows = 12;  ///< number of coordinates that are computed together
  std::size_t entries;                      ///< number of varied values of a sample
  std::size_t stresses;        ///< number of stresses: the coordinates of wrenches by which limbs load each other
  std::vector<double> units;   ///< [entries] factor of each varied value
  std::vector<double> offset;  ///< [coordinates, padded to whole kRows] coordinates if the varied values are 0
  /// [blocks of kRows coordinates][entries][kRows] Change of each coordinate per unit of each entry of u; the last
  /// block is padded.
  std::vector<double> matrix;
  std::vector<double> wrenches;  ///< [6 limbs x stresses] wrenches per unit of each stress, row by row
  std::vector<double> by_load;   ///< [6 limbs] wrenches without errors, by load and rounded numbers
};

/// Starting points of solves with one varied error: Chebyshev series of the state in t = scale (x - centre), for
/// |t| <= 1. Here x is the first component of a frame's error that the varied error changes: the first row of
/// KernelBlock::values times KernelMap::units[0]. A state consists of the twists of the bodies without the base [6 x
/// (bodies - 1)], the wrenches of the limbs [6 x limbs], and the displacements of the passive joints from the nominal
/// pose.
struct KernelStart {
  static constexpr std::size_t kTerms = 16;  ///< number of terms of a series
  bool is_used;                              ///< true if the samples start from the series
  double centre;                             ///< value of x if the varied error is 0
  double scale;                              ///< 1 / (change of x from the centre to the end of the error's range)
  std::vector<double> coefficients;          ///< [numbers of a state x kTerms] coefficients of the series
};

/// The kind of matrix with which an iteration (round) makes its step.
enum class KernelStep : std::uint8_t {
  constant,  ///< the inverse matrix of the nominal pose: ConstantStep
  meet,      ///< projections of each sample, if limbs have no wrenches: MeetStep
  own        ///< matrices of each sample: OwnStep
};

/// An assembly at a pose, with errors.
struct KernelProblem {
  std::vector<KernelMotion> bodies;  ///< nominal poses of all bodies, including the base
  std::vector<KernelLimb> limbs;     ///< limbs, in the order of the file
  std::size_t joints;                ///< number of passive joints of all limbs
  std::size_t size;                  ///< number of equations: one for each lambda, 6 for each body but the base
  std::vector<double> inverse;       ///< [size x size] inverse of the nominal matrix, row by row
  std::vector<double> load;          ///< [6 x bodies] wrench of the load on each body
  bool carries;                      ///< true if limbs have wrenches, because they deform each other or a load acts
  KernelStep step;                   ///< the matrix with which rounds (iterations) make their steps
  /// Factors, at most 1, from the components of a twist to measured coordinates. The sum of squares of these
  /// coordinates is proportional to the square of the twist in the metric.
  double measured[6];
  double unmeasured[6];  ///< inverses of the factors `measured`
  bool wants_wrenches;   ///< true if a sample converges only when its wrenches do
  double tolerance;      ///< tolerance of the changes of bodies and joints, in units of the reach
  int most_rounds;       ///< number of rounds after which a sample is left to another solver
  KernelReport report;   ///< the data for the responses of each sample
  KernelMap map;         ///< the first-order outcomes
  KernelStart start;     ///< starting points of samples with one varied error

  /// The number of rows of a state, see KernelStart.
  std::size_t rows_of_state() const { return 6 * (bodies.size() - 1 + limbs.size()) + joints; }
};

/// How the solve of a sample by the kernel ended. doubtful: the solve converged, but perhaps to another solution than
/// the one that grows from the nominal pose, because it started far from the nominal pose, or its steps once shrank
/// slowly. left: another solver must solve the sample.
enum class KernelEnd : std::uint8_t { converged, doubtful, left };

/// A block of samples. The stride is at least count, and a multiple of the number of lanes of every instruction set.
struct KernelBlock {
  std::size_t count;     ///< number of samples
  std::size_t stride;    ///< distance between rows, in numbers
  const double* values;  ///< [KernelMap::entries x stride] varied values
  /// [responses x stride] Responses, SI; arbitrary for samples with KernelEnd::left, which another solver must solve.
  double* responses;
  /// [stride] How each sample ended. After a first-order solve, `left` means that the result is not finite.
  KernelEnd* ends;
  std::uint32_t* iterations;  ///< [stride] iterations of each sample; not written by a first-order solve
  double* states = nullptr;   ///< [rows_of_state() x stride] states after the solves; null if not wanted
  /// [6 limbs x stride] Mismatch xi of each limb, in the kernel's units and axes; null if not wanted.
  double* mismatch = nullptr;
};

/// Writes how the samples in these lanes ended. Bit k of `left` or `doubtful` is set if the sample in lane k ended in
/// this way; if neither is set, the sample converged.
static inline void put_ends(unsigned left, unsigned doubtful, std::size_t lanes, KernelEnd* ends) {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const auto is_set = [lane](unsigned bits) { return (bits >> lane & 1u) != 0; };
    ends[lane] = is_set(left) ? KernelEnd::left : is_set(doubtful) ? KernelEnd::doubtful : KernelEnd::converged;
  }
}

/// The number of lanes of the widest instruction set.
inline constexpr std::size_t kKernelLanes = 8;

/// A function that computes the outcomes of a block of samples.
using KernelWork = void (*)(const KernelProblem& problem, const KernelBlock& block);

/// The kernels of one instruction set.
struct Kernels {
  KernelWork solve;  ///< solves blocks exactly
  KernelWork map;    ///< solves blocks to first order
};

}  // namespace poesy::assembly
