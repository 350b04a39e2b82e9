#include "engine/report/latex_text.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/model/feature.h"

namespace poesy {
namespace {

std::string_view escaped(char c) {
  switch (c) {
    case '\\':
      return "\\textbackslash{}";
    case '~':
      return "\\textasciitilde{}";
    case '^':
      return "\\textasciicircum{}";
    case '<':
      return "\\textless{}";
    case '>':
      return "\\textgreater{}";
    case '|':
      return "\\textbar{}";
    case '"':
      return "\\char34{}";  // \textquotedbl needs another font encoding
    case '&':
      return "\\&";
    case '%':
      return "\\%";
    case '$':
      return "\\$";
    case '#':
      return "\\#";
    case '_':
      return "\\_";
    case '{':
      return "\\{";
    case '}':
      return "\\}";
    default:
      return {};
  }
}

/// A sign beyond ASCII, and its code in LaTeX.
struct Sign {
  std::string_view sign;   ///< UTF-8
  std::string_view latex;  ///< LaTeX code of the sign, for pdflatex without further packages
};

constexpr std::array kSigns{Sign{"\u00b1", "$\\pm$"},     Sign{"\u2300", "\\O{}"},       Sign{"\u00b0", "$^\\circ$"},
                            Sign{"\u00b5", "$\\mu$"},     Sign{"\u00d7", "$\\times$"},   Sign{"\u00b7", "$\\cdot$"},
                            Sign{"\u00b2", "$^2$"},       Sign{"\u00b3", "$^3$"},        Sign{"\u2212", "$-$"},
                            Sign{"\u2013", "--"},         Sign{"\u2014", "---"},         Sign{"\u2018", "`"},
                            Sign{"\u2019", "'"},          Sign{"\u201c", "``"},          Sign{"\u201d", "''"},
                            Sign{"\u2026", "\\ldots{}"},  Sign{"\u00a0", "~"},           Sign{"\u202f", "\\,"},
                            Sign{"\u2264", "$\\leq$"},    Sign{"\u2265", "$\\geq$"},     Sign{"\u221e", "$\\infty$"},
                            Sign{"\u03b1", "$\\alpha$"},  Sign{"\u03b2", "$\\beta$"},    Sign{"\u03b3", "$\\gamma$"},
                            Sign{"\u03b4", "$\\delta$"},  Sign{"\u03b5", "$\\epsilon$"}, Sign{"\u03b8", "$\\theta$"},
                            Sign{"\u03bb", "$\\lambda$"}, Sign{"\u03bc", "$\\mu$"},      Sign{"\u03c0", "$\\pi$"},
                            Sign{"\u03c3", "$\\sigma$"},  Sign{"\u03c6", "$\\phi$"},     Sign{"\u03c8", "$\\psi$"},
                            Sign{"\u03c9", "$\\omega$"},  Sign{"\u0394", "$\\Delta$"}};

/// The widths of the ASCII characters from the blank to "~", in tenths of a point, in Computer Modern Roman of 8
/// points. A character that is escaped has the width of what its command prints.
constexpr std::array kWidths{29, 24, 43, 71, 43, 71, 67, 24, 34, 34, 43, 67, 24, 29, 24, 43, 43, 43, 43,
                             43, 43, 43, 43, 43, 43, 43, 24, 24, 67, 67, 67, 41, 67, 64, 61, 62, 65, 58,
                             56, 67, 64, 31, 44, 67, 54, 78, 64, 67, 58, 67, 63, 48, 62, 64, 64, 88, 64,
                             64, 52, 24, 43, 24, 43, 31, 24, 43, 48, 38, 48, 38, 26, 43, 48, 24, 26, 45,
                             24, 71, 48, 43, 48, 45, 34, 34, 34, 48, 45, 62, 45, 45, 38, 43, 24, 43, 43};
/// Largest width of a sign in kSigns, in points; also used for letters beyond ASCII.
constexpr double kWidestSign = 8.6;
constexpr double kMinusWidth = 6.7;  ///< width of a minus sign in mathematics, points
constexpr double kTimesTen = 19.4;   ///< width of "\times10" with its spaces, points
constexpr double kExponentSign = 5.8;
constexpr double kExponentDigit = 3.7;

/// A character in LaTeX.
struct Glyph {
  std::string code;  ///< LaTeX code
  double width;      ///< width in points
};

Glyph ascii_glyph(char c) {
  const std::string_view instead = escaped(c);
  const std::size_t at = static_cast<unsigned char>(c) - std::size_t{' '};
  return {instead.empty() ? std::string(1, c) : std::string(instead),
          at < kWidths.size() ? kWidths[at] / 10.0 : kWidestSign};
}

/// A character beyond ASCII. A letter of Latin alphabets stays unchanged, because LaTeX reads UTF-8. A sign becomes its
/// command, and a sign of a drawing becomes its word. All others become "?", because pdflatex refuses them.
Glyph glyph_beyond_ascii(std::string_view character) {
  const auto known = std::ranges::find(kSigns, character, &Sign::sign);
  if (known != kSigns.end()) return {std::string(known->latex), kWidestSign};
  const auto zone = std::ranges::find(zone_traits(), character, &ZoneTraits::sign);
  if (zone != zone_traits().end()) return {latex_text(zone->key), latex_width(zone->key)};
  const bool is_latin = character >= std::string_view("\u00c0") && character <= std::string_view("\u017f");
  return is_latin ? Glyph{std::string(character), kWidestSign} : ascii_glyph('?');
}

/// Calls `use` with each Glyph of a text.
template <class Use>
void for_each_glyph(std::string_view text, const Use& use) {
  const std::string line = printable_line(text);
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t length = std::max<std::size_t>(character_length(std::string_view(line).substr(at)), 1);
    const std::string_view character = std::string_view(line).substr(at, length);
    use(length > 1 ? glyph_beyond_ascii(character) : ascii_glyph(character.front()));
    at += length;
  }
}

}  // namespace

