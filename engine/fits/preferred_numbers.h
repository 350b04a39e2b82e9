#pragma once

#include <optional>
#include <string_view>

/// Preferred numbers of ISO 3: steps that workshops and catalogues use.
namespace poesy {

/// The basic series with 5, 10 and 20 numbers in a decade.
enum class PreferredSeries { r5, r10, r20 };

std::string_view name(PreferredSeries series);  ///< "R5", "R10" or "R20".
std::optional<PreferredSeries> find_preferred_series(
    std::string_view name);  ///< None if there is no series of that name.

/// The numbers of a series are those of ISO 3:1973, Table 1, times powers of ten; they are rounded, so that some differ
/// by up to 1.3 % from powers of the root of ten. Precondition: the value is positive and finite. A value within 1e-12
/// of a number is that number.
/// @{
double preferred_at_most(double value, PreferredSeries series);   ///< The largest number that is not above the value.
double preferred_at_least(double value, PreferredSeries series);  ///< The smallest number that is not below the value.
/// @}

}  // namespace poesy
