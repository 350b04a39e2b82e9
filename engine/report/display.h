#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/io/result_file.h"

namespace poesy {

/// The dimension of which this is the SI unit; a number for any other.
Dimension dimension_of(std::string_view si_name);

/// The unit in which people read it: mm for m.
const Unit& display(const NamedUnit& named);

/// "17 380 000".
std::string count_text(std::uint64_t count);

}  // namespace poesy
