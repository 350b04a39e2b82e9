#include "models/file/misfit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "engine/linalg/decompositions.h"
#include "models/chain/limb.h"
#include "models/file/loops.h"
#include "models/file/structure.h"

namespace poesy::file {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kDependent = 1e-9;
constexpr double kMillimetres = 1e3;

/// A joint whose point or axis may be wrong, in a limb and its copies.
struct Suspect {
  std::vector<std::size_t> limbs;
  std::size_t first;  ///< index in the limb of the suspect's first elementary joint
  std::size_t count;  ///< number of the suspect's elementary joints
  bool point;         ///< true: the joint's point is suspected; false: its axis
};

/// The loop equations at one pose, projected onto the mismatch that no motion of the joints can remove. The metric
/// weighs rotation against displacement.
struct PoseEquations {
  State state;
  lie::Matrix6<double> root;
  /// [6 limbs x D] Orthonormal basis of the D-dimensional space of this mismatch. This space is perpendicular to the
  /// effects of the joints' motions and of the pose components that are not given.
  Matrix rest;
  Vector mismatch;  ///< [D] mismatch in this basis
};

PoseEquations equations_at(const Mechanism& unit, const Tracked& tracked) {
  PoseEquations made;
  made.state = tracked.state;
  const LoopEquations loops = loop_equations(unit, made.state);
  std::vector<std::size_t> free;
  const std::size_t moving = unit.moving();  // in a State, the pose of the platform follows these joints
  for (std::size_t k = 0; k < static_cast<std::size_t>(made.state.size()); ++k) {
    const bool given = k >= moving && std::ranges::find(unit.coordinates, k - moving, &Coordinate::component) !=
                                          unit.coordinates.end();
    if (!given) free.push_back(k);
  }
  made.root = metric_root(unit, pose_of(unit, made.state));
  made.rest =
      linalg::orthogonal_complement(weighed(made.root, loops.columns(Eigen::all, free)), unit.precision.rank_threshold);
  made.mismatch = made.rest.transpose() * weighed(made.root, loops.residual);
  return made;
}

/// Adds to `list` the suspects of a limb: its joints as written, each once for its point and once for its axis. The
/// axes of spherical joints (S) are not suspects, because they follow from neighbouring joints. The two axes of a
/// cylindrical joint (C) are one suspect.
void add_suspects(const Limb& limb, std::size_t position, std::vector<Suspect>& list) {
  for (std::size_t j = 0; j < limb.joints.size();) {
    std::size_t end = j + 1;
    while (end < limb.joints.size() && limb.joints[end].name == limb.joints[j].name) ++end;
    const std::size_t count = end - j;
    list.push_back({{position}, j, count, true});
    const bool cylindrical = count == 2 && limb.joints[j + 1].motion == Motion::prismatic;
    if (cylindrical) {
      list.push_back({{position}, j, 2, false});
    } else if (count < 3) {
      for (std::size_t k = j; k < end; ++k) list.push_back({{position}, k, 1, false});
    }
    j = end;
  }
}

/// The suspects of all limbs. Copies share one suspect, because the file states them once.
std::vector<Suspect> suspects_of(const Mechanism& unit) {
  std::vector<Suspect> list;
  const auto written = [&](std::size_t limb) {
    const Place& place = unit.limbs[limb].joints.front().place;
    return std::pair(place.line, place.column);
  };
  for (std::size_t i = 0; i < unit.limbs.size(); ++i) {
    if (i == 0 || written(i) != written(i - 1)) {
      add_suspects(unit.limbs[i], i, list);
      continue;
    }
    for (Suspect& suspect : list) {
      if (suspect.limbs.back() == i - 1) suspect.limbs.push_back(i);
    }
  }
  return list;
}

/// For each elementary joint of the suspect, the matrix [6 x 6] from a small twist of its axis at home to the change of
/// the limb's residual, if the limb's other axes stay where they are. position: index of the limb.
std::vector<lie::Matrix6<double>> effects_of_axes(const Mechanism& unit, const State& state, const Suspect& suspect,
                                                  std::size_t position) {
  std::size_t k = 0;
  for (std::size_t i = 0; i < position; ++i) k += unit.limbs[i].moving();
  const Limb& limb = unit.limbs[position];
  std::vector<lie::Matrix6<double>> effects;
  Transform g = transform_of(unit, state, limb.from) * limb.home.front();
  for (std::size_t j = 0; j < suspect.first + suspect.count; ++j) {
    const Joint& joint = limb.joints[j];
    const Transform before = g * joint.at_home.inverse();
    if (joint.moves()) chain::move_joint(joint.of_chain(), state[static_cast<Index>(k++)], g);
    const Transform after = g * joint.at_home.inverse();
    if (j >= suspect.first) effects.emplace_back(lie::adjoint(after) - lie::adjoint(before));
    g = g * limb.home[j + 1];
  }
  return effects;
}

/// The directions in which the suspect's point may move or its axis may rotate in a limb, as twists at the base's
/// origin. They are along and about axes of the suspect's frame, which rotate with the copies.
Eigen::Matrix<double, 6, Eigen::Dynamic> twists_of(const Suspect& suspect, const Limb& limb) {
  const Transform& home = limb.joints[suspect.first].at_home;
  Eigen::Matrix<double, 6, Eigen::Dynamic> twists(6, suspect.point ? 3 : 2);
  twists.setZero();
  for (Eigen::Index c = 0; c < twists.cols(); ++c) {
    const Vector3 axis = home.R.col(c);
    if (suspect.point) {
      twists.col(c).tail<3>() = axis;
    } else {
      twists.col(c) << axis, home.p.cross(axis);
    }
  }
  return twists;
}

/// A correction of a suspect, and the mismatch that would remain.
struct Correction {
  Suspect suspect;
  Vector by;       ///< correction along the suspect's twists (rad, or share of the reach)
  Vector is_left;  ///< [poses] remaining |mismatch| at each pose
};

Correction correction_of(const Mechanism& unit, const std::vector<PoseEquations>& poses, const Suspect& suspect) {
  Index rows = 0;
  for (const PoseEquations& pose : poses) rows += pose.mismatch.size();
  Matrix effects = Matrix::Zero(rows, suspect.point ? 3 : 2);
  Vector mismatch(rows);
  Index row = 0;
  for (const PoseEquations& pose : poses) {
    for (const std::size_t limb : suspect.limbs) {
      lie::Matrix6<double> sum = lie::Matrix6<double>::Zero();
      for (const lie::Matrix6<double>& one : effects_of_axes(unit, pose.state, suspect, limb)) sum += one;
      effects.middleRows(row, pose.mismatch.size()) +=
          pose.rest.middleRows<6>(6 * static_cast<Index>(limb)).transpose() *
          (pose.root * sum * twists_of(suspect, unit.limbs[limb]));
    }
    mismatch.segment(row, pose.mismatch.size()) = pose.mismatch;
    row += pose.mismatch.size();
  }
  Correction made{suspect, -linalg::least_squares(effects, mismatch, kDependent), {}};
  const Vector is_left = mismatch + effects * made.by;
  made.is_left.resize(static_cast<Index>(poses.size()));
  row = 0;
  for (std::size_t m = 0; m < poses.size(); ++m) {
    made.is_left[static_cast<Index>(m)] = is_left.segment(row, poses[m].mismatch.size()).norm();
    row += poses[m].mismatch.size();
  }
  return made;
}

/// A correction as text: "its axis along (0, 0, 1) instead of (0.001, 0, 1)".
std::string corrected_text(const Transform& home, double reach, const Correction& correction) {
  if (correction.suspect.point) {
    const double scale = kMillimetres * reach;
    return fmt::format("its point at {} mm instead of {} mm", triple_text(scale * (home.p + home.R * correction.by)),
                       triple_text(scale * home.p));
  }
  const Vector3 turn = home.R.leftCols<2>() * correction.by;
  const Vector3 z = home.R.col(2);
  return fmt::format("its axis along {} instead of {}", triple_text((z + turn.cross(z)).normalized()), triple_text(z));
}

}  // namespace

