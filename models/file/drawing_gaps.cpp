#include "models/file/drawing_gaps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include "engine/base/units.h"
#include "engine/drawing/zone_scatter.h"
#include "engine/linalg/decompositions.h"
#include "models/chain/limb.h"
#include "models/file/mobility.h"
#include "models/file/structure.h"
#include "models/file/tracking.h"

namespace poesy::file {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;

/// Vectors of length 1 count as dependent if a singular value of the matrix with these columns is below this.
constexpr double kDependent = 1e-6;

/// An orthonormal basis of all x with A x = 0. Singular values up to `nothing` count as 0.
Matrix null_space(const Matrix& A, double nothing = kDependent) {
  if (A.rows() == 0 || A.cols() == 0) return Matrix::Identity(A.cols(), A.cols());
  const linalg::SingularValueDecomposition svd = linalg::right_singular_vectors(A);
  return svd.V.rightCols(A.cols() - (svd.values.array() > nothing).count());
}

/// An orthonormal basis of the space perpendicular to the columns of A.
Matrix complement(const Matrix& A) { return null_space(A.transpose()); }

/// The geometry of a limb at a pose, with lengths in units of the reach.
struct PlacedLimb {
  /// [joints + 1] base_T_part for each fixed frame of the limb: pose of the part in whose axes the errors of the frame
  /// are stated.
  std::vector<Transform> parts;
  Matrix passive;  ///< [6 x passive joints] twists of the passive joints at the base's origin
};

PlacedLimb placed(const Limb& limb, std::span<const double> displacements, const Transform& from) {
  PlacedLimb made{{from}, Matrix(6, 0)};
  Transform g = from * limb.home.front();
  for (std::size_t j = 0; j < limb.joints.size(); ++j) {
    const Joint& joint = limb.joints[j];
    if (joint.moves()) {
      const chain::Joint moving = joint.of_chain();
      if (!joint.actuated) {
        made.passive.conservativeResize(Eigen::NoChange, made.passive.cols() + 1);
        made.passive.rightCols<1>() = chain::spatial_column(moving, g);
      }
      chain::move_joint(moving, displacements.front(), g);
      displacements = displacements.subspan(1);
    }
    if (j + 1 < limb.joints.size()) made.parts.push_back(g);
    g = g * limb.home[j + 1];
  }
  made.parts.push_back(g);
  return made;
}

/// The geometry of all limbs for these displacements of the joints that move.
std::vector<PlacedLimb> placed(const Mechanism& unit, std::span<const double> displacements) {
  std::vector<std::span<const double>> of_limb;
  for (const Limb& limb : unit.limbs) {
    of_limb.push_back(displacements.first(limb.moving()));
    displacements = displacements.subspan(limb.moving());
  }
  std::vector<Transform> bodies(unit.bodies.size());
  std::vector<PlacedLimb> list(unit.limbs.size());
  const auto place = [&](std::size_t i) { list[i] = placed(unit.limbs[i], of_limb[i], bodies[unit.limbs[i].from]); };
  for (const std::size_t i : placing_limbs(unit)) {
    place(i);
    bodies[unit.limbs[i].to] = list[i].parts.back();
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].parts.empty()) place(i);
  }
  return list;
}

