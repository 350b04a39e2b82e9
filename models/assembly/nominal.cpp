#include "models/assembly/nominal.h"

#include <algorithm>
#include <numeric>

#include "engine/linalg/decompositions.h"
#include "models/assembly/compliance.h"
#include "models/chain/metric.h"

namespace poesy::assembly {
namespace {

/// The wrench about the base's origin of a force and a moment at a point.
Screw wrench_at(const Vector3& point, const Vector3& force, const Vector3& moment) {
  Screw wrench;
  wrench << moment + point.cross(force), force;
  return wrench;
}

std::vector<Screw> loads(const Assembly& assembly, const std::vector<Transform>& bodies) {
  const Load& load = assembly.load;
  std::vector<Screw> list(bodies.size(), Screw::Zero());
  for (std::size_t b = kPlatform; b < bodies.size(); ++b) {
    const Body& body = assembly.bodies[b];
    list[b] += wrench_at(bodies[b].R * body.centre + bodies[b].p, body.mass * load.gravity, Vector3::Zero());
  }
  const Transform& loaded = bodies[load.body];
  list[load.body] += wrench_at(loaded.R * load.at + loaded.p, load.force, load.moment);
  list[kBase].setZero();
  return list;
}

}  // namespace

std::vector<std::size_t> limbs_in_a_row(const Assembly& assembly) {
  std::vector<std::size_t> touching(assembly.bodies.size(), 0);
  for (const Limb& limb : assembly.limbs) {
    ++touching[limb.from];
    ++touching[limb.to];
  }
  // For each limb, the number of the row of limbs (limbs_in_a_row()) to which it belongs.
  std::vector<std::size_t> row(assembly.limbs.size());
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t b = kPlatform + 1; b < assembly.bodies.size(); ++b) {
    if (touching[b] != 2) continue;
    std::vector<std::size_t> ends;
    for (std::size_t e = 0; e < row.size(); ++e) {
      if (assembly.limbs[e].from == b || assembly.limbs[e].to == b) ends.push_back(row[e]);
    }
    std::ranges::replace(row, ends[1], ends[0]);
  }
  std::vector<std::size_t> counts;
  for (const std::size_t number : row) counts.push_back(static_cast<std::size_t>(std::ranges::count(row, number)));
  return counts;
}

Matrix6 twists_in_units(const Transform& frame, double length) {
  Matrix6 made = lie::adjoint(frame.inverse());
  made.bottomRows<3>() /= length;
  return made;
}

Transform frame_of_metric(const Matrix6& W) {
  Transform frame;
  frame.p = -Vector3(W(5, 1), W(3, 2), W(4, 0));  // in W, the rows of v and columns of omega are -hat(centroid)
  const Matrix6 back = lie::adjoint(frame);
  frame.R = linalg::eigen_decomposition((back.transpose() * W * back).topLeftCorner<3, 3>()).vectors;
  if (frame.R.determinant() < 0.0) frame.R.col(2) *= -1.0;
  return frame;
}

std::vector<std::size_t> passive_ranks(const Assembly& assembly, const Nominal& pose, double threshold) {
  const Matrix6 units =
      twists_in_units(Transform{lie::Matrix3<double>::Identity(), pose.bodies[kPlatform].p}, assembly.reach);
  std::vector<std::size_t> ranks;
  for (const LimbState& limb : pose.limbs) ranks.push_back(linalg::rank(units * limb.passive, threshold));
  return ranks;
}

Nominal nominal(const Assembly& assembly, std::span<const double> displacements) {
  Nominal made{.displacements = {displacements.begin(), displacements.end()},
               .bodies = std::vector<Transform>(assembly.bodies.size()),
               .limbs = std::vector<LimbState>(assembly.limbs.size()),
               .compliance = {},
               .load = {},
               .mismatch = std::vector<Screw>(assembly.limbs.size(), Screw::Zero()),
               .W = {}};
  const auto state_of = [&](std::size_t e) {
    const Limb& limb = assembly.limbs[e];
    return limb_state(limb, made.bodies[limb.from], limb.chain.home,
                      displacements.subspan(assembly.first_joint(e), limb.chain.joints.size()));
  };
  for (const std::size_t e : placing_limbs(assembly.bodies.size(), assembly.limbs))
    made.bodies[assembly.limbs[e].to] = state_of(e).end;
  for (std::size_t e = 0; e < assembly.limbs.size(); ++e) made.limbs[e] = state_of(e);
  std::vector<Vector3> points;
  const Transform& platform = made.bodies[kPlatform];
  for (const Vector3& point : assembly.points) points.emplace_back(platform.R * point + platform.p);
  made.W = chain::metric_of_points(points);
  if (assembly.metric == Metric::stiffness) {
    for (std::size_t e = 0; e < assembly.limbs.size(); ++e) {
      const Limb& limb = assembly.limbs[e];
      made.compliance.push_back(limb_compliance(limb, made.limbs[e], made.bodies[limb.from], made.bodies[limb.to]));
    }
    made.load = loads(assembly, made.bodies);
    return made;
  }
  const Matrix6 whole = linalg::inverse(made.W);
  for (const std::size_t count : limbs_in_a_row(assembly)) made.compliance.push_back(whole / double(count));
  made.load.assign(assembly.bodies.size(), Screw::Zero());
  return made;
}

}  // namespace poesy::assembly
