#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/io/result_file.h"

namespace poesy {

/// "17 380 000".
std::string count_text(std::uint64_t count);

}  // namespace poesy
