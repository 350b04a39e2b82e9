#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/report/merits.h"
#include "engine/result/result_file.h"

/// Finds out whether figures of merit of two results answer the same question. A yield under wider limits is larger
/// although the machines are the same, so it does not say that a design is better.
namespace poesy {

/// The topic of the requirement that a setting states: "limits", "wanted yields", "draws", "metrics" or "poses". Empty
/// if a figure of merit can be compared although two studies differ in the setting, such as in the number of poses.
/// setting: full name of the setting, "analysis.limits.gap". merit: name of the figure of merit.
std::string_view required_by(std::string_view setting, std::string_view merit);

/// The part of a setting's value that is a requirement: for a trajectory, the value without its number of points.
std::string required_value(const std::string& setting, const std::string& value);

/// Where the poses of results come from: from the settings of the study, or from a table (`--poses`).
enum class PosesFrom { study, table };

/// The requirements on which a figure of merit depends and in which two results differ. Different metrics are not
/// listed (see differ_in_metric()). Settings of poses are listed only if the poses differ. If poses from tables differ
/// and no setting explains this, the table itself ("--poses") is listed.
std::vector<OtherRequirement> other_requirements(const StoredResult& a, const StoredResult& b, std::string_view merit,
                                                 PosesFrom poses = PosesFrom::study);

/// The share of the poses of the workspace that a study leaves out, because the mechanism does not reach them, a joint
/// limit excludes them or they are near singular; 0 if none is known. NaN if the study's poses are those of a boundary
/// and the mechanism does not reach all of the workspace: how much of it is missing is then not known.
double left_out_share(const StoredResult& result);

/// Returns true if two studies with different poses leave out so different shares of the workspace (left_out_share())
/// that figures of merit cannot be compared: the mechanism that reaches less is judged at fewer of the difficult poses.
bool leave_out_otherwise(double a, double b);

/// The topics of these requirements, each once: "limits and poses".
std::string topics_text(const std::vector<OtherRequirement>& others);

/// What differs, with the values in A and in the result of this letter: "the limits differ (analysis.limits.gap: 0.15
/// mm in A, 0.2 mm in B)". Long values are left out.
std::string others_text(const std::vector<OtherRequirement>& others, char letter);

}  // namespace poesy
