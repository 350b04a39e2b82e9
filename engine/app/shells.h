#pragma once

#include <array>
#include <string_view>

namespace poesy::app {

/// Those that 'poesy completion' writes a script for.
inline constexpr std::array<std::string_view, 2> kShells{"bash", "zsh"};

}  // namespace poesy::app
