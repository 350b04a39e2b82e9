#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/allocation/result.h"
#include "engine/report/tables.h"

/// Texts and orders that files, tables and reports of tolerances share.
namespace poesy {

/// Whether the aim has costs.
inline bool has_costs(const AllocationResult& found) { return !std::isnan(found.total_cost); }

/// Positions of the responses that have a limit, in their order.
std::vector<std::size_t> limited_responses(const AllocationResult& found);

/// The pose at which these numbers of a response are largest; none where none is above zero.
std::optional<std::size_t> worst_pose(std::span<const double> at_poses);

/// The shares by which parts are ordered: of the cost, or of the mean square if the aim has no costs.
const AllocationResult::Parts<double>& shown_shares(const AllocationResult& found);

/// The positions of the parts in this order: by shown_shares() descending, by name, or as in the study.
std::vector<std::size_t> ordered_parts(const AllocationResult& found, RowOrder order);

/// "certified: at least 99.73 % of the machines are within all limits at all poses, ...", or why it is not.
std::string certificate_text(const AllocationResult& found);

/// A tolerance in the unit in which people read it: four digits, rounded down so that limits are still kept.
std::string drawing_number(double tolerance, const std::string& si_unit);

/// T as a drawing has it, "+-0.0123 mm": four digits, rounded down so that limits are still kept.
std::string drawing_text(double tolerance, const std::string& si_unit);

}  // namespace poesy
