#include "models/file/bodies.h"

#include <algorithm>

#include "engine/base/text.h"
#include "models/file/file_rows.h"

namespace poesy::file {
namespace {

std::string name_of(const BodyLines& lines, std::size_t copy) {
  return lines.copies.count == 1 ? lines.name : lines.name + "_" + std::to_string(copy + 1);
}

void give_mass(const Numbers& numbers, const std::optional<Expression>& mass, const std::optional<Triple>& centre,
               assembly::Body& body) {
  if (mass) body.mass = numbers.positive(*mass, kMass);
  if (centre) body.centre = numbers.point(*centre);
}

std::string copies_text(const Copies& copies) {
  return std::to_string(copies.count) + " about " + std::string(kAxes[copies.about]);
}

/// The copy of the body to which copy `copy` of a limb refers (both counted from 0). Throws unless limb and body have
/// the same copies.
std::size_t same_copy(const LimbLines& limb, const BodyLines& body, const Reference& reference, std::size_t copy) {
  if (limb.copies == body.copies) return copy;
  const std::string one = "name one of them, \"" + name_of(body, 0) + "\"";
  if (limb.joints.empty()) {  // the reference is to the body of a load, for which the argument `limb` has no joints
    throw InputError(reference.place,
                     reference.key + " '" + reference.name + "' has copies, " + copies_text(body.copies), one);
  }
  const bool alone = limb.copies.count == 1;
  throw InputError(
      reference.place,
      reference.key + " '" + reference.name + "' has copies, " + copies_text(body.copies) + ", and the limb has " +
          (alone ? "none" : "others, " + copies_text(limb.copies)),
      alone ? one : "copy k of the limb goes with copy k of the body, so give both the same copies, or " + one);
}

/// The place of a body's table in the file; for base and platform the place of [platform].
Place place_of(const MechanismFile& file, std::size_t body) {
  std::size_t first = kPlatform + 1;
  for (const BodyLines& lines : file.bodies) {
    if (body >= first && body < first + lines.copies.count) return lines.place;
    first += lines.copies.count;
  }
  return file.platform.place;
}

void check_limb(const LimbLines& lines, const Mechanism& made, std::size_t position) {
  const Limb& limb = made.limbs[position];
  if (limb.to == kBase) {
    throw InputError(lines.to->place, lines.to->key + " is the base, where no limb ends",
                     "let the limb begin at the base: exchange from and to, and the order of its joints");
  }
  if (limb.from == limb.to) {
    throw InputError(lines.place, lines.key + " ends at the body where it begins, '" + made.bodies[limb.to].name + "'",
                     "name two bodies in from and to");
  }
  for (std::size_t k = 0; k < position; ++k) {
    if (made.limbs[k].label != limb.label) continue;
    throw InputError(lines.place, lines.key + " makes a second limb '" + limb.label + "'", "give it a name of its own");
  }
}

}  // namespace

std::vector<assembly::Body> bodies_of(const Numbers& numbers, const Transform& platform) {
  const MechanismFile& file = numbers.file();
  std::vector<assembly::Body> bodies{{"base", {}}, {"platform", platform}};
  give_mass(numbers, file.platform.mass, file.platform.centre, bodies[kPlatform]);
  for (const BodyLines& lines : file.bodies) {
    Transform home{lie::Matrix3<double>::Identity(), numbers.point(*lines.at)};
    if (lines.x) home.R = numbers.axes(*lines.x, *lines.z);
    for (std::size_t copy = 0; copy < lines.copies.count; ++copy) {
      assembly::Body body{name_of(lines, copy), copy == 0 ? home : turned(lines.copies, copy) * home};
      if (std::ranges::find(bodies, body.name, &assembly::Body::name) != bodies.end()) {
        throw InputError(lines.place, lines.key + " makes a second body '" + body.name + "'",
                         "give it a name of its own");
      }
      give_mass(numbers, lines.mass, lines.centre, body);
      bodies.push_back(std::move(body));
    }
  }
  return bodies;
}

std::size_t body_of(const MechanismFile& file, const LimbLines& limb, const std::optional<Reference>& reference,
                    std::size_t usual, std::size_t copy) {
  if (!reference) return usual;
  if (reference->name == "base") return kBase;
  if (reference->name == "platform") return kPlatform;
  std::size_t first = kPlatform + 1;
  std::vector<std::string> known{"base", "platform"};
  for (const BodyLines& lines : file.bodies) {
    const std::size_t count = lines.copies.count;
    if (count > 1) known.push_back(lines.name);
    if (lines.name == reference->name) return first + (count == 1 ? 0 : same_copy(limb, lines, *reference, copy));
    for (std::size_t k = 0; k < count; ++k) {
      known.push_back(name_of(lines, k));
      if (known.back() == reference->name) return first + k;
    }
    first += count;
  }
  const std::vector<std::string_view> all(known.begin(), known.end());
  throw InputError(reference->place, reference->key + " '" + printable(reference->name) + "' names no body",
                   suggestion(reference->name, all));
}

void check_branches(const MechanismFile& file, const Mechanism& made) {
  std::size_t position = 0;
  for (const LimbLines& lines : file.limbs) {
    for (std::size_t copy = 0; copy < lines.copies.count; ++copy) check_limb(lines, made, position++);
  }
  std::vector<bool> is_end(made.bodies.size(), false);
  std::vector<bool> is_placed(made.bodies.size(), false);
  for (const Limb& limb : made.limbs) is_end[limb.to] = true;
  for (const std::size_t limb : placing_limbs(made)) is_placed[made.limbs[limb].to] = true;
  for (std::size_t b = kPlatform; b < made.bodies.size(); ++b) {
    const std::string body = "body '" + made.bodies[b].name + "'";
    if (!is_end[b]) {
      throw InputError(place_of(file, b), body + " is where no limb ends",
                       "write to = \"" + made.bodies[b].name + "\" in one");
    }
    if (is_placed[b]) continue;
    throw InputError(place_of(file, b), body + " is not reached from the base, because limbs lead to it in a circle",
                     "turn a limb round: exchange its from and to, and the order of its joints");
  }
}

}  // namespace poesy::file