std::string latex_text(std::string_view text) {
  std::string all;
  for_each_glyph(text, [&](const Glyph& glyph) { all += glyph.code; });
  return all;
}

double latex_width(std::string_view text) {
  double width = 0.0;
  for_each_glyph(text, [&](const Glyph& glyph) { width += glyph.width; });
  return width;
}

std::string latex_unit(const std::string& unit) {
  std::string text;
  for (const char c : unit) text += c == ' ' ? "\\," : escaped(c).empty() ? std::string(1, c) : std::string(escaped(c));
  const bool is_micro = text.size() > 1 && text[0] == 'u' && (text[1] == 'm' || text[1] == 'J');
  return is_micro ? "$\\mu$" + text.substr(1) : text;
}

std::optional<std::string> latex_number(const std::string& text) {
  std::string digits = text;
  std::erase(digits, ' ');
  const std::string bare = digits.starts_with('+') ? digits.substr(1) : digits;
  if (!parse_number(bare)) return std::nullopt;
  const std::size_t e = digits.find_first_of("eE");
  if (e != std::string::npos) {
    const std::string power = std::to_string(std::stoi(digits.substr(e + 1)));
    return "$" + digits.substr(0, e) + "\\times10^{" + power + "}$";
  }
  std::string grouped;
  for (const char c : text) grouped += c == ' ' ? "\\," : std::string(1, c);
  return "$" + grouped + "$";
}

double latex_number_width(std::string_view number) {
  const std::size_t e = std::min(number.find_first_of("eE"), number.size());
  double width = latex_width(number.substr(0, e));
  if (number.starts_with('-') || number.starts_with('+')) width += kMinusWidth - latex_width(number.substr(0, 1));
  if (e == number.size()) return width;
  const std::string power = std::to_string(std::stoi(std::string(number.substr(e + 1))));
  const double sign = power.starts_with('-') ? kExponentSign - kExponentDigit : 0.0;
  return width + kTimesTen + sign + kExponentDigit * static_cast<double>(power.size());
}

}  // namespace poesy
