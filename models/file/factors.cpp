#include "models/file/factors.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "engine/base/name_pattern.h"
#include "engine/base/text.h"
#include "models/file/features.h"

namespace poesy::file {
namespace {

char axis_of(std::size_t component) { return "xyz"[component % 3]; }

/// An elementary joint as text for descriptions: "joint S (2 of 3)".
std::string joint_text(const std::vector<Joint>& joints, std::size_t j) {
  std::size_t before = 0, all = 0;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (joints[k].name != joints[j].name) continue;
    ++all;
    if (k < j) ++before;
  }
  const std::string part = all == 1 ? "" : " (" + std::to_string(before + 1) + " of " + std::to_string(all) + ")";
  return "joint " + joints[j].name + part;
}

/// The names of the two parts that a fixed frame of a limb connects.
struct Parts {
  std::string behind;  ///< part behind the frame: "joint A"
  std::string before;  ///< part before the frame: "base"

  std::string text() const { return behind + " against " + before; }
};

Parts parts_of(const Mechanism& mechanism, const Limb& limb, std::size_t frame) {
  return {frame == limb.joints.size() ? mechanism.bodies[limb.to].name : joint_text(limb.joints, frame),
          frame == 0 ? mechanism.bodies[limb.from].name : joint_text(limb.joints, frame - 1)};
}

std::string description(const Mechanism& mechanism, const chain::ErrorTerm& term) {
  const Limb& limb = mechanism.limbs[term.limb];
  const std::size_t last = limb.joints.size();
  const Parts parts = parts_of(mechanism, limb, term.frame);
  const auto the = [&](std::size_t body) {
    return (body <= kPlatform ? "the " : "body ") + mechanism.bodies[body].name;
  };
  const std::string axes = term.frame == 0      ? the(limb.from)
                           : term.frame == last ? the(limb.to)
                                                : "frame " + std::to_string(term.frame);
  const std::string kind = term.component < 3 ? "angular error about " : "linear error along ";
  std::string text = "limb " + limb.label + ", " + parts.text() + ": " + kind + axis_of(term.component) + " of " + axes;
  const bool at_joint = mechanism.about == ErrorsAbout::joint && (term.frame == 0 || term.frame == last);
  if (term.component < 3 && at_joint) text += " at " + (term.frame == 0 ? parts.behind : parts.before);
  return text;
}

/// The factor for an error of one component of a fixed frame. axis: name of the component's axis; empty for a scalar.
Factor factor(const Mechanism& mechanism, const chain::ErrorTerm& term, std::string name, std::string axis) {
  return {std::move(name),
          term.component < 3 ? Dimension::angle : Dimension::length,
          term.limb + 1,
          term.frame,
          description(mechanism, term),
          std::move(axis)};
}

/// The terms of an error of a frame. Most errors have the given term alone. An angular error epsilon of a limb's first
/// or last frame may have to rotate about the point c of the joint there, while the solver rotates it about the origin
/// of the body. It then has the terms [epsilon; c x epsilon].
chain::ErrorTerms about_joint(const Mechanism& mechanism, const chain::ErrorTerm& term) {
  chain::ErrorTerms list{term};
  const Limb& limb = mechanism.limbs[term.limb];
  const bool is_first = term.frame == 0;
  const bool is_at_end = is_first || term.frame == limb.joints.size();
  const bool is_as_solved = mechanism.errors_at_joints || mechanism.about == ErrorsAbout::frame;
  if (is_as_solved || !is_at_end || term.component >= 3) return list;
  const Transform& body = mechanism.bodies[is_first ? limb.from : limb.to].home;
  const Joint& joint = is_first ? limb.joints.front() : limb.joints.back();
  const Vector3 at = body.R.transpose() * (joint.at_home.p - body.p);
  const Vector3 shift = at.cross(Vector3::Unit(static_cast<Eigen::Index>(term.component)));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double entry = term.scale * shift[static_cast<Eigen::Index>(axis)];
    if (entry != 0.0) list.push_back({term.limb, term.frame, 3 + axis, entry});
  }
  return list;
}

