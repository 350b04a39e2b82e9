#pragma once

#include <span>
#include <string_view>

namespace poesy::app {

/// A name and what it means, for help and manual.
struct Entry {
  std::string_view name;
  std::string_view meaning;
};

std::span<const Entry> exit_codes();
std::span<const Entry> files();
std::span<const Entry> environment();

}  // namespace poesy::app
