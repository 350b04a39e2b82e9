#pragma once

#include <optional>
#include <string_view>

/// Preferred numbers of ISO 3, by which sizes in workshops and catalogues are often graded.
namespace poesy {

/// The basic series R5, R10 and R20 with 5, 10 and 20 numbers in each decade.
enum class PreferredSeries { r5, r10, r20 };

std::string_view name(PreferredSeries series);  ///< The name of a series: "R5", "R10" or "R20".
/// The series with this name; none if there is no such series.
std::optional<PreferredSeries> find_preferred_series(std::string_view name);

/// The numbers of a series are those of ISO 3:1973, Table 1, times powers of ten. They are rounded, so some differ by
/// up to 1.3 % from the exact powers of 10^(1/5), 10^(1/10) or 10^(1/20). A value within a relative 1e-12 of a number
/// counts as that number. Precondition: the value is positive and finite.
/// @{
double preferred_at_most(double value, PreferredSeries series);   ///< The largest number that is not above the value.
double preferred_at_least(double value, PreferredSeries series);  ///< The smallest number that is not below the value.
/// @}

}  // namespace poesy