/// The errors of all components of all fixed frames of a mechanism.
struct FrameErrors {
  std::vector<Factor> factors;
  std::vector<chain::ErrorTerms> terms;
};

FrameErrors frame_errors(const Mechanism& mechanism) {
  FrameErrors all;
  for (std::size_t i = 0; i < mechanism.limbs.size(); ++i) {
    for (std::size_t j = 0; j < mechanism.limbs[i].home.size(); ++j) {
      for (std::size_t component = 0; component < 6; ++component) {
        const std::string axis(1, axis_of(component));
        const std::string name =
            (component < 3 ? "epsilon_" : "delta_") + std::to_string(i + 1) + "_" + std::to_string(j) + "_" + axis;
        const chain::ErrorTerm term{i, j, component};
        all.terms.push_back(about_joint(mechanism, term));
        all.factors.push_back(factor(mechanism, term, name, axis));
      }
    }
  }
  return all;
}

/// The indices of the factors whose names match a pattern, ascending. Throws if there are none.
std::vector<std::size_t> fitting(const Reference& pattern, const std::vector<Factor>& factors) {
  std::vector<std::size_t> found;
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (matches(pattern.name, factors[f].name)) found.push_back(f);
  }
  if (!found.empty()) return found;
  const std::vector<std::string_view> known = names(factors);
  const std::string_view near = nearest(pattern.name, known);
  const std::string example = known.empty() ? "there are none" : "they have names like " + std::string(known.front());
  throw InputError(pattern.place, pattern.key + " '" + printable(pattern.name) + "' fits no error",
                   near.empty() ? example : "did you mean '" + std::string(near) + "'?");
}

void add_listed(const std::vector<Reference>& patterns, const FrameErrors& all, Mechanism& mechanism) {
  std::vector<bool> taken(all.factors.size(), false);
  for (const Reference& pattern : patterns) {
    for (const std::size_t f : fitting(pattern, all.factors)) {
      if (taken[f]) {
        throw InputError(pattern.place,
                         pattern.key + " '" + pattern.name + "' names " + all.factors[f].name + " a second time",
                         "remove it, or write a narrower pattern");
      }
      taken[f] = true;
      mechanism.factors.push_back(all.factors[f]);
      mechanism.terms.push_back(all.terms[f]);
    }
  }
}

std::string number_suffix(const SlotLines& slot, std::size_t k) {
  return slot.numbers[k] == 0 ? "" : "_" + std::to_string(slot.numbers[k]);
}

/// Whether and how an error of a limb grows with the displacement of a joint.
struct Growth {
  /// Displacement to which the error is proportional; none if the error is the same at all poses.
  std::optional<chain::JointWay> way = {};
  /// Power of m in the unit of the displacement: 1 if the joint slides, 0 if it rotates.
  int length = 0;
  std::string text = {};  ///< text for descriptions: ", grows with q, from home"

  /// Makes these terms proportional to the displacement.
  void apply(chain::ErrorTerms& terms) const {
    for (chain::ErrorTerm& term : terms) term.along = way;
  }
};

/// Throws unless the joint of the limb has exactly one displacement. j: index of its first elementary joint.
void check_has_displacement(const Reference& name, const Limb& limb, std::size_t j) {
  const Joint& joint = limb.joints[j];
  const auto fail = [&](const std::string& problem, const std::string& remedy) {
    throw InputError(name.place, name.key + " is '" + name.name + "', " + problem, remedy);
  };
  if (!joint.moves()) {
    fail("a fixed frame of limb " + limb.label + ", which has no displacement", "name a joint that moves");
  }
  if (std::ranges::count(limb.joints, joint.name, &Joint::name) == 1) return;
  fail("a joint of type " + std::string(poesy::file::name(joint.kind)) + ", which has several displacements",
       "write its axes as joints of types R and P, and name the one that is meant");
}

