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

/// Errors that vary together in a pair of samples.
struct ErrorGroup {
  std::string name;                  ///< name of the group; for a single error, that of the error
  std::vector<std::size_t> members;  ///< positions among the study's errors, ascending
};

/// The group of the errors that no named group has.
inline constexpr std::string_view kOtherErrors = "others";

/// The groups of a study; each error is in exactly one. Errors of no named group come last, as "others".
std::vector<ErrorGroup> error_groups(const Analysis& analysis, const ModelDescription& model);

/// Whether an error of each group is correlated with an error of another group, 0 or 1.
std::vector<std::uint8_t> split_groups(std::span<const ErrorGroup> groups, const Study& study);

/// Positions of two groups.
using GroupPair = std::pair<std::size_t, std::size_t>;

/// All pairs of groups, with the smaller position first.
std::vector<GroupPair> group_pairs(std::size_t groups);

/// A vector with a sign and with components of one unit, so that its mean square does not depend on the axes.
struct SignedVector {
  std::string name;                     ///< "position", "delta_mu_21_v"
  std::vector<std::size_t> components;  ///< positions: r for a response, R + d for a component of a detail
};

/// The SI unit of each component of a detail.
std::vector<std::string> component_units(const Detail& detail);

/// The signed vectors of a model: responses NAME_x, NAME_y and NAME_z (x, y and z alone are "displacement", theta_x
/// etc. are "theta"), and the parts of each detail that have one unit.
std::vector<SignedVector> signed_vectors(const ModelDescription& model);

}  // namespace poesy