/// For each limb, the matrix from a twist of the limb's end to its first-order effects while the drives are held. The
/// effects are motions of bodies, and the mismatch of the limbs that remains.
std::vector<Matrix> effects_of_ends(const Mechanism& unit, const std::vector<PlacedLimb>& limbs) {
  const auto rows = 6 * static_cast<Index>(limbs.size());
  Index passive = 0;
  for (const PlacedLimb& limb : limbs) passive += limb.passive.cols();
  const auto moved = 6 * static_cast<Index>(unit.bodies.size() - 1);
  const auto body = [&](std::size_t b) { return passive + 6 * static_cast<Index>(b - 1); };
  Matrix loops = Matrix::Zero(rows, passive + moved);
  Index column = 0;
  for (std::size_t i = 0; i < limbs.size(); ++i) {
    const auto row = 6 * static_cast<Index>(i);
    loops.block(row, column, 6, limbs[i].passive.cols()) = limbs[i].passive;
    column += limbs[i].passive.cols();
    loops.block<6, 6>(row, body(unit.limbs[i].to)) -= lie::Matrix6<double>::Identity();
    if (unit.limbs[i].from != kBase) {
      loops.block<6, 6>(row, body(unit.limbs[i].from)) += lie::Matrix6<double>::Identity();
    }
  }
  const linalg::SingularValueDecomposition svd = linalg::singular_value_decomposition(loops);
  const Index rank = (svd.values.array() > unit.precision.rank_threshold * svd.values[0]).count();
  const Matrix range = svd.U.leftCols(rank);
  const Matrix by_end =
      svd.V.bottomRows(moved).leftCols(rank) * svd.values.head(rank).cwiseInverse().asDiagonal() * range.transpose();
  const Matrix gaps = Matrix::Identity(rows, rows) - range * range.transpose();
  std::vector<Matrix> effects;
  for (Index row = 0; row < rows; row += 6) {
    Matrix& effect = effects.emplace_back(moved + rows, 6);
    effect << by_end.middleCols<6>(row), gaps.middleCols<6>(row);
  }
  return effects;
}

/// For each limb and each of its parts (one for each frame), an upper triangular matrix R. |R e| is the norm of all
/// effects of an error e = [omega; v] of the part, at all poses together.
using PartEffects = std::vector<std::vector<Matrix>>;

void add_pose(const Mechanism& unit, std::span<const double> displacements, PartEffects& effects) {
  const std::vector<PlacedLimb> limbs = placed(unit, displacements);
  const std::vector<Matrix> of_ends = effects_of_ends(unit, limbs);
  for (std::size_t i = 0; i < limbs.size(); ++i) {
    effects[i].resize(limbs[i].parts.size(), Matrix::Zero(6, 6));
    for (std::size_t k = 0; k < limbs[i].parts.size(); ++k) {
      Matrix all(6 + of_ends[i].rows(), 6);
      all << effects[i][k], of_ends[i] * lie::adjoint(limbs[i].parts[k]);
      effects[i][k] = linalg::upper_triangle(all);
    }
  }
}

PartEffects part_effects(const Mechanism& mechanism) {
  const Mechanism unit = in_reaches(mechanism);
  PartEffects effects(unit.limbs.size());
  add_pose(unit, std::vector<double>(unit.moving(), 0.0), effects);
  for (const PoseMobility& pose : workspace_mobility(mechanism)) {
    if (!pose.reached()) continue;
    add_pose(unit, scaled_displacements(mechanism, pose.tracked.displacements, 1.0 / mechanism.reach), effects);
  }
  return effects;
}

/// An effect of an error of length 1 counts as zero if its norm is at most this.
double largest_rounding(const Mechanism& mechanism, const PartEffects& effects) {
  double largest = 0.0;
  for (const std::vector<Matrix>& limb : effects) {
    for (const Matrix& part : limb) largest = std::max(largest, part.norm());
  }
  return mechanism.precision.rank_threshold * largest;
}

/// For each error, false if it is an error of a feature and no zone limits it; else true.
std::vector<bool> stated_errors(const Mechanism& mechanism) {
  std::vector<bool> is_stated(mechanism.factors.size(), true);
  const auto remove = [&](const std::vector<FactorIndex>& errors) {
    for (const FactorIndex error : errors) is_stated[error.value] = false;
  };
  for (const Feature& feature : mechanism.features) {
    if (!feature.location) remove(feature.middle);
    if (!feature.location && !feature.orientation) remove(feature.tilt);
  }
  return is_stated;
}

/// The twist that an error adds to the error of a part (limb, frame), with lengths in units of the reach.
lie::Screw<double> part_of_error(const Mechanism& mechanism, std::size_t error, std::size_t limb, std::size_t frame) {
  lie::Screw<double> column = lie::Screw<double>::Zero();
  for (const chain::ErrorTerm& term : mechanism.terms[error]) {
    if (term.limb != limb || term.frame != frame) continue;
    column[static_cast<Index>(term.component)] += term.scale / (term.component < 3 ? 1.0 : mechanism.reach);
  }
  return column;
}