Growth growth(const ErrorLines& error, std::size_t i, const Numbers& numbers, const Mechanism& mechanism) {
  if (!error.grows_with) return {};
  const Reference& name = *error.grows_with;
  const Limb& limb = mechanism.limbs[i];
  const auto joint = std::ranges::find(limb.joints, name.name, &Joint::name);
  if (joint == limb.joints.end()) {
    throw InputError(
        name.place, name.key + " is '" + printable(name.name) + "', which no joint of limb " + limb.label + " is named",
        suggestion(name.name, names(limb.joints)));
  }
  auto at = static_cast<std::size_t>(joint - limb.joints.begin());
  check_has_displacement(name, limb, at);
  const bool slides = joint->kind == JointKind::prismatic;
  const double from = error.from ? numbers.quantity(*error.from, slides ? kLength : kAngle) : 0.0;
  const std::string start =
      from == 0.0 ? "home" : readable_text({from, slides ? Dimension::length : Dimension::angle}, 6);
  for (std::size_t before = 0; before < i; ++before) at += mechanism.limbs[before].joints.size();
  return {chain::JointWay{at, from}, slides ? 1 : 0, ", grows with " + name.name + ", from " + start};
}

/// The scale of a component of an error. It is a number, but if the error grows with a displacement, it has the
/// dimension of the component divided by that of the displacement.
double scale_of(const Expression& scale, std::size_t component, const Growth& growth, const Numbers& numbers) {
  const int wanted = growth.way ? (component < 3 ? 0 : 1) - growth.length : 0;
  const Value value = numbers.value(scale);
  if (value.si == 0.0) {
    throw InputError(scale.place, scale.key + " is zero, so the error has no effect", "write its scale");
  }
  if (wanted == 0) return numbers.quantity(scale, kNumber);
  if (value.powers.like({.length = wanted})) return value.si;
  const bool turns = component < 3;
  throw InputError(scale.place,
                   scale.key + " is " + dimension_text(value) + ", but the error makes " +
                       (turns ? "an angle, and grows with a length" : "a length, and grows with an angle"),
                   std::string("write scale = ") +
                       (turns ? "\"1 / (1 m)\", and the error is in rad/m" : "\"1 m\", and the error is in m/rad"));
}

/// Adds an error for each limb and each component of a named vector.
void add_vector(const ErrorLines& error, const Numbers& numbers, Mechanism& mechanism) {
  const bool vector = error.components.size() > 1;
  const SlotLines& slot = error.slot;
  for (std::size_t k = 0; k < slot.limbs.size(); ++k) {
    const Growth growing = growth(error, slot.limbs[k], numbers, mechanism);
    for (const std::size_t component : error.components) {
      const double scale = scale_of(error.scale, component, growing, numbers);
      const std::string axis = vector ? std::string(1, axis_of(component)) : "";
      const std::string name = error.name.name + (vector ? "_" + axis : "") + number_suffix(slot, k);
      const chain::ErrorTerm term{slot.limbs[k], slot.frames[k], component, scale};
      Factor made = factor(mechanism, term, name, axis);
      if (!error.description.empty()) made.place = std::exchange(made.description, error.description);
      made.description += growing.text;
      if (growing.way) made.dimension = Dimension::number;
      chain::ErrorTerms terms = about_joint(mechanism, term);
      growing.apply(terms);
      add_error(std::move(made), std::move(terms), error.name, mechanism);
    }
  }
}

/// The terms of one error, and its dimension.
struct Combination {
  chain::ErrorTerms terms;
  /// Power of m in the unit of the error: 1 for a length, 0 for an angle; none while it is not known.
  std::optional<int> length;
  std::string growth = {};  ///< text that says how the error grows; empty if it does not grow
};

std::string measure_text(int length) { return length == 1 ? "a length" : "an angle"; }

