#include "engine/report/html/printed_number.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "engine/base/text.h"

namespace poesy {
namespace {

constexpr int kLargest = 6;    ///< largest exponent of ten of a number that is printed with grouped digits
constexpr int kSmallest = -6;  ///< smallest exponent of ten of a number that is printed as a decimal number

/// The number of significant digits in a text; 0 if the text is not a plain number ("75 000", "inf").
int digits_of(std::string_view text) {
  int digits = 0;
  for (const char c : text.substr(0, text.find('e'))) {
    if (c >= '0' && c <= '9') {
      digits += digits > 0 || c != '0' ? 1 : 0;
    } else if (c != '.' && c != '-') {
      return 0;
    }
  }
  return digits;
}

/// A number with this many significant digits, including trailing zeros.
std::string with_digits(double value, int digits) { return fmt::format("{:#.{}g}", value, digits); }

/// The largest number of significant digits, up to `most`, for which the cell's text with appended zeros is still the
/// cell's number correctly rounded. It is at least the number of digits of the text.
int full_digits(const Cell& cell, int most) {
  const int shown = digits_of(cell.text);
  const double as_shown = std::strtod(cell.text.c_str(), nullptr);
  for (int digits = most; digits > shown; --digits) {
    if (std::strtod(with_digits(*cell.value, digits).c_str(), nullptr) == as_shown) return digits;
  }
  return shown;
}

/// A power of ten with a superscript exponent.
std::string power_of_ten(int exponent) {
  constexpr std::string_view kRaised[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                          "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = exponent < 0 ? "10\u207b" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) text += kRaised[digit - '0'];
  return text;
}

/// The digits of a whole number in groups of three.
std::string grouped(std::string digits) {
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, " ");
  return digits;
}

/// Prints a nonzero number with this many significant digits.
PrintedNumber printed(double shown, int digits) {
  const std::string scientific = fmt::format("{:.{}e}", std::abs(shown), digits - 1);
  const std::size_t e = scientific.find('e');
  const int exponent = std::atoi(scientific.c_str() + e + 1);
  const std::string sign = shown < 0.0 ? "\u2212" : "";
  std::string whole;
  std::string behind;
  if (exponent > kLargest || exponent < kSmallest) {
    const std::string mantissa = scientific.substr(0, e);
    whole = mantissa.substr(0, 1);
    behind = mantissa.substr(1) + "\u00a0\u00d7\u00a0" + power_of_ten(exponent);
  } else {
    const std::string text = fmt::format("{:.{}f}", std::abs(shown), std::max(0, digits - 1 - exponent));
    const std::size_t point = std::min(text.find('.'), text.size());
    whole = point > 4 ? grouped(text.substr(0, point)) : text.substr(0, point);
    behind = text.substr(point);
  }
  return {sign + whole + behind, text_width(behind), true};
}

}  // namespace

std::vector<PrintedNumber> printed_numbers(std::span<const Cell> column, int digits) {
  int most = digits;
  for (const Cell& cell : column) {  // whole numbers are exact, so the other numbers need not have as many digits
    if (digits == 0 && cell.value && cell.text.find_first_of(".e") != std::string::npos)
      most = std::max(most, digits_of(cell.text));
  }
  std::vector<PrintedNumber> list;
  for (const Cell& cell : column) {
    const int shown = cell.value ? digits_of(cell.text) : 0;
    if (!cell.value || (shown == 0 && cell.text != "0")) {
      list.push_back({cell.text, 0, cell.value.has_value()});
    } else if (shown == 0) {
      list.push_back({"0", 0, true});
    } else {
      list.push_back(printed(std::strtod(cell.text.c_str(), nullptr), full_digits(cell, most)));
    }
  }
  return list;
}

}  // namespace poesy
