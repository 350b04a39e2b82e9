#pragma once

#include <string>
#include <string_view>

namespace poesy {

/// The text in a form that is safe on a terminal: valid UTF-8 whose only control characters are line ends and tabs.
/// Invalid bytes and other control characters become "?".
std::string printable_lines(std::string_view text);

}  // namespace poesy