/// The errors of a part for which stated_errors() is true, as columns of length 1 with lengths in units of the reach.
Matrix stated_columns(const Mechanism& mechanism, const std::vector<bool>& is_stated, std::size_t limb,
                      std::size_t frame) {
  Matrix columns(6, 0);
  for (std::size_t f = 0; f < mechanism.terms.size(); ++f) {
    if (!is_stated[f]) continue;
    const lie::Screw<double> column = part_of_error(mechanism, f, limb, frame);
    if (!(column.norm() > 0.0)) continue;
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
    columns.rightCols<1>() = column.normalized();
  }
  return columns;
}

/// The errors that cover directions of a part (a frame of a limb), as columns like those of stated_columns(). They are
/// the errors of the part and, if a prismatic joint adjoins the part, those errors beyond it that displace along its
/// axis, because the offsets along the axis on both sides of the joint add up to one length. home: the limb at home.
Matrix covering_columns(const Mechanism& mechanism, const std::vector<bool>& is_stated, const PlacedLimb& home,
                        std::size_t limb, std::size_t frame) {
  const std::vector<Joint>& joints = mechanism.limbs[limb].joints;
  Matrix all = stated_columns(mechanism, is_stated, limb, frame);
  const auto add_across = [&](std::size_t joint, std::size_t other) {
    if (joint >= joints.size() || joints[joint].motion != Motion::prismatic) return;
    const Vector3 slide = home.parts[frame].R.transpose() * joints[joint].at_home.R.col(2);
    const lie::Matrix3<double> to_frame = home.parts[frame].R.transpose() * home.parts[other].R;
    const Matrix columns = stated_columns(mechanism, is_stated, limb, other);
    for (Index c = 0; c < columns.cols(); ++c) {
      const Vector3 displacement = to_frame * columns.col(c).tail<3>();
      if (columns.col(c).head<3>().norm() > 0.0 || slide.cross(displacement).norm() > kDependent) continue;
      all.conservativeResize(Eigen::NoChange, all.cols() + 1);
      all.rightCols<1>() << Vector3::Zero(), displacement;
    }
  };
  add_across(frame, frame + 1);
  if (frame > 0) add_across(frame - 1, frame - 1);
  return all;
}

/// Directions in the axes of a part, as orthonormal columns.
struct Directions {
  Matrix displacements;  ///< directions of displacement
  Matrix turns;          ///< axes of rotation, whatever displacement accompanies the rotation
};

/// The directions of displacement and rotation that these twists of a part (columns) do not span. The result does not
/// depend on the point about which the twists rotate.
Directions not_spanned(const Matrix& columns) {
  const Matrix spanned = complement(complement(columns));
  const Matrix turns = spanned.topRows(3);
  return {complement(spanned.bottomRows(3) * null_space(turns)), complement(turns)};
}

/// A list of words as text: "x, y and z".
std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (k > 0) text += k + 1 == words.size() ? " and " : ", ";
    text += words[k];
  }
  return text;
}

/// Orthonormal directions as text: "x and y", "(0.6, 0.8, 0)", "all that is perpendicular to (0.6, 0.8, 0)".
std::string direction_words(const Matrix& directions) {
  std::vector<std::string> words;
  Matrix oblique = directions * directions.transpose();
  for (Index axis = 0; axis < 3; ++axis) {
    if (std::abs(oblique(axis, axis) - 1.0) > kDependent) continue;
    words.emplace_back(1, "xyz"[axis]);
    oblique(axis, axis) = 0.0;
  }
  const Index left = directions.cols() - static_cast<Index>(words.size());
  const auto vector_words = [](Vector3 vector) {
    Index largest = 0;
    vector.cwiseAbs().maxCoeff(&largest);
    return triple_text(vector[largest] < 0.0 ? Vector3(-vector) : vector);
  };
  if (left == 1) {
    Index most = 0;
    oblique.colwise().norm().maxCoeff(&most);
    words.push_back(vector_words(oblique.col(most).normalized()));
  }
  if (left == 2) words.push_back("all that is perpendicular to " + vector_words(complement(directions).col(0)));
  return listed(words);
}