/// Adds to `made` the components of an error in one frame. Each component has a share: its change per unit of the
/// error. If the error is a length, shares of delta are numbers and shares of epsilon are 1/length. An error that grows
/// is a number; its shares are also per unit of the displacement to which it is proportional.
void add_components(const std::vector<ComponentLines>& components, std::size_t limb, std::size_t frame,
                    const Growth& growing, const Numbers& numbers, const Mechanism& mechanism, Combination& made) {
  made.growth = growing.text;
  for (const ComponentLines& one : components) {
    const Value share = numbers.value(one.scale);
    if (share.any) continue;
    const int length = (one.component < 3 ? 0 : 1) - share.powers.length - growing.length;
    const auto fail = [&](const std::string& problem) {
      throw InputError(one.scale.place, one.scale.key + " '" + one.scale.text + "' " + problem,
                       "for an error that is a length write numbers for delta and 1/length for epsilon, for an angle "
                       "lengths for delta and numbers for epsilon");
    };
    const bool is_product = share.powers.like({.length = share.powers.length});
    if (growing.way && (!is_product || length != 0)) {
      throw InputError(one.scale.place,
                       one.scale.key + " '" + one.scale.text + "' is " + dimension_text(share) +
                           ", so the error, which grows, is not a number",
                       growing.length == 1 ? "where it grows with a length write numbers for delta and 1/length for "
                                             "epsilon"
                                           : "where it grows with an angle write lengths for delta and numbers for "
                                             "epsilon");
    }
    if (!is_product || (length != 0 && length != 1)) {
      fail("is " + dimension_text(share) + ", so the error is neither a length nor an angle");
    }
    if (made.length && *made.length != length) {
      fail("makes the error " + measure_text(length) + ", and what is before it " + measure_text(*made.length));
    }
    made.length = length;
    if (share.si == 0.0) continue;
    chain::ErrorTerms terms = about_joint(mechanism, {limb, frame, one.component, share.si});
    growing.apply(terms);
    made.terms.insert(made.terms.end(), terms.begin(), terms.end());
  }
}

void add_combination(const ErrorLines& error, const Combination& made, const std::string& name, std::string description,
                     Mechanism& mechanism) {
  if (made.terms.empty()) {
    throw InputError(error.name.place, error.name.key + " '" + error.name.name + "' changes nothing",
                     "write the share of a component");
  }
  const chain::ErrorTerm& first = made.terms.front();
  const Dimension dimension = first.along         ? Dimension::number
                              : *made.length == 1 ? Dimension::length
                                                  : Dimension::angle;
  std::string place;
  if (!error.description.empty()) place = std::exchange(description, error.description);
  add_error({.name = name,
             .dimension = dimension,
             .limb = first.limb + 1,
             .frame = first.frame,
             .description = description + made.growth,
             .place = std::move(place)},
            made.terms, error.name, mechanism);
}

std::string components_text(const std::vector<ComponentLines>& components) {
  std::string text;
  for (const ComponentLines& one : components) {
    text +=
        std::string(text.empty() ? "" : ", ") + (one.component < 3 ? "epsilon_" : "delta_") + axis_of(one.component);
  }
  return text;
}

/// Adds for each limb an error that changes several components.
void add_combinations(const ErrorLines& error, const Numbers& numbers, Mechanism& mechanism) {
  const SlotLines& slot = error.slot;
  for (std::size_t k = 0; k < slot.limbs.size(); ++k) {
    Combination made;
    add_components(error.combination, slot.limbs[k], slot.frames[k], growth(error, slot.limbs[k], numbers, mechanism),
                   numbers, mechanism, made);
    const Limb& limb = mechanism.limbs[slot.limbs[k]];
    add_combination(error, made, error.name.name + number_suffix(slot, k),
                    "limb " + limb.label + ", " + parts_of(mechanism, limb, slot.frames[k]).text() + ": " +
                        components_text(error.combination) + " together",
                    mechanism);
  }
}

/// Adds one error that acts in several places.
void add_shared(const ErrorLines& error, const Numbers& numbers, Mechanism& mechanism) {
  Combination made;
  std::string limbs;
  for (const PlaceLines& place : error.places) {
    for (std::size_t k = 0; k < place.slot.limbs.size(); ++k) {
      const std::size_t limb = place.slot.limbs[k];
      add_components(place.components, limb, place.slot.frames[k], growth(error, limb, numbers, mechanism), numbers,
                     mechanism, made);
      limbs += (limbs.empty() ? "" : ", ") + mechanism.limbs[place.slot.limbs[k]].label;
    }
  }
  add_combination(error, made, error.name.name, "one number in limbs " + limbs, mechanism);
}

