#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/allocation/result.h"
#include "engine/report/tables.h"

/// Texts of an allocation result, and orders of its parts, that files, tables and reports share.
namespace poesy::allocation {

/// Whether the study has costs.
inline bool has_costs(const Result& found) { return !std::isnan(found.total_cost); }

/// Positions of the responses that have a limit, ascending.
std::vector<std::size_t> limited_responses(const Result& found);

/// The pose with the largest number; none if no number is above zero. at_poses: [poses] the numbers.
std::optional<std::size_t> worst_pose(std::span<const double> at_poses);

/// The shares by which parts are ordered: shares of the cost, or of the mean square if the study has no costs.
const Result::Parts<double>& shown_shares(const Result& found);

/// Positions of the parts in the chosen order: by shown_shares() descending, by name, or as in the study.
std::vector<std::size_t> ordered_parts(const Result& found, RowOrder order);

/// The number of parts whose tolerance the drawing needs, which are all except orientations that are left out.
std::size_t parts_on_drawing(const Result& found);

/// The certificate in words: "certified: at least 99.73 % of the machines are within all limits at all poses, ...", or
/// the reason why the tolerances are not certified.
std::string certificate_text(const Result& found);

/// A tolerance as a number in its display unit: four digits, rounded down so that the limits still hold.
std::string drawing_number(double tolerance, const std::string& si_unit);

/// A tolerance as a drawing states it, "+-0.0123 mm": four digits, rounded down so that the limits still hold.
std::string drawing_text(double tolerance, const std::string& si_unit);

}  // namespace poesy::allocation
