#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/allocation/result.h"
#include "engine/report/tables.h"

/// What files, tables and reports all say of tolerances that were found.
namespace poesy {

/// Whether the aim has costs.
inline bool has_costs(const AllocationResult& found) { return !std::isnan(found.total_cost); }

/// Positions of the responses that have a limit, in their order.
std::vector<std::size_t> limited_responses(const AllocationResult& found);

/// The pose at which these numbers of a response are largest; none where none is above zero.
std::optional<std::size_t> worst_pose(std::span<const double> at_poses);

/// By which parts are ordered: their shares of the cost, or without costs of the mean square.
const AllocationResult::Parts<double>& shown_shares(const AllocationResult& found);

/// Positions of the parts in this order: by shown_shares, the largest first; or by name, or as the study has them.
std::vector<std::size_t> ordered_parts(const AllocationResult& found, RowOrder order);

/// "certified: at least 99.73 % of the machines are within all limits at all poses, ...", or why it is not.
std::string certificate_text(const AllocationResult& found);

/// T as a drawing has it, "+-0.0123 mm": to four digits, rounded down so that limits are still kept.
std::string drawing_text(double tolerance, const std::string& si_unit);

}  // namespace poesy
