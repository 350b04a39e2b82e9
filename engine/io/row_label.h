#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace poesy {

/// What a name that a user gives to a row may not be, as a clause ("begins with '='"), or none when it may stand in
/// tables, CSV, spreadsheets and pages as it is: 1 to 60 bytes of printable UTF-8 on one line, without commas,
/// semicolons and quotes, and not beginning with = + - or @, which spreadsheets take for a formula.
std::optional<std::string> label_problem(std::string_view label);

/// The rule of label_problem() in words, for remedies.
inline constexpr std::string_view kLabelRule =
    "write at most 60 printable characters, without commas, semicolons and quotes, that do not begin with = + - or @";

}  // namespace poesy
