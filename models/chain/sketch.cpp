#include "models/chain/sketch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <utility>

#include "models/chain/first_order.h"

namespace poesy::chain {
namespace {

using Vector3 = lie::Vector3<double>;
using Transform = lie::Transform<double>;

/// Motions of limbs count as equal if they differ by at most this share of the largest motion (see sketched_motions()).
constexpr double kAlike = 1e-9;

SketchVector sketched(const Vector3& vector) { return {vector.x(), vector.y(), vector.z()}; }

SketchedFrame sketched(const Transform& frame) {
  return {sketched(frame.p), {sketched(frame.R.col(0)), sketched(frame.R.col(1)), sketched(frame.R.col(2))}};
}

LimbFrames frames_of(const Limb& limb, std::span<const double> displacements) {
  LimbFrames frames;
  Transform g;
  frames.after.push_back(g);
  for (std::size_t j = 0; j < limb.joints.size(); ++j) {
    g = g * limb.home[j];
    frames.before.push_back(g);
    move_joint(limb.joints[j], displacements[j], g);
    frames.after.push_back(g);
  }
  frames.after.push_back(g * limb.home.back());
  return frames;
}

/// The number (from 1) of the joint to which a frame of a limb belongs; 0 for the base, and the number of joints + 1
/// for the platform.
std::size_t joint_of(const std::vector<SketchedJoint>& joints, std::size_t frame, std::size_t platform) {
  if (frame == platform) return joints.size() + 1;
  return static_cast<std::size_t>(
      std::ranges::count_if(joints, [frame](const SketchedJoint& joint) { return joint.first <= frame; }));
}

/// SketchedError::own for the error with these terms. There is none if the error has one term, because its axis is an
/// axis of the frame; if the terms are in several frames; or if errors rotate about joints, because the terms then do
/// not state the point of a rotation.
std::optional<SketchedAxis> own_axis(const Sketch& sketch, const ErrorTerms& terms, std::size_t frame) {
  const ErrorTerm& first = terms.front();
  lie::Screw<double> twist = lie::Screw<double>::Zero();
  for (const ErrorTerm& term : terms) {
    if (term.limb != first.limb || term.frame != first.frame) return std::nullopt;
    twist[static_cast<Eigen::Index>(term.component)] += term.scale;
  }
  const Vector3 turn = twist.head<3>();
  const Vector3 shift = twist.tail<3>();
  const bool turns = turn.norm() > 0.0;
  if (terms.size() == 1 || sketch.errors_at_joints || !(twist.norm() > 0.0)) return std::nullopt;
  const SketchedFrame& at = sketch.frames[first.limb][frame];
  Transform own;
  for (Eigen::Index c = 0; c < 3; ++c) {
    own.R.col(c) = Vector3(at.axes[static_cast<std::size_t>(c)].data());
    own.p[c] = at.origin[static_cast<std::size_t>(c)];
  }
  if (turns) own.p += own.R * turn.cross(shift) / turn.squaredNorm();  // the point of the axis nearest to the frame
  own.R = own.R * Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), turns ? turn : shift).toRotationMatrix();
  return SketchedAxis{sketched(own), turns};
}

/// The motion of each limb's end by the error with these terms, or one motion if all are equal. displacements: [all
/// joints].
std::vector<SketchTwist> motions(const DeformationModel& model, FirstOrder& first_order, const ErrorTerms& terms,
                                 std::span<const double> displacements) {
  const ParallelChain& chain = model.chain;
  std::vector<double> delta_mu(6 * chain.pairs.size());
  std::vector<double> moved(chain.passive_joints());
  std::vector<lie::Screw<double>> twists(chain.limbs.size(), lie::Screw<double>::Zero());
  double moves = 0.0;
  for (const ErrorTerm& term : terms) {
    const FrameEntry entry = model.entry(term);
    const double scale = term.at(displacements);
    const lie::Screw<double> motion = scale * first_order.motion(entry);
    first_order.effect(entry, delta_mu, moved);
    twists[term.limb] += motion;
    for (std::size_t a = 0; a < moved.size(); ++a) {
      twists[first_order.limb_of_joint(a)] += scale * moved[a] * first_order.column(a);
    }
    moves = std::max(moves, motion.norm());
  }
  return sketched_motions(std::move(twists), moves);
}

void add_errors(Sketch& sketch, const DeformationModel& model, std::span<const double> displacements) {
  FirstOrder first_order(model.chain);
  const bool regular = first_order.prepare(displacements, nullptr);
  for (const ErrorTerms& terms : model.terms) {
    SketchedError& error = sketch.errors.emplace_back(sketched_error(sketch, terms));
    if (regular) error.motions = motions(model, first_order, terms, displacements);
  }
}

}  // namespace

void place_limb(Sketch& sketch, const LimbFrames& frames, bool errors_at_joints) {
  for (SketchedJoint& joint : sketch.limbs[sketch.frames.size()]) {
    joint.point = sketched(frames.before[joint.frame - 1].p);
    joint.axis = sketched(frames.before[joint.first - 1].R.col(2));
  }
  std::vector<SketchedFrame>& list = sketch.frames.emplace_back();
  for (const Transform& frame : frames.after) list.push_back(sketched(frame));
  sketch.errors_at_joints = errors_at_joints;
  if (!errors_at_joints) return;
  list.front().origin = sketched(frames.before.front().p);
  list.back().origin = list[frames.before.size()].origin;
}

std::vector<SketchTwist> sketched_motions(std::vector<lie::Screw<double>> motions, double moves) {
  double largest = moves;
  double apart = 0.0;
  for (const lie::Screw<double>& motion : motions) {
    largest = std::max(largest, motion.norm());
    apart = std::max(apart, (motion - motions.front()).norm());
  }
  if (apart <= kAlike * largest) motions.resize(1);
  std::vector<SketchTwist> list;
  for (const lie::Screw<double>& motion : motions) {
    SketchTwist& one = list.emplace_back();
    for (std::size_t c = 0; c < one.size(); ++c) one[c] = motion[static_cast<Eigen::Index>(c)];
  }
  return list;
}

SketchedError sketched_error(const Sketch& sketch, const ErrorTerms& terms) {
  const ErrorTerm& term = terms.front();
  const std::vector<SketchedJoint>& joints = sketch.limbs[term.limb];
  const std::size_t end = sketch.frames[term.limb].size() - 1;  // index of the frame of the limb's last body
  const std::size_t frame = term.frame + 1 == end ? end : term.frame;
  return {.limb = term.limb,
          .frame = frame,
          .axis = term.component % 3,
          .turns = term.component < 3,
          .after = joint_of(joints, term.frame, end),
          .before = joint_of(joints, term.frame + 1, end),
          .motions = {},
          .own = own_axis(sketch, terms, frame)};
}

void place(Sketch& sketch, const DeformationModel& model, std::span<const double> displacements) {
  sketch.frames.clear();
  std::span<const double> left = displacements;
  Transform platform;
  for (std::size_t i = 0; i < sketch.limbs.size(); ++i) {
    const Limb& limb = model.chain.limbs[i];
    const LimbFrames frames = frames_of(limb, left.first(limb.joints.size()));
    left = left.subspan(limb.joints.size());
    if (i == 0) platform = frames.after.back();
    place_limb(sketch, frames, limb.errors_at_joints);
  }
  sketch.platform = sketched(platform.p);
  sketch.tool.clear();
  if (model.platform && model.platform->tool) {
    sketch.tool.push_back(sketched(platform.p + platform.R * *model.platform->tool));
  }
  sketch.errors.clear();
  add_errors(sketch, model, displacements);
}

}  // namespace poesy::chain
