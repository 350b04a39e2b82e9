#pragma once

#include <string>

namespace poesy::app {

/// Seconds of "10 s", "5 min" or "2 h". Throws InputError that names the option when the text is anything else, or not
/// greater than zero.
double parse_duration(const std::string& text, const std::string& option);

}  // namespace poesy::app
