#pragma once

#include <cstddef>

namespace poesy::app {

/// Characters that a line of stdout has room for: of a terminal what it says, else what COLUMNS says, else 80. What is
/// no terminal has room for any line.
std::size_t output_width();

}  // namespace poesy::app