void add_named(const ErrorLines& error, const Numbers& numbers, Mechanism& mechanism) {
  if (!error.places.empty()) return add_shared(error, numbers, mechanism);
  if (!error.combination.empty()) return add_combinations(error, numbers, mechanism);
  add_vector(error, numbers, mechanism);
}

/// Returns true if the elementary joints of two limbs have the same motions in the same order.
bool are_alike(const Limb& a, const Limb& b) {
  return std::ranges::equal(a.joints, b.joints, {}, &Joint::motion, &Joint::motion);
}

/// The text that names the limbs of an error with limb = "each", and the two parts that its frame connects in each of
/// them.
EachLimb each_limb(const ErrorLines& error, const Mechanism& mechanism) {
  const SlotLines& slot = error.slot;
  EachLimb each{"error " + error.name.name + " with limb = \"each\" is", true};
  for (std::size_t i = 0; i < slot.limbs.size();) {
    const auto parts_in = [&](std::size_t limb) {
      return parts_of(mechanism, mechanism.limbs[limb], slot.frames[limb]).text();
    };
    const std::string parts = parts_in(i);
    const std::size_t first = i;
    while (i < slot.limbs.size() && parts_in(i) == parts) ++i;
    each.text += std::string(first == 0 ? "" : ";") + " in limb" + (i - first == 1 ? "" : "s");
    for (std::size_t k = first; k < i; ++k) {
      each.text += (k == first ? " " : k + 1 == i ? " and " : ", ") + std::to_string(k + 1);
      each.alike = each.alike && are_alike(mechanism.limbs[k], mechanism.limbs[0]);
    }
    each.text += ", " + parts;
  }
  return each;
}

FactorSet set_of(const SetLines& lines, const std::vector<Factor>& factors) {
  std::vector<bool> in(factors.size(), false);
  for (const Reference& pattern : lines.patterns) {
    for (const std::size_t f : fitting(pattern, factors)) in[f] = true;
  }
  FactorSet set{lines.name.name, "as the mechanism's file has it", {}};
  for (std::size_t f = 0; f < in.size(); ++f) {
    if (in[f]) set.factors.emplace_back(f);
  }
  if (!set.factors.empty()) return set;
  throw InputError(lines.name.place, lines.name.key + " is empty", "name its errors, or remove it");
}

}  // namespace

void add_error(Factor factor, chain::ErrorTerms terms, const Reference& name, Mechanism& mechanism) {
  if (std::ranges::find(mechanism.factors, factor.name, &Factor::name) != mechanism.factors.end()) {
    throw InputError(name.place, name.key + " '" + name.name + "' makes a second error '" + factor.name + "'",
                     "give it a name of its own");
  }
  mechanism.factors.push_back(std::move(factor));
  mechanism.terms.push_back(std::move(terms));
}

void add_factors(const Numbers& numbers, Mechanism& mechanism) {
  const MechanismFile& file = numbers.file();
  FrameErrors all = frame_errors(mechanism);
  if (file.all_frames()) {
    mechanism.factors = std::move(all.factors);
    mechanism.terms = std::move(all.terms);
  } else if (file.frames) {
    add_listed(*file.frames, all, mechanism);
  }
  add_features(numbers, mechanism);
  mechanism.first_named = mechanism.factors.size();
  for (const ErrorLines& error : file.errors) {
    add_named(error, numbers, mechanism);
    if (error.slot.each) mechanism.each.push_back(each_limb(error, mechanism));
  }
  FactorSet every{"all", "all errors", {}};
  for (std::size_t f = 0; f < mechanism.factors.size(); ++f) every.factors.emplace_back(f);
  mechanism.sets.push_back(std::move(every));
  for (const SetLines& set : file.sets) mechanism.sets.push_back(set_of(set, mechanism.factors));
}

}  // namespace poesy::file
