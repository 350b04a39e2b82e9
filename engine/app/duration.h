#pragma once

#include <string>

namespace poesy::app {

/// Seconds of "10 s", "5 min" or "2 h". Throws InputError that names the option when the text is anything else, or not
/// greater than zero.
double parse_duration(const std::string& text, const std::string& option);

/// "2.3 s", "45 s", "1 min 20 s", "35 min", "2 h 10 min", "3 d 4 h". Seconds of zero or more.
std::string readable_duration(double seconds);

}  // namespace poesy::app
