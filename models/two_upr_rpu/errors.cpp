#include "models/two_upr_rpu/errors.h"

#include <array>
#include <string_view>

namespace poesy::two_upr_rpu {
namespace {

/// The kinds of errors of a limb: a row for each frame j = 0..4, a column for each of delta x, y, z, epsilon x, y, z.
/// '.' means that there is no geometric error, 'o' marks a geometric error, and 'x' marks a geometric error that causes
/// internal forces and deformations (Du et al. 2022, Table 7).
using Table = std::array<std::string_view, 5>;
constexpr Table kUprLimb{"oxx.xx",   //
                         "oxox.x",   //
                         ".oxxxo",   //
                         "xo..xx",   //
                         "oxox.x"};  //
constexpr Table kRpuLimb{"ooo.xx",   //
                         ".ooxxo",   //
                         "oo..xx",   //
                         "ooox..",   //
                         "ooox.x"};  //
constexpr std::array<Table, 3> kLimbs{kUprLimb, kUprLimb, kRpuLimb};

/// The body that the errors of frame j = 0..4 of a limb displace, and the body relative to which it is displaced (Du et
/// al. 2022, Tables 1 to 3 and the text below Eq. 25).
using Parts = std::array<std::string_view, 5>;
constexpr Parts kUprParts{"universal joint's first axis against the base",         //
                          "universal joint's second axis against its first",       //
                          "lead screw against the universal joint's second axis",  //
                          "revolute joint against the lead screw",                 //
                          "revolute joint's hole against the platform"};
constexpr Parts kRpuParts{"revolute joint against the base",                      //
                          "lead screw against the revolute joint",                //
                          "universal joint's first axis against the lead screw",  //
                          "universal joint's second axis against its first",      //
                          "universal joint's hole against the platform"};
constexpr std::array<Parts, 3> kParts{kUprParts, kUprParts, kRpuParts};

/// The name of the frame along whose axes the errors of frame j are measured. The z axis of a frame is the axis of its
/// joint.
std::string axes_of(std::size_t frame, char axis) {
  if (frame == 0) return "the base";
  if (frame == 4) return "the platform";
  return "frame " + std::to_string(frame) + (axis == 'z' ? ", the joint's axis" : "");
}

struct Entry {
  std::size_t limb;
  std::size_t frame;
  std::size_t column;
  bool deforming;
};

std::vector<Entry> entries() {
  std::vector<Entry> list;
  for (std::size_t limb = 0; limb < kLimbs.size(); ++limb) {
    for (std::size_t frame = 0; frame < kLimbs[limb].size(); ++frame) {
      for (std::size_t column = 0; column < 6; ++column) {
        const char mark = kLimbs[limb][frame][column];
        if (mark != '.') list.push_back({limb, frame, column, mark == 'x'});
      }
    }
  }
  return list;
}

bool is_linear(const Entry& entry) { return entry.column < 3; }

Factor factor(const Entry& entry) {
  const char axis = "xyz"[entry.column % 3];
  const std::string limb = std::to_string(entry.limb + 1);
  const std::string frame = std::to_string(entry.frame);
  const std::string kind = is_linear(entry) ? "delta" : "epsilon";
  const std::string motion = is_linear(entry) ? "linear error along " : "angular error about ";
  return {kind + "_" + limb + "_" + frame + "_" + axis,
          is_linear(entry) ? Dimension::length : Dimension::angle,
          entry.limb + 1,
          entry.frame,
          "limb " + limb + ", " + std::string(kParts[entry.limb][entry.frame]) + ": " + motion + axis + " of " +
              axes_of(entry.frame, axis),
          std::string(1, axis)};
}

template <class Belongs>
FactorSet subset(const char* name, const char* description, Belongs belongs) {
  FactorSet set{name, description, {}};
  const std::vector<Entry> list = entries();
  for (std::size_t f = 0; f < list.size(); ++f) {
    if (belongs(list[f])) set.factors.emplace_back(f);
  }
  return set;
}

}  // namespace

std::vector<Factor> factors() {
  std::vector<Factor> list;
  for (const Entry& entry : entries()) list.push_back(factor(entry));
  return list;
}

std::vector<chain::ErrorTerms> error_terms() {
  std::vector<chain::ErrorTerms> terms;
  for (const Entry& entry : entries()) terms.push_back({{entry.limb, entry.frame, (entry.column + 3) % 6}});
  return terms;
}

std::vector<FactorSet> factor_sets() {
  return {
      subset("all", "all geometric errors", [](const Entry&) { return true; }),
      subset("deforming", "errors of limbs 1 and 3 that cause internal forces and deformations",
             [](const Entry& entry) { return entry.deforming && entry.limb != 1; }),
      subset("deforming-all", "errors of all limbs that cause internal forces and deformations",
             [](const Entry& entry) { return entry.deforming; }),
      subset("benign", "errors that the passive joints absorb", [](const Entry& entry) { return !entry.deforming; })};
}

}  // namespace poesy::two_upr_rpu
