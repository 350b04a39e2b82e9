#include "models/file/factors.h"

#include <algorithm>

#include "engine/base/name_pattern.h"
#include "engine/base/text.h"

namespace poesy::file {
namespace {

char axis_of(std::size_t component) { return "xyz"[component % 3]; }

/// The joint's text for descriptions: "joint S (2 of 3)".
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

/// The two parts that a fixed frame of a limb connects.
struct Parts {
  std::string behind;  ///< "joint A"
  std::string before;  ///< "base"

  std::string text() const { return behind + " against " + before; }
};

Parts parts_of(const Mechanism& mechanism, const Limb& limb, std::size_t frame) {
  return {frame == limb.joints.size() ? mechanism.bodies[limb.to].name : joint_text(limb.joints, frame),
          frame == 0 ? mechanism.bodies[limb.from].name : joint_text(limb.joints, frame - 1)};
}

std::string description(const Mechanism& mechanism, const ErrorSlot& slot) {
  const Limb& limb = mechanism.limbs[slot.limb];
  const std::size_t last = limb.joints.size();
  const Parts parts = parts_of(mechanism, limb, slot.frame);
  const auto the = [&](std::size_t body) {
    return (body <= kPlatform ? "the " : "body ") + mechanism.bodies[body].name;
  };
  const std::string axes = slot.frame == 0      ? the(limb.from)
                           : slot.frame == last ? the(limb.to)
                                                : "frame " + std::to_string(slot.frame);
  const std::string kind = slot.component < 3 ? "angular error about " : "linear error along ";
  std::string text = "limb " + limb.label + ", " + parts.text() + ": " + kind + axis_of(slot.component) + " of " + axes;
  const bool at_joint = mechanism.errors_at_joints && (slot.frame == 0 || slot.frame == last);
  if (slot.component < 3 && at_joint) text += " at " + (slot.frame == 0 ? parts.behind : parts.before);
  return text;
}

/// The error of one entry of a fixed frame. axis: empty for a scalar.
Factor factor(const Mechanism& mechanism, const ErrorSlot& slot, std::string name, std::string axis) {
  return {std::move(name),
          slot.component < 3 ? Dimension::angle : Dimension::length,
          slot.limb + 1,
          slot.frame,
          description(mechanism, slot),
          std::move(axis)};
}

/// The errors of all entries of all fixed frames.
struct FrameErrors {
  std::vector<Factor> factors;
  std::vector<ErrorSlot> slots;
};

FrameErrors frame_errors(const Mechanism& mechanism) {
  FrameErrors all;
  for (std::size_t i = 0; i < mechanism.limbs.size(); ++i) {
    for (std::size_t j = 0; j < mechanism.limbs[i].home.size(); ++j) {
      for (std::size_t component = 0; component < 6; ++component) {
        const std::string axis(1, axis_of(component));
        const std::string name =
            (component < 3 ? "epsilon_" : "delta_") + std::to_string(i + 1) + "_" + std::to_string(j) + "_" + axis;
        all.slots.push_back({i, j, component, 1.0});
        all.factors.push_back(factor(mechanism, all.slots.back(), name, axis));
      }
    }
  }
  return all;
}

/// Positions of the factors whose names match, ascending. Throws if there are none.
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
      mechanism.slots.push_back(all.slots[f]);
    }
  }
}

void add_named(const ErrorLines& error, double scale, Mechanism& mechanism) {
  const bool vector = error.components.size() > 1;
  for (std::size_t k = 0; k < error.limbs.size(); ++k) {
    const std::string number = error.numbers[k] == 0 ? "" : "_" + std::to_string(error.numbers[k]);
    for (const std::size_t component : error.components) {
      const std::string axis = vector ? std::string(1, axis_of(component)) : "";
      const std::string name = error.name.name + (vector ? "_" + axis : "") + number;
      const ErrorSlot slot{error.limbs[k], error.frames[k], component, scale};
      Factor made = factor(mechanism, slot, name, axis);
      if (!error.description.empty()) made.description = error.description;
      if (std::ranges::find(mechanism.factors, name, &Factor::name) != mechanism.factors.end()) {
        throw InputError(error.name.place,
                         error.name.key + " '" + error.name.name + "' makes a second error '" + name + "'",
                         "give it a name of its own");
      }
      mechanism.factors.push_back(std::move(made));
      mechanism.slots.push_back(slot);
    }
  }
}

/// Whether two limbs have the same joints in the same order.
bool are_alike(const Limb& a, const Limb& b) {
  return std::ranges::equal(a.joints, b.joints, {}, &Joint::motion, &Joint::motion);
}

/// A text that names the limbs with this error, limb = "each", and the two parts that its frame connects in them.
EachLimb each_limb(const ErrorLines& error, const Mechanism& mechanism) {
  EachLimb each{"error " + error.name.name + " with limb = \"each\" is", true};
  for (std::size_t i = 0; i < error.limbs.size();) {
    const auto parts_in = [&](std::size_t limb) {
      return parts_of(mechanism, mechanism.limbs[limb], error.frames[limb]).text();
    };
    const std::string parts = parts_in(i);
    const std::size_t first = i;
    while (i < error.limbs.size() && parts_in(i) == parts) ++i;
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

void add_factors(const MechanismFile& file, std::span<const double> geometry, Mechanism& mechanism) {
  FrameErrors all = frame_errors(mechanism);
  if (file.all_frames()) {
    mechanism.factors = std::move(all.factors);
    mechanism.slots = std::move(all.slots);
  } else if (file.frames) {
    add_listed(*file.frames, all, mechanism);
  }
  for (const ErrorLines& error : file.errors) {
    const double scale = evaluate(error.scale, Dimension::number, file.geometry, geometry);
    if (scale == 0.0) {
      throw InputError(error.scale.place, error.scale.key + " is zero, so the error has no effect", "write its scale");
    }
    add_named(error, scale, mechanism);
    if (error.each) mechanism.each.push_back(each_limb(error, mechanism));
  }
  FactorSet every{"all", "all errors", {}};
  for (std::size_t f = 0; f < mechanism.factors.size(); ++f) every.factors.emplace_back(f);
  mechanism.sets.push_back(std::move(every));
  for (const SetLines& set : file.sets) mechanism.sets.push_back(set_of(set, mechanism.factors));
}

}  // namespace poesy::file
