#include "models/file/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace poesy::file {
namespace {

const std::vector<GeometryParameter> kParameters{{"a", Dimension::length, 0.0, ""},
                                                 {"h", Dimension::length, 0.0, ""},
                                                 {"zero", Dimension::length, 0.0, ""},
                                                 {"tilt", Dimension::angle, 0.0, ""}};
const std::vector<double> kValues{0.25, 0.6, 0.0, 0.1};

Value of(const std::string& text) {
  return evaluate({text, "platform.origin[2]", {"m.toml", 3, 10}, true}, kParameters, kValues);
}

std::string problem_of(const std::string& text) {
  try {
    of(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

TEST(Expression, Lengths) {
  for (const auto& [text, si] :
       std::vector<std::pair<const char*, double>>{{"a", 0.25},
                                                   {"250 mm", 0.25},
                                                   {" - ( a+20mm ) ", -0.27},
                                                   {"2 * a - h / 3", 0.3},
                                                   {"sqrt(a * a + h*h)", std::hypot(0.25, 0.6)},
                                                   {"a * sin(30 deg)", 0.125},
                                                   {"a * cos(pi / 3)", 0.125},
                                                   {"a * tan(tilt)", 0.25 * std::tan(0.1)},
                                                   {"h * a / (a + 0)", 0.6},
                                                   {"1e3 um", 1e-3},
                                                   {"10 \xC2\xB5m", 1e-5},
                                                   {"a - -a", 0.5},
                                                   {"h - a - a", 0.1},
                                                   {"h / 2 / 3 * 6", 0.6},
                                                   {"zero", 0.0}}) {
    const Value value = of(text);
    EXPECT_NEAR(value.si, si, 1e-16) << text;
    EXPECT_EQ(dimension_text(value), "a length") << text;
  }
}

TEST(Expression, OtherDimensions) {
  EXPECT_EQ(dimension_text(of("atan2(a, h) + 10 deg - tilt")), "an angle");
  EXPECT_NEAR(of("atan2(a, h)").si, std::atan2(0.25, 0.6), 1e-16);
  EXPECT_NEAR(of("180 deg").si, std::numbers::pi, 1e-15);
  EXPECT_EQ(dimension_text(of("a / h + 1")), "a number");
  EXPECT_EQ(dimension_text(of("a * h")), "length^2");
  EXPECT_EQ(dimension_text(of("tilt / a")), "length^-1 angle");
}

TEST(Expression, BareZeroIsAnyQuantity) {
  for (const char* text : {"0", "0.0", "-0", "0 * 3", "(0)", "sqrt(0)"}) EXPECT_TRUE(of(text).any) << text;
  EXPECT_FALSE(of("0 mm").any);
  EXPECT_EQ(dimension_text(of("0 + a")), "a length");
  EXPECT_EQ(dimension_text(of("a + 0 - 0")), "a length");
}

/// The column is that of the mistake inside the expression, whose quotation mark is at column 10.
TEST(Expression, Mistakes) {
  for (const auto& [text, begin] : std::vector<std::pair<const char*, const char*>>{
           {"a + tilt", "m.toml:3:13: platform.origin[2] 'a + tilt' adds a length and an angle; both must have"},
           {"zero - 1 deg", "m.toml:3:16: platform.origin[2] 'zero - 1 deg' subtracts a length and an angle; "},
           {"a + 20", "m.toml:3:13: platform.origin[2] 'a + 20' adds a length and a number; both must have one"},
           {"a + b", "m.toml:3:15: platform.origin[2] 'a + b' has an unknown parameter 'b'; known: a, h, "},
           {"tild", "m.toml:3:11: platform.origin[2] 'tild' has an unknown parameter 'tild'; did you mean 'tilt'?"},
           {"20 mn", "m.toml:3:14: platform.origin[2] '20 mn' has an unknown unit 'mn'; known: m, cm, "},
           {"2 h", "m.toml:3:13: platform.origin[2] '2 h' has an unknown unit 'h'; known: "},
           {"sin(a)", "m.toml:3:11: platform.origin[2] 'sin(a)' takes sin of a length; give it an angle"},
           {"sqrt(a)", "m.toml:3:11: platform.origin[2] 'sqrt(a)' takes the root of a length; the root of a square"},
           {"atan2(a, tilt)",
            "m.toml:3:11: platform.origin[2] 'atan2(a, tilt)' takes atan2 of a length and an angle; "},
           {"atan2(a)", "m.toml:3:18: platform.origin[2] 'atan2(a)' cannot be read at ')'; write numbers"},
           {"a +", "m.toml:3:14: platform.origin[2] 'a +' ends too early; write numbers"},
           {"", "m.toml:3:11: platform.origin[2] '' ends too early; "},
           {"(a", "m.toml:3:13: platform.origin[2] '(a' ends too early; "},
           {"a)", "m.toml:3:12: platform.origin[2] 'a)' cannot be read at ')'; "},
           {"a ^ 2", "m.toml:3:13: platform.origin[2] 'a ^ 2' cannot be read at '^ 2'; "},
           {"1e-999 mm", "m.toml:3:11: platform.origin[2] '1e-999 mm' has a number that is out of range; "},
           {"1e999 mm", "m.toml:3:11: platform.origin[2] '1e999 mm' has a number that is out of range; "},
           {"a / 0", "m.toml:3:11: platform.origin[2] 'a / 0' is not finite; look for a division by zero"},
           {"sqrt(a*a - h*h)", "m.toml:3:11: platform.origin[2] 'sqrt(a*a - h*h)' is not finite; "}}) {
    EXPECT_EQ(problem_of(text).substr(0, std::string(begin).size()), begin);
  }
  EXPECT_NE(problem_of(std::string(2000, '(')).find("longer than 1000 bytes"), std::string::npos);
}

TEST(Expression, DimensionThatIsDue) {
  const Expression bare{"250", "geometry.a", {"m.toml", 7, 5}, false};
  EXPECT_THROW(evaluate(bare, Dimension::length, {}, {}), InputError);
  EXPECT_EQ(evaluate(bare, Dimension::number, {}, {}), 250.0);
  EXPECT_EQ(evaluate({"0", "x", {}, false}, Dimension::length, {}, {}), 0.0);
}

}  // namespace
}  // namespace poesy::file