InputError misfit(const Mechanism& mechanism, std::span<const PoseMobility> poses) {
  const Mechanism unit = in_reaches(mechanism);
  std::vector<PoseEquations> equations;
  double mismatch = 0.0;
  for (const PoseMobility& pose : poses) {
    equations.push_back(equations_at(unit, pose.tracked));
    mismatch = std::max(mismatch, pose.tracked.mismatch);
  }
  std::optional<Correction> best;
  for (const Suspect& suspect : suspects_of(unit)) {
    Correction correction = correction_of(unit, equations, suspect);
    if (!best || correction.is_left.norm() < best->is_left.norm()) best = std::move(correction);
  }
  // The response `gap` is a root mean square over pairs of limbs, but the remaining mismatch is the root of a sum over
  // limbs i. The residuals r_i of the limbs add up to 0, so the sum of |r_k - r_i|^2 over pairs is (number of limbs) x
  // (sum of |r_i|^2).
  const double is_left =
      mechanism.reach * best->is_left.maxCoeff() * std::sqrt(2.0 / static_cast<double>(unit.loops()));
  const std::size_t first = best->suspect.limbs.front();
  const Joint& joint = unit.limbs[first].joints[best->suspect.first];
  return {joint.place,
          fmt::format("the limbs do not fit each other: in the workspace they hold {} up to {} apart, {:.1e} "
                      "of the reach, and up to 1e-4 of it counts as rounding",
                      unit.is_branched() ? "bodies" : "the platform", small_length_text(mismatch),
                      mismatch / mechanism.reach),
          fmt::format("look at joint '{}' of limb {}{}: with {}, {} would be left", joint.name, first + 1,
                      best->suspect.limbs.size() > 1 ? " and its copies" : "",
                      corrected_text(joint.at_home, mechanism.reach, *best), small_length_text(is_left))};
}

}  // namespace poesy::file
