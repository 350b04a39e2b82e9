#include "engine/app/whole_number.h"

#include <fmt/format.h>

#include <charconv>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace poesy::app {

std::uint64_t parse_whole_number(const std::string& text, const std::string& option, std::uint64_t least,
                                 std::uint64_t most) {
  std::uint64_t number = 0;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, number);
  if (error == std::errc() && end == last && number >= least && number <= most) return number;
  throw InputError({}, fmt::format("{} is '{}'", option, printable(text)),
                   fmt::format("give a whole number from {} to {}", least, most));
}

}  // namespace poesy::app