/// A clause for directions without a tolerance: "displacement along x and turn about z have no tolerance"; empty if
/// there are none.
std::string clause(const Directions& left) {
  std::vector<std::string> words;
  if (left.displacements.cols() > 0) words.push_back("displacement along " + direction_words(left.displacements));
  if (left.turns.cols() > 0) words.push_back("turn about " + direction_words(left.turns));
  if (words.empty()) return {};
  return fmt::format("{} {} no tolerance", fmt::join(words, " and "), words.size() == 1 ? "has" : "have");
}

std::string body_words(const Mechanism& mechanism, std::size_t body) {
  if (body == kBase) return "the base";
  return body == kPlatform ? "the platform" : "body '" + mechanism.bodies[body].name + "'";
}

/// The name of the part to which a frame's errors belong; empty between the axes of a spherical or cylindrical joint,
/// where there is no part.
std::string part_words(const Mechanism& mechanism, const Limb& limb, std::size_t frame) {
  const std::size_t joints = limb.joints.size();
  if (frame > 0 && frame < joints && limb.joints[frame - 1].name == limb.joints[frame].name) {
    return limb.joints[frame].kind == JointKind::universal ? "the cross of " + limb.joints[frame].name : "";
  }
  return fmt::format("between {} and {}", frame == 0 ? body_words(mechanism, limb.from) : limb.joints[frame - 1].name,
                     frame == joints ? body_words(mechanism, limb.to) : limb.joints[frame].name);
}

/// Limbs as text: "limb 1", "limbs 1 and 3", "limbs 1 to 3".
std::string limbs_words(const Mechanism& mechanism, const std::vector<std::size_t>& limbs) {
  std::vector<std::string> labels;
  for (const std::size_t limb : limbs) labels.push_back(mechanism.limbs[limb].label);
  if (labels.size() == 1) return fmt::format("limb {}", labels.front());
  const bool is_range = labels.size() > 2 && limbs.back() - limbs.front() + 1 == limbs.size();
  if (is_range) return fmt::format("limbs {} to {}", labels.front(), labels.back());
  return "limbs " + listed(labels);
}

/// A clause, and what it is about: the indices of limbs, or the names of errors.
template <class Subject>
struct Said {
  std::string words;
  std::vector<Subject> of;
};

template <class Subject>
void say(std::vector<Said<Subject>>& list, std::string words, Subject subject) {
  const auto known = std::ranges::find(list, words, &Said<Subject>::words);
  if (known == list.end()) {
    list.push_back({std::move(words), {std::move(subject)}});
  } else {
    known->of.push_back(std::move(subject));
  }
}

void add_new(std::vector<std::string>& list, std::string text) {
  if (std::ranges::find(list, text) == list.end()) list.push_back(std::move(text));
}

std::string length_text(double metres) { return readable_text({metres, Dimension::length}, 4); }

}  // namespace

std::vector<std::string> uncovered_directions(const Mechanism& mechanism) {
  if (mechanism.features.empty()) return {};
  const PartEffects effects = part_effects(mechanism);
  const double nothing = largest_rounding(mechanism, effects);
  const std::vector<bool> is_stated = stated_errors(mechanism);
  const Mechanism unit = in_reaches(mechanism);
  const std::vector<PlacedLimb> home = placed(unit, std::vector<double>(unit.moving(), 0.0));
  std::vector<Said<std::size_t>> said;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    for (std::size_t k = 0; k < effects[i].size(); ++k) {
      const std::string part = part_words(mechanism, mechanism.limbs[i], k);
      if (part.empty()) continue;
      const Matrix without_effect = null_space(effects[i][k], nothing);
      const Matrix stated = covering_columns(mechanism, is_stated, home[i], i, k);
      Matrix covered(6, without_effect.cols() + stated.cols());
      covered << without_effect, stated;
      const std::string words = clause(not_spanned(covered));
      if (!words.empty()) say(said, fmt::format("{} (frame {}): {}", part, k, words), i);
    }
  }
  std::vector<std::string> list;
  for (const auto& [words, limbs] : said) list.push_back(limbs_words(mechanism, limbs) + ", " + words);
  return list;
}

