#include "models/three_prs/errors.h"

#include <array>
#include <string_view>

#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {
namespace {

/// The class of an error source (San et al. 2023, Section 4.2).
enum class Role {
  none,            ///< no first-order effect
  compensable,     ///< enters the drive rows, except that c enters the constraint rows as well
  non_compensable  ///< enters the constraint rows
};

/// One component of an error source.
struct Entry {
  std::size_t frame;
  std::string_view source;
  std::string_view axis;  ///< axis of a vector's component; empty for a scalar
  Role role;
};
/// The components of all error sources, in the order of Source.
constexpr std::array<Entry, kSources> kEntries{{{0, "a", "x", Role::compensable},
                                                {0, "a", "y", Role::non_compensable},
                                                {0, "a", "z", Role::compensable},
                                                {1, "q", "", Role::compensable},
                                                {2, "theta_A", "x", Role::non_compensable},
                                                {2, "theta_A", "y", Role::compensable},
                                                {2, "theta_A", "z", Role::non_compensable},
                                                {3, "b", "x", Role::compensable},
                                                {3, "b", "y", Role::non_compensable},
                                                {3, "b", "z", Role::compensable},
                                                {4, "theta_B", "x", Role::non_compensable},
                                                {4, "theta_B", "y", Role::none},
                                                {4, "theta_B", "z", Role::non_compensable},
                                                {5, "theta_Bp", "x", Role::non_compensable},
                                                {5, "theta_Bp", "y", Role::none},
                                                {5, "theta_Bp", "z", Role::none},
                                                {6, "l", "", Role::compensable},
                                                {7, "c", "x", Role::compensable},
                                                {7, "c", "y", Role::compensable},
                                                {7, "c", "z", Role::compensable}}};

/// The errors of a frame in words, and the names of the axes along which they are measured.
struct Meaning {
  std::string_view part;
  std::array<std::string_view, 3> axes;
};
constexpr std::array<std::string_view, 3> kLimbAxes{"outwards", "the revolute joint's axis", "down the rail"};
constexpr std::array<std::string_view, 3> kRodAxes{"across the rod", "the revolute joint's axis", "the rod's own axis"};
constexpr std::array<std::string_view, 3> kPlatformAxes{"outwards", "across", "the platform's axis"};
/// The meanings of the frames 0 to 7 (San et al. 2023, Figures 3 and 4).
constexpr std::array<Meaning, kFrames> kMeanings{{{"position error of the rail's upper end A", kLimbAxes},
                                                  {"error of the carriage's initial position on its rail", {}},
                                                  {"attitude error of the rail", kLimbAxes},
                                                  {"gap of the revolute joint on the carriage", kLimbAxes},
                                                  {"attitude error of the revolute joint", kLimbAxes},
                                                  {"swing angle error of the rod", kRodAxes},
                                                  {"error of the rod's length", {}},
                                                  {"position error of the spherical joint C", kPlatformAxes}}};

Factor factor(const Entry& entry, std::size_t limb) {
  const std::string number = std::to_string(limb + 1);
  const bool is_angle = entry.source.starts_with("theta");
  const Meaning& meaning = kMeanings[entry.frame];
  std::string name(entry.source);
  std::string description = "limb " + number + ": " + std::string(meaning.part);
  if (!entry.axis.empty()) {
    const std::string axis(entry.axis);
    name += "_" + axis;
    description += (is_angle ? " about " : " along ") + axis + ", " +
                   std::string(meaning.axes[static_cast<std::size_t>(axis.front() - 'x')]);
  }
  if (entry.role == Role::none) description += "; without effect on the platform to first order";
  return {name + "_" + number,    is_angle ? Dimension::angle : Dimension::length, limb + 1, entry.frame, description,
          std::string(entry.axis)};
}

template <class Belongs>
FactorSet subset(const char* name, const char* description, Belongs belongs) {
  FactorSet set{name, description, {}};
  for (std::size_t f = 0; f < kFactors; ++f) {
    if (belongs(kEntries[f % kSources])) set.factors.emplace_back(f);
  }
  return set;
}

}  // namespace

std::vector<Factor> factors() {
  std::vector<Factor> list;
  for (std::size_t limb = 0; limb < kLimbs; ++limb) {
    for (const Entry& entry : kEntries) list.push_back(factor(entry, limb));
  }
  return list;
}

std::vector<std::string> published_classes() {
  std::vector<std::string> classes;
  for (std::size_t f = 0; f < kFactors; ++f) {
    const Role role = kEntries[f % kSources].role;
    classes.emplace_back(role == Role::none ? "" : role == Role::compensable ? "compensable" : "non-compensable");
  }
  return classes;
}

std::vector<FactorSet> factor_sets() {
  const auto role = [](Role wanted) { return [wanted](const Entry& entry) { return entry.role == wanted; }; };
  return {
      subset("all", "all sources that have an effect", [](const Entry& entry) { return entry.role != Role::none; }),
      subset("compensable", "sources that calibration can remove, by the paper; c, in fact, only in part",
             role(Role::compensable)),
      subset("non-compensable", "sources that manufacture and assembly must keep small", role(Role::non_compensable)),
      subset("platform-hinges", "hinge positions of both platforms, a and c (FS)",
             [](const Entry& entry) { return entry.source == "a" || entry.source == "c"; }),
      subset("initial-position", "initial positions of the carriages, q (T)",
             [](const Entry& entry) { return entry.source == "q"; }),
      subset("revolute-gap", "gaps of the revolute joints, b (R)",
             [](const Entry& entry) { return entry.source == "b"; }),
      subset("rod-length", "lengths of the rods, l (L)", [](const Entry& entry) { return entry.source == "l"; })};
}

}  // namespace poesy::three_prs
