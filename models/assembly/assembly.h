#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "models/chain/limb.h"
#include "models/lie/se3.h"

/// Limbs between bodies, with stiffness and forces. All twists [omega; v] and wrenches [moment; force] are in the base
/// frame about its origin unless a frame is named; SI and rad.
namespace poesy::assembly {

using Vector3 = lie::Vector3<double>;      ///< A point or a direction.
using Matrix6 = lie::Matrix6<double>;      ///< A compliance: twist from wrench; a metric.
using Screw = lie::Screw<double>;          ///< A twist or a wrench.
using Transform = lie::Transform<double>;  ///< A rigid motion.

/// Positions of the bodies that every assembly has.
/// @{
inline constexpr std::size_t kBase = 0;      ///< fixed
inline constexpr std::size_t kPlatform = 1;  ///< what the coordinates of a pose place
/// @}

/// A rigid part.
struct Body {
  std::string name;                  ///< "base", "platform", or as the file has it
  Transform home;                    ///< base_T_body at home
  double mass = 0.0;                 ///< kg
  Vector3 centre = Vector3::Zero();  ///< of mass, in the body's frame (m)
};

/// The compliance of a joint's bearing and drive, in the joint's frame before its motion.
struct Bearing {
  std::size_t joint;   ///< of the limb's elementary joints, the first that belongs to the joint
  Matrix6 compliance;  ///< 0 in directions that are rigid, and along passive freedoms
};

/// Where a link ends: at the point of a joint before its motion, or at a body's origin.
struct LinkEnd {
  /// The body where the limb begins, a joint, the body where it ends.
  enum class At { from, joint, to };
  At at;                  ///< which of them
  std::size_t joint = 0;  ///< elementary joint of the limb
};

/// The cross-section of a straight beam.
struct BeamSection {
  double EA = 0.0;                             ///< N
  double GJ = 0.0;                             ///< N m^2
  double EIy = 0.0;                            ///< N m^2
  double EIz = 0.0;                            ///< N m^2
  std::optional<double> shear_stiffness = {};  ///< share of the area that carries shear times G A (N); none: no shear
};

/// A part between two joints, or a body and a joint.
struct Link {
  LinkEnd from;  ///< where x begins
  LinkEnd to;    ///< where it points
  /// Its y axis in the frame of the joint at `to` before its motion, or of the body there; made perpendicular to the
  /// line. None: any.
  std::optional<Vector3> y;
  /// A beam, or the compliance of the part in a frame at the end at `to` with x along the line and this y.
  std::variant<BeamSection, Matrix6> stiffness;
};

/// A limb from one body to another.
struct Limb {
  chain::Limb chain;                   ///< joints between fixed frames, from the frame of one body to that of the other
  std::size_t from = kBase;            ///< position of the body where it begins
  std::size_t to = kPlatform;          ///< and where it ends
  std::string label = {};              ///< "2", "rod_1"
  std::vector<Bearing> bearings = {};  ///< that give way
  std::vector<Link> links = {};        ///< that give way
  std::optional<Matrix6> end = {};     ///< compliance in the frame of the body `to`, added to bearings and links

  /// Whether anything of it gives way to a wrench.
  bool is_elastic() const { return !bearings.empty() || !links.empty() || end; }
};

/// Dead loads, at the nominal places of their points.
struct Load {
  Vector3 gravity = Vector3::Zero();  ///< m/s^2, on every mass
  std::size_t body = kPlatform;       ///< that force and moment act on
  Vector3 at = Vector3::Zero();       ///< where, in the body's frame (m)
  Vector3 force = Vector3::Zero();    ///< N, base axes
  Vector3 moment = Vector3::Zero();   ///< N m, base axes

  /// Whether it exerts anything on these bodies.
  bool acts_on(const std::vector<Body>& bodies) const;
};

/// Where limbs get their compliance from.
enum class Metric {
  platform,  ///< no stiffness is known: C = W^-1 of the platform's points, and no load acts
  stiffness  ///< as bearings, links and limbs have it
};

/// A mechanism of limbs between bodies.
struct Assembly {
  std::vector<Body> bodies;          ///< base, platform, and the others
  std::vector<Limb> limbs;           ///< in the order of the file
  std::vector<Vector3> points;       ///< of the metric, in the platform's frame (m); on no line
  std::optional<Vector3> tool = {};  ///< in the platform's frame (m)
  Load load = {};                    ///< from outside
  Metric metric = Metric::platform;  ///< by which limbs give way
  double reach = 1.0;                ///< m

  /// Independent loops.
  std::size_t loops() const { return limbs.size() - (bodies.size() - 1); }
  /// Joints of all limbs, fixed frames included.
  std::size_t joints() const;
  /// Where a limb's joints begin among those of all limbs.
  std::size_t first_joint(std::size_t limb) const;
};

/// Of limbs with members `from` and `to` those by which bodies can be placed one after the other: of each body but the
/// base one that ends there, [bodies - 1], or fewer where no limb leads to some from the base.
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