namespace {

/// Returns true if an error has no effect to first order, and the parts on which it acts have no other error.
bool is_alone_without_effect(const Mechanism& mechanism, const PartEffects& effects, double nothing,
                             std::size_t error) {
  return std::ranges::all_of(mechanism.terms[error], [&](const chain::ErrorTerm& term) {
    const lie::Screw<double> column = part_of_error(mechanism, error, term.limb, term.frame);
    if ((effects[term.limb][term.frame] * column).norm() > nothing * column.norm()) return false;
    for (std::size_t f = 0; f < mechanism.terms.size(); ++f) {
      if (f != error && part_of_error(mechanism, f, term.limb, term.frame).norm() > 0.0) return false;
    }
    return true;
  });
}

}  // namespace

std::vector<std::string> errors_without_effect(const Mechanism& mechanism) {
  if (mechanism.first_named == mechanism.factors.size()) return {};
  const PartEffects effects = part_effects(mechanism);
  const double nothing = largest_rounding(mechanism, effects);
  std::vector<std::string> names;
  for (std::size_t f = mechanism.first_named; f < mechanism.factors.size(); ++f) {
    if (is_alone_without_effect(mechanism, effects, nothing, f)) names.push_back(mechanism.factors[f].name);
  }
  if (names.empty()) return {};
  return {fmt::format("{} {} no effect to first order, and {} no other error", listed(names),
                      names.size() == 1 ? "has" : "have", names.size() == 1 ? "its part has" : "their parts have")};
}

namespace {

/// The only direction in which displacements of a part have an effect; none if there are several, or none at all.
std::optional<Vector3> only_direction(const Matrix& effect, double nothing) {
  const Matrix without_effect = null_space(effect.rightCols<3>(), nothing);
  if (without_effect.cols() != 2) return std::nullopt;
  return complement(without_effect).col(0);
}

/// [errors] Whether an error is that of a feature of kind `distance`.
std::vector<bool> errors_of_distances(const Mechanism& mechanism) {
  std::vector<bool> found(mechanism.factors.size(), false);
  for (const Feature& feature : mechanism.features) {
    if (feature.kind != FeatureKind::distance) continue;
    for (const FactorIndex error : feature.errors()) found[error.value] = true;
  }
  return found;
}

/// The rest of the clause "rod_1 displaces ...", if the error displaces its part without rotating it, and obliquely to
/// the only direction that has an effect. Empty for any other error, and if errors of the part together reach this
/// direction: all of its errors or, for the error of a distance, those of its distances. distances:
/// errors_of_distances().
std::string oblique_displacement(const Mechanism& mechanism, const PartEffects& effects, double nothing,
                                 const std::vector<bool>& distances, std::size_t error) {
  constexpr double kAlong = 0.9998;   // cosine of a degree
  constexpr double kAcross = 0.0175;  // sine of a degree; errors_without_effect() asks about such errors
  const chain::ErrorTerm& first = mechanism.terms[error].front();
  const lie::Screw<double> column = part_of_error(mechanism, error, first.limb, first.frame);
  const std::optional<Vector3> only = only_direction(effects[first.limb][first.frame], nothing);
  if (!only || column.head<3>().norm() > 0.0 || !(column.norm() > 0.0)) return {};
  const double cosine = std::abs(only->dot(column.tail<3>().normalized()));
  if (cosine > kAlong || cosine < kAcross) return {};
  const std::vector<bool> all(distances.size(), true);
  const Matrix columns = stated_columns(mechanism, distances[error] ? distances : all, first.limb, first.frame);
  const Matrix spanned = complement(complement(Matrix(columns.bottomRows<3>())));
  if ((spanned.transpose() * *only).norm() > 1.0 - kDependent) return {};
  return fmt::format(
      "{:.0f} deg off {}, the only direction of frame {} in which a displacement {} has an effect to first order ({})",
      std::acos(cosine) * 180.0 / std::numbers::pi, direction_words(*only), first.frame,
      part_words(mechanism, mechanism.limbs[first.limb], first.frame),
      distances[error] ? "the direction of a rod leads from one of its joints to the other"
                       : "a feature of kind distance states the length of a rod");
}

}  // namespace

