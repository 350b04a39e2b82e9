#include "engine/report/html/figures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "engine/base/contract.h"

namespace poesy {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

float shown(double value) {
  return std::isfinite(value) ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

ArrayName ArrayPool::add(const std::string& name, std::span<const double> values, double unit) {
  const auto [entry, added] = arrays_.try_emplace(name);
  if (added) {
    entry->second.reserve(values.size());
    for (const double value : values) entry->second.push_back(shown(value / unit));
  }
  POESY_EXPECTS(entry->second.size() == values.size());
  return name;
}

std::string base64(std::span<const std::byte> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t group = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      group = group << 8 | (n < count ? std::to_integer<std::uint32_t>(bytes[at + n]) : 0U);
    }
    for (std::size_t n = 0; n < 4; ++n) text += n <= count ? kDigits[group >> (18 - 6 * n) & 63] : '=';
  }
  return text;
}

}  // namespace poesy
