#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Texts and numbers in LaTeX, and their widths. Widths are in points of TeX (72.27 to the inch) and hold for Computer
/// Modern Roman of 8 points, the widest of the usual fonts of journals. Kerning is not counted.
namespace poesy {

/// A text for LaTeX (pdflatex without further packages). Characters with a meaning in LaTeX are escaped, signs such as
/// plus-minus become commands, and the symbols of tolerances on a drawing become words. Control characters, and letters
/// of other than Latin alphabets, become "?".
std::string latex_text(std::string_view text);
double latex_width(std::string_view text);  ///< The width of latex_text().

/// A unit in upright letters: "N\,m", "$\mu$m".
std::string latex_unit(const std::string& unit);

/// A number such as "-1.2e-05" in LaTeX's mathematics mode; none if the text is not a number. Groups of digits may be
/// separated by blanks.
std::optional<std::string> latex_number(const std::string& text);
/// The width of latex_number(). Precondition: `number` is a number.
double latex_number_width(std::string_view number);

}  // namespace poesy
