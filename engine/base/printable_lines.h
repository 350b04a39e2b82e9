#pragma once

#include <string>
#include <string_view>

namespace poesy {

/// A text that is safe on a terminal: valid UTF-8 whose only control characters are line ends and tabs. Other
/// characters are replaced by "?".
std::string printable_lines(std::string_view text);

}  // namespace poesy
