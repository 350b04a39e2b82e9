#pragma once

#include <string>
#include <string_view>

namespace poesy {

/// A whole text as a terminal may show it, whatever file it came from: valid UTF-8 whose only control characters are
/// line ends and tabs; "?" stands for all others.
std::string printable_lines(std::string_view text);

}  // namespace poesy