std::vector<std::string> oblique_displacements(const Mechanism& mechanism) {
  const std::vector<bool> distances = errors_of_distances(mechanism);
  const bool has_none = std::ranges::none_of(distances, std::identity());
  if (has_none && mechanism.first_named == mechanism.factors.size()) return {};
  const PartEffects effects = part_effects(mechanism);
  const double nothing = largest_rounding(mechanism, effects);
  std::vector<Said<std::string>> said;
  for (std::size_t f = 0; f < mechanism.factors.size(); ++f) {
    if (f < mechanism.first_named && !distances[f]) continue;
    std::string words = oblique_displacement(mechanism, effects, nothing, distances, f);
    if (!words.empty()) say(said, std::move(words), mechanism.factors[f].name);
  }
  std::vector<std::string> list;
  for (const auto& [words, names] : said) {
    list.push_back(fmt::format("{} {} {}", listed(names), names.size() == 1 ? "displaces" : "displace", words));
  }
  return list;
}

namespace {

/// The distance (m) at home between the two joints or bodies that a feature's part connects, along the feature's x
/// axis.
double length_along(const Mechanism& mechanism, std::size_t feature) {
  const Limb& limb = mechanism.limbs[mechanism.features[feature].limb - 1];
  const std::size_t frame = mechanism.features[feature].frame;
  const Transform& link = limb.home[frame];
  const bool is_of_end = frame == limb.joints.size();  // the axes are then those of the body at the end of the limb
  const Vector3 between = is_of_end ? Vector3(link.R.transpose() * link.p) : link.p;
  return std::abs(mechanism.feature_places[feature].R.col(0).dot(between));
}

/// A clause about a nominal size that is far from the distance in the geometry; empty if it is near, or if the part has
/// no extent in this direction.
std::string doubtful_size(const Mechanism& mechanism, std::size_t f) {
  constexpr double kFar = 2.0;
  constexpr double kNoExtent = 1e-3;  // as a share of the reach
  const Feature& feature = mechanism.features[f];
  if (feature.kind != FeatureKind::distance || feature.size[0] == 0.0) return {};
  const double length = length_along(mechanism, f);
  const double ratio = feature.size[0] / length;
  if (length < kNoExtent * mechanism.reach || (1.0 / kFar <= ratio && ratio <= kFar)) return {};
  return fmt::format("{} has nominal_size = {}, but its part is {} long in this direction", feature.label,
                     length_text(feature.size[0]), length_text(length));
}

/// The longest distance (m) at home between two joints of a limb that follow each other, or between its first or last
/// joint and the body there.
double longest_link(const Limb& limb) {
  double longest = 0.0;
  for (const Transform& link : limb.home) longest = std::max(longest, link.p.norm());
  return longest;
}

/// Returns true if a feature's axis is along a slide of its part: a rail, or the bore of a carriage that slides on one.
bool is_along_slide(const Mechanism& mechanism, std::size_t f) {
  constexpr double kAlong = 0.9;  // cosine of the largest angle between the two axes
  const Feature& feature = mechanism.features[f];
  const Limb& limb = mechanism.limbs[feature.limb - 1];
  const std::size_t frame = feature.frame;
  const bool is_of_end = frame == limb.joints.size();  // the axes are then those of the body at the end of the limb
  const auto is_along = [&](const Vector3& slide) {
    return std::abs(mechanism.feature_places[f].R.col(2).dot(slide)) > kAlong;
  };
  const Vector3 own = is_of_end ? Vector3(limb.home[frame].R.transpose().col(2)) : Vector3::UnitZ();
  if (frame > 0 && limb.joints[frame - 1].motion == Motion::prismatic && is_along(own)) return true;
  return !is_of_end && limb.joints[frame].motion == Motion::prismatic && is_along(limb.home[frame].R.col(2));
}

/// A clause about an axis that is too long or too short for its part. A pin or a bore is at most as long as the longest
/// link of its limb, or a fifth of the reach; a rail is neither much longer nor much shorter than the mechanism.
std::string doubtful_length(const Mechanism& mechanism, std::size_t f) {
  constexpr double kLongPin = 0.2;     // in units of the reach
  constexpr double kLongRail = 3.0;    // in units of the reach
  constexpr double kShortRail = 0.01;  // in units of the reach
  const Feature& feature = mechanism.features[f];
  if (feature.kind != FeatureKind::axis) return {};
  const double length = feature.size[0];
  const bool is_rail = is_along_slide(mechanism, f);
  const std::string reach = "a mechanism with a reach of " + length_text(mechanism.reach);
  const double link = longest_link(mechanism.limbs[feature.limb - 1]);
  if (!is_rail && length > std::max(link, kLongPin * mechanism.reach)) {
    return fmt::format("{} is {} long, in {} whose limb has links of at most {}", feature.label, length_text(length),
                       reach, length_text(link));
  }
  if (!is_rail || (kShortRail * mechanism.reach <= length && length <= kLongRail * mechanism.reach)) return {};
  return fmt::format("{} is along a slide and {} long, in {}", feature.label, length_text(length), reach);
}

/// A clause about a zone that is large for the mechanism.
std::string doubtful_width(const Mechanism& mechanism, const Feature& feature, const Zone& zone) {
  constexpr double kWide = 0.02;  // in units of the reach
  if (zone.size <= kWide * mechanism.reach) return {};
  return fmt::format("{} of {} is {} for a mechanism with a reach of {}", zone.key, feature.label,
                     length_text(zone.size), length_text(mechanism.reach));
}

}  // namespace

