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

namespace poesy::sobol {

/// Errors that vary together: a mixture of two samples takes either all of them or none of them from the second sample.
struct ErrorGroup {
  std::string name;                  ///< name of the group; a group of a single error has the name of the error
  std::vector<std::size_t> members;  ///< positions of the errors among those that the study varies, ascending
};

/// The name of the group of errors that no named group contains.
inline constexpr std::string_view kOtherErrors = "others";

/// The groups of a study. Each error is in exactly one group. The group "others", with the errors that no named group
/// contains, comes last.
std::vector<ErrorGroup> error_groups(const Analysis& analysis, const ModelDescription& model);

/// For each group, 1 if one of its errors is correlated with an error of another group, otherwise 0.
std::vector<std::uint8_t> split_groups(std::span<const ErrorGroup> groups, const Study& study);

/// The positions of two groups in the list of groups.
using GroupPair = std::pair<std::size_t, std::size_t>;

/// All pairs of groups, with the smaller position first.
std::vector<GroupPair> group_pairs(std::size_t groups);

/// A vector whose components have a sign and the same unit. Its mean square does not depend on the directions of the
/// coordinate axes.
struct SignedVector {
  std::string name;                     ///< name of the vector: "position", "delta_mu_21_v"
  std::vector<std::size_t> components;  ///< positions of the components: r for response r; R + d for component d of the
                                        ///< additional outputs of a model with R responses
};

/// The SI unit of each component of an additional output.
std::vector<std::string> component_units(const Detail& detail);

/// The signed vectors of a model. The responses NAME_x, NAME_y and NAME_z are one vector; x, y and z without a name are
/// the vector "displacement", and theta_x, theta_y and theta_z the vector "theta". Neighbouring components of an
/// additional output (Detail in model/model.h) with the same unit are one vector as well.
std::vector<SignedVector> signed_vectors(const ModelDescription& model);

}  // namespace poesy::sobol
