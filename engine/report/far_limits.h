#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/result/result_file.h"

namespace poesy {

/// Returns true if `times`, the ratio of a limit to its judged value or the inverse ratio, is so large that a unit is
/// probably wrong. False for NaN, and for a ratio that is large because the judged value is zero up to rounding.
bool is_far(double times);

/// The end of a note on a limit for which is_far() is true.
constexpr std::string_view kLookAtUnits = ": look at the units of limits and sigmas";

/// Notes on limits that are more than 30 times larger or smaller than the typical magnitude of their response, if all
/// or none of the draws, machines or rows keep them. The likely cause is a limit or a sigma in a wrong unit. Limits on
/// a spread are left out, and so are responses whose typical magnitude is not finite, or is zero up to rounding.
/// typical: typical magnitude for the limit with this index, SI. name: name of this magnitude, such as "root mean
/// square".
std::vector<std::string> far_limit_notes(const StoredResult& result,
                                         const std::function<double(std::size_t limit)>& typical,
                                         std::string_view name);

}  // namespace poesy
