#pragma once

#include <string_view>

namespace poesy {

/// What a report's page is made of besides its own text: "d3.js", "plot.js", "report.js" (to be run in this order) and
/// "report.css". Each may stand inside a script or style element as it is; scripts of others begin with their licences.
/// Another name is a broken contract, and empty where contracts are not checked.
std::string_view asset(std::string_view name);

}  // namespace poesy
