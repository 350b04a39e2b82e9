#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "models/chain/limb.h"
#include "models/lie/se3.h"

/// Mechanisms of limbs between bodies, with stiffness and loads. Twists [omega; v] and wrenches [moment; force] are in
/// the base frame about its origin, unless another frame is named. Units are SI and rad.
namespace poesy::assembly {

using Vector3 = lie::Vector3<double>;  ///< A point or a direction.
/// A [6 x 6] matrix, such as a compliance (from a wrench to a twist) or a metric.
using Matrix6 = lie::Matrix6<double>;
using Screw = lie::Screw<double>;          ///< A twist or a wrench.
using Transform = lie::Transform<double>;  ///< A rigid motion, or the pose of a frame.

/// Indices of the two bodies that every assembly has.
/// @{
inline constexpr std::size_t kBase = 0;      ///< the fixed body
inline constexpr std::size_t kPlatform = 1;  ///< the body whose place follows from the pose coordinates
/// @}

/// A rigid part.
struct Body {
  std::string name;                  ///< "base", "platform", or the name in the file
  Transform home;                    ///< pose base_T_body at the home pose
  double mass = 0.0;                 ///< mass, kg
  Vector3 centre = Vector3::Zero();  ///< centre of mass, in the body's frame (m)
};

/// The compliance of a joint's bearing and drive, in the joint's frame before the joint moves.
struct Bearing {
  /// Index of the joint in the limb. A joint with several freedoms is a series of joints with one freedom each; the
  /// index belongs to the first joint of the series.
  std::size_t joint;
  /// [6 x 6] Matrix from a wrench to a twist (SI); 0 in rigid directions and along passive freedoms.
  Matrix6 compliance;
};

/// An end of a link: at the point of a joint before the joint moves, or at a body's origin.
struct LinkEnd {
  /// The body at which the limb begins, a joint of the limb, or the body at which it ends.
  enum class At { from, joint, to };
  At at;                  ///< kind of end
  std::size_t joint = 0;  ///< index in the limb of the joint (of one freedom); used only if `at` is `joint`
};

/// The stiffnesses of the cross-section of a straight beam along x.
struct BeamSection {
  double EA = 0.0;   ///< tension stiffness, N
  double GJ = 0.0;   ///< torsion stiffness, N m^2
  double EIy = 0.0;  ///< bending stiffness about y, N m^2
  double EIz = 0.0;  ///< bending stiffness about z, N m^2
  /// Shear modulus times the part of the cross-section's area that carries shear (N). Without a value, shear is
  /// neglected.
  std::optional<double> shear_stiffness = {};
};

/// An elastic part of a limb between two joints, or between a body and a joint.
struct Link {
  LinkEnd from;  ///< end at which the x axis begins
  LinkEnd to;    ///< end to which the x axis points
  /// The y axis of the link. It is given in the frame of the body at `to`, or in that of the joint at `to` before the
  /// joint moves. A component along the x axis is removed. Without a value, the solver takes any direction
  /// perpendicular to x.
  std::optional<Vector3> y;
  /// The stiffnesses of the link if it is a beam. Otherwise its compliance matrix (SI) in a frame at the end `to`; the
  /// x axis of this frame is along the link, and the member `y` gives the y axis.
  std::variant<BeamSection, Matrix6> stiffness;
};

/// A limb from one body to another.
struct Limb {
  /// Joints between fixed frames, from the frame of body `from` to that of body `to`.
  chain::Limb chain;
  std::size_t from = kBase;            ///< index of the body at which the limb begins
  std::size_t to = kPlatform;          ///< index of the body at which the limb ends
  std::string label = {};              ///< label in messages and names, such as "2" or "rod_1"
  std::vector<Bearing> bearings = {};  ///< joint bearings with compliance
  std::vector<Link> links = {};        ///< links with compliance
  /// Compliance of the whole limb in the frame of the body `to`, added to that of bearings and links.
  std::optional<Matrix6> end = {};

  /// Returns true if a bearing, a link or the limb as a whole has compliance.
  bool is_elastic() const { return !bearings.empty() || !links.empty() || end; }
};

/// Loads with constant magnitudes and directions. They act at the nominal positions of their points of application.
struct Load {
  Vector3 gravity = Vector3::Zero();  ///< acceleration of gravity along the base's axes, m/s^2; acts on every mass
  std::size_t body = kPlatform;       ///< body on which force and moment act
  Vector3 at = Vector3::Zero();       ///< point of application, in the body's frame (m)
  Vector3 force = Vector3::Zero();    ///< force along the base's axes, N
  Vector3 moment = Vector3::Zero();   ///< moment about the base's axes, N m

  /// Returns true if the load exerts a force or a moment on any of these bodies.
  bool acts_on(const std::vector<Body>& bodies) const;
};

/// What determines the compliance matrices C of the limbs.
enum class Metric {
  /// No stiffness is known and no load acts; the matrices C follow from the mean square displacement of the platform's
  /// points, see nominal().
  platform,
  stiffness  ///< the matrices C follow from the stiffness of bearings, links and limbs
};

/// A mechanism of limbs that connect bodies.
struct Assembly {
  std::vector<Body> bodies;  ///< base, platform, then the other bodies
  std::vector<Limb> limbs;   ///< limbs, in the order of the file
  /// Points of the platform, in its frame (m), not all on a line. Their mean square displacement is the metric.
  std::vector<Vector3> points;
  std::optional<Vector3> tool = {};  ///< tool point, in the platform's frame (m)
  Load load = {};                    ///< gravity and external loads
  Metric metric = Metric::platform;  ///< whether compliances follow from `points` or from stiffness
  double reach = 1.0;                ///< size of the mechanism (m); unit of lengths in the solvers

  /// The number of independent loops of limbs.
  std::size_t loops() const { return limbs.size() - (bodies.size() - 1); }
  /// The number of joints of all limbs, including those that are fixed.
  std::size_t joints() const;
  /// The index of a limb's first joint among the joints of all limbs.
  std::size_t first_joint(std::size_t limb) const;
};

/// The indices of limbs by which bodies can be placed one after the other: for each body except the base, a limb that
/// ends there and begins at the base or at a body placed before. The list is shorter if no limbs lead from the base to
/// some bodies. AnyLimb is a type with the members `from` and `to`.
template <class AnyLimb>
std::vector<std::size_t> placing_limbs(std::size_t bodies, const std::vector<AnyLimb>& limbs) {
  std::vector<bool> is_placed(bodies, false);
  std::vector<std::size_t> order;
  const auto is_there = [&](std::size_t body) { return body == kBase || is_placed[body]; };
  const auto places = [&](const AnyLimb& limb) { return is_there(limb.from) && !is_there(limb.to); };
  for (auto next = limbs.begin(); (next = std::ranges::find_if(limbs, places)) != limbs.end();) {
    is_placed[next->to] = true;
    order.push_back(static_cast<std::size_t>(next - limbs.begin()));
  }
  return order;
}

}  // namespace poesy::assembly
