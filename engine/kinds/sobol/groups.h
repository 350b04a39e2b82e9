#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/kinds/sobol/result.h"
#include "engine/model/model.h"
#include "engine/study/study.h"

namespace poesy {

/// Errors that vary at once in a pair of samples.
struct ErrorGroup {
  std::string name;                  ///< of an error of its own that error's
  std::vector<std::size_t> members;  ///< positions among the study's errors, ascending
};

/// What errors that no named group has are called together.
inline constexpr std::string_view kOtherErrors = "others";

/// The groups of a study: each error is in one. With named groups, errors that none of them has come last, as "others".
std::vector<ErrorGroup> error_groups(const Analysis& analysis, const ModelDescription& model);

/// Of each group whether an error of it is correlated with one of another group: 0 or 1.
std::vector<std::uint8_t> split_groups(std::span<const ErrorGroup> groups, const Study& study);

/// Positions of two groups.
using GroupPair = std::pair<std::size_t, std::size_t>;

/// All pairs of so many groups, the smaller position first.
std::vector<GroupPair> group_pairs(std::size_t groups);

/// A vector with a sign, whose components have one unit: its mean square does not depend on the axes.
struct SignedVector {
  std::string name;                     ///< "position", "delta_mu_21_v"
  std::vector<std::size_t> components;  ///< positions: r of a response, R + d of a detail's component
};

/// The SI unit of each component of a detail.
std::vector<std::string> component_units(const Detail& detail);

/// The signed vectors of a model: responses NAME_x, NAME_y and NAME_z (x, y and z alone are "displacement", theta_x and
/// so on "theta"), and the parts of each detail that have one unit.
std::vector<SignedVector> signed_vectors(const ModelDescription& model);

}  // namespace poesy
