#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/io/result_file.h"

namespace poesy {

/// Position of a response among the result's; it must have it.
std::size_t response_named(const StoredResult& result, std::string_view name);

/// Factors by the spread that each gives the response at the size the study sets: index x sigma(error). Indices alone
/// do not compare, for some are per m and some per rad.
std::vector<std::size_t> ranking(const StoredResult& result, std::size_t response);

/// "17 380 000".
std::string count_text(std::uint64_t count);

}  // namespace poesy