std::vector<std::string> doubtful_zones(const Mechanism& mechanism) {
  std::vector<std::string> list;
  for (std::size_t f = 0; f < mechanism.features.size(); ++f) {
    const Feature& feature = mechanism.features[f];
    if (std::string size = doubtful_size(mechanism, f); !size.empty()) add_new(list, std::move(size));
    if (std::string length = doubtful_length(mechanism, f); !length.empty()) add_new(list, std::move(length));
    for (const std::optional<Zone>& zone : {feature.location, feature.orientation}) {
      std::string width = zone ? doubtful_width(mechanism, feature, *zone) : std::string();
      if (!width.empty()) add_new(list, std::move(width));
      const bool needs_datums = zone && zone->key != "tolerance" && zone->key != "flatness";
      if (needs_datums && zone->datums.empty()) {
        add_new(list, fmt::format("{} of {} has no datums", zone->key, feature.label));
      }
    }
    if (!feature.location || !feature.orientation) continue;
    const double widest = drawing::widest_orientation(feature.kind) * feature.location->size;
    if (feature.orientation->size < widest) continue;
    add_new(list, fmt::format("{} of {} is {}, and its {} allows no more than {} anyway", feature.orientation->key,
                              feature.label, length_text(feature.orientation->size), feature.location->key,
                              length_text(widest)));
  }
  return list;
}

std::vector<std::string> doubtful_clearances(const Mechanism& mechanism) {
  const auto found =
      std::ranges::find_if(mechanism.features, [](const Feature& one) { return one.clearance.has_value(); });
  if (found == mechanism.features.end() || home_mobility(mechanism).over_constraints == 0) return {};
  return {
      fmt::format("the limbs are over-constrained, and {} is drawn like other errors, so it adds to the gap between "
                  "them; in a machine the play of a joint takes a gap up",
                  found->label)};
}

}  // namespace poesy::file
