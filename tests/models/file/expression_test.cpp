#include "models/file/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace poesy::file {
namespace {

const std::vector<GeometryParameter> kParameters{{"a", Dimension::length, 0.25, ""},
                                                 {"h", Dimension::length, 0.6, ""},
                                                 {"zero", Dimension::length, 0.0, ""},
                                                 {"tilt", Dimension::angle, 0.1, ""}};
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
  EXPECT_EQ(dimension_text(of("atan(a/h) + tilt")), "an angle");
  EXPECT_DOUBLE_EQ(of("atan(a/h)").si, of("atan2(a, h)").si);
  EXPECT_NEAR(of("atan2(a, h)").si, std::atan2(0.25, 0.6), 1e-16);
  EXPECT_NEAR(of("180 deg").si, std::numbers::pi, 1e-15);
  EXPECT_EQ(dimension_text(of("a / h + 1")), "a number");
  EXPECT_EQ(dimension_text(of("a * h")), "length^2");
  EXPECT_EQ(dimension_text(of("tilt / a")), "length^-1 angle");
}

TEST(Expression, TakesComputedNumbersAsRadians) {
  EXPECT_DOUBLE_EQ(of("cos(a/(3 mm))").si, std::cos(of("a").si / 3e-3));
  EXPECT_NEAR(of("cos(6*pi)").si, 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(of("cos(0.5 rad)").si, std::cos(0.5));
}

TEST(Expression, BareZeroIsAnyQuantity) {
  for (const char* text : {"0", "0.0", "-0", "0 * 3", "(0)", "sqrt(0)"}) EXPECT_TRUE(of(text).any) << text;
  EXPECT_FALSE(of("0 mm").any);
  EXPECT_EQ(dimension_text(of("0 + a")), "a length");
  EXPECT_EQ(dimension_text(of("a + 0 - 0")), "a length");
}

/// The messages name the column of the mistake. The opening quotation mark of the expression is at column 10.
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
           {"a*cos(-30)",
            "m.toml:3:13: platform.origin[2] 'a*cos(-30)' takes cos of -30 without a unit; write cos(-30 deg), or "
            "cos(-30 rad)"},
           {"a*cos(0.5)", "m.toml:3:13: platform.origin[2] 'a*cos(0.5)' takes cos of 0.5 without a unit; "},
           {"a*cos( 22.5 )", "m.toml:3:13: platform.origin[2] 'a*cos( 22.5 )' takes cos of 22.5 without a unit; "},
           {"sind(30)", "m.toml:3:11: platform.origin[2] 'sind(30)' has an unknown function 'sind'; write sin of a "},
           {"sqrt(a)",
            "m.toml:3:11: platform.origin[2] 'sqrt(a)' takes the root of a length; take the root of a square"},
           {"atan(a)", "m.toml:3:11: platform.origin[2] 'atan(a)' takes atan of a length; give it a number, e.g. a/b"},
           {"atan2(a, tilt)",
            "m.toml:3:11: platform.origin[2] 'atan2(a, tilt)' takes atan2 of a length and an angle; "},
           {"atan2(a)", "m.toml:3:18: platform.origin[2] 'atan2(a)' cannot be read at ')'; write numbers"},
           {"a +", "m.toml:3:14: platform.origin[2] 'a +' ends too early; write numbers"},
           {"", "m.toml:3:11: platform.origin[2] '' ends too early; "},
           {"(a", "m.toml:3:13: platform.origin[2] '(a' ends too early; "},
           {"a)", "m.toml:3:12: platform.origin[2] 'a)' cannot be read at ')'; "},
           {"a ^ tilt",
            "m.toml:3:15: platform.origin[2] 'a ^ tilt' has an exponent that is not a whole number from -12 "},
           {"a^0.5",
            "m.toml:3:13: platform.origin[2] 'a^0.5' has an exponent that is not a whole number from -12 to 12; "},
           {"a^13",
            "m.toml:3:13: platform.origin[2] 'a^13' has an exponent that is not a whole number from -12 to 12; "},
           {"a^2^3", "m.toml:3:14: platform.origin[2] 'a^2^3' cannot be read at '^3'; "},
           {"((a^12)^12)", "m.toml:3:18: platform.origin[2] '((a^12)^12)' has a dimension that nothing has; "},
           {"a^2 + a", "m.toml:3:15: platform.origin[2] 'a^2 + a' adds length^2 and a length; "},
           {"0 ^ -1", "m.toml:3:11: platform.origin[2] '0 ^ -1' is not finite; "},
           {"5 mm^3", "m.toml:3:13: platform.origin[2] '5 mm^3' has an unknown unit 'mm^3'; write the power of a "},
           {"5 mm ^ -1 + a", "m.toml:3:13: platform.origin[2] '5 mm ^ -1 + a' has an unknown unit 'mm ^ -1'; write "},
           {"5 N m + a", "m.toml:3:17: platform.origin[2] '5 N m + a' adds a moment and a length; "},
           {"2 m / s^2", "m.toml:3:17: platform.origin[2] '2 m / s^2' has an unknown parameter 's'; "},
           {"sin(5 N)", "m.toml:3:11: platform.origin[2] 'sin(5 N)' takes sin of a force; "},
           {"1e-999 mm", "m.toml:3:11: platform.origin[2] '1e-999 mm' has a number that is out of range; "},
           {"1e999 mm", "m.toml:3:11: platform.origin[2] '1e999 mm' has a number that is out of range; "},
           {"a / 0", "m.toml:3:11: platform.origin[2] 'a / 0' is not finite; look for a division by zero"},
           {"sqrt(a*a - h*h)", "m.toml:3:11: platform.origin[2] 'sqrt(a*a - h*h)' is not finite; "}}) {
    EXPECT_EQ(problem_of(text).substr(0, std::string(begin).size()), begin);
  }
  EXPECT_NE(problem_of(std::string(2000, '(')).find("longer than 1000 bytes"), std::string::npos);
}

TEST(Expression, NamesTheChangedParametersIfItIsNotFinite) {
  const Expression leg{"sqrt(h*h - a*a)", "platform.origin[2]", {"m.toml", 3, 10}, true};
  try {
    evaluate(leg, kParameters, std::vector{250.0, 0.6, 0.0, 0.1});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "m.toml:3:11: platform.origin[2] 'sqrt(h*h - a*a)' is not finite with a = 250000 mm (the file has 250 "
                 "mm); look for a division by zero or the root of a negative number");
  }
}

TEST(Expression, DimensionThatIsDue) {
  const Expression bare{"250", "geometry.a", {"m.toml", 7, 5}, false};
  EXPECT_THROW(evaluate(bare, Dimension::length, {}, {}), InputError);
  EXPECT_EQ(evaluate(bare, Dimension::number, {}, {}), 250.0);
  EXPECT_EQ(evaluate({"0", "x", {}, false}, Dimension::length, {}, {}), 0.0);
}

TEST(Expression, Powers) {
  for (const auto& [text, si] : std::vector<std::pair<const char*, double>>{{"a^2", 0.0625},
                                                                            {"-a^2", -0.0625},
                                                                            {"(-a)^2", 0.0625},
                                                                            {"2 * a^2", 0.125},
                                                                            {"2*a ^ 2", 0.125},
                                                                            {"a^3 / a", 0.0625},
                                                                            {"a * h^0 * a", 0.0625},
                                                                            {"1 / a^-2", 0.0625},
                                                                            {"(5 mm)^2", 25e-6},
                                                                            {"5 mm^2", 5e-6},
                                                                            {"sqrt(a^4)", 0.0625}}) {
    const Value value = of(text);
    EXPECT_NEAR(value.si, si, 1e-16) << text;
    EXPECT_EQ(value.powers, kArea.powers) << text;
  }
  EXPECT_EQ(of("2^10").si, 1024.0);
  EXPECT_EQ(of("4^-1").si, 0.25);
  EXPECT_TRUE(of("0^2").any);
  EXPECT_FALSE(of("0^0").any);
  EXPECT_EQ(dimension_text(of("tilt^2")), "angle^2");
}

/// Each unit with its size in SI and its dimension.
TEST(Expression, UnitsOfMechanics) {
  const double degree = std::numbers::pi / 180.0;
  struct Case {
    const char* text;
    double si;
    Physical quantity;
  };
  for (const Case& one : {Case{"3 N", 3.0, kForce},
                          {"3 kN", 3e3, kForce},
                          {"3 N m", 3.0, kMoment},
                          {"3N  m", 3.0, kMoment},
                          {"3 N mm", 3e-3, kMoment},
                          {"3 kN m", 3e3, kMoment},
                          {"3 N/m", 3.0, kStiffness},
                          {"3 N/mm", 3e3, kStiffness},
                          {"3 N/um", 3e6, kStiffness},
                          {"3 N/\xC2\xB5m", 3e6, kStiffness},
                          {"3 kN/mm", 3e6, kStiffness},
                          {"3 N m/rad", 3.0, kRotationalStiffness},
                          {"3 kN m/rad", 3e3, kRotationalStiffness},
                          {"3 N m/mrad", 3e3, kRotationalStiffness},
                          {"3 N m/deg", 3.0 / degree, kRotationalStiffness},
                          {"3 N m/\xC2\xB0", 3.0 / degree, kRotationalStiffness},
                          {"3 N m/arcmin", 180.0 / degree, kRotationalStiffness},
                          {"3 Pa", 3.0, kModulus},
                          {"3 kPa", 3e3, kModulus},
                          {"3 MPa", 3e6, kModulus},
                          {"3 GPa", 3e9, kModulus},
                          {"3 mm^2", 3e-6, kArea},
                          {"3 cm^2", 3e-4, kArea},
                          {"3 m^2", 3.0, kArea},
                          {"3 mm^4", 3e-12, kAreaMoment},
                          {"3 cm^4", 3e-8, kAreaMoment},
                          {"3 m^4", 3.0, kAreaMoment},
                          {"3 kg", 3.0, kMass},
                          {"3 g", 3e-3, kMass},
                          {"3 m/s^2", 3.0, kAcceleration}}) {
    const Value value = of(one.text);
    EXPECT_DOUBLE_EQ(value.si, one.si) << one.text;
    EXPECT_EQ(value.powers, one.quantity.powers) << one.text;
  }
}

TEST(Expression, ProductsOfMechanics) {
  const auto is = [](const char* text, const Physical& wanted) {
    return evaluate({text, "limb[0].links[0].E", {}, true}, wanted, kParameters, kValues);
  };
  EXPECT_NEAR(is("pi * (8 mm)^4 / 64", kAreaMoment), std::numbers::pi * std::pow(8e-3, 4) / 64.0, 1e-24);
  EXPECT_NEAR(is("210 GPa * 50 mm^2 / a", kStiffness), 4.2e7, 1e-7);
  EXPECT_DOUBLE_EQ(is("3 * 210 GPa * 50 mm^2 * a", kMoment), 7.875e6);
  EXPECT_EQ(is("9000 N m", kRotationalStiffness), 9000.0);
  EXPECT_EQ(is("9000 N m/rad * 0.5", kMoment), 4500.0);
  EXPECT_DOUBLE_EQ(is("9000 N m/rad * tilt / a", kForce), 3600.0);
  EXPECT_DOUBLE_EQ(is("0.25 kg * 9.81 m/s^2 + 1 N", kForce), 3.4525);
  EXPECT_DOUBLE_EQ(is("a * tilt", kLength), 0.025);
  EXPECT_EQ(is("0", kStiffness), 0.0);
  EXPECT_EQ(dimension_text(of("sqrt(9000 N m/rad / (1 kg * a^2))")), "s^-1");
}

TEST(Expression, NamesOfDimensions) {
  for (const auto& [text, name] :
       std::vector<std::pair<const char*, const char*>>{{"2 kN", "a force"},
                                                        {"2 N * a", "a moment"},
                                                        {"2 N / a", "a stiffness"},
                                                        {"2 N m / (1 rad)", "a rotational stiffness"},
                                                        {"2 N / a^2", "a modulus"},
                                                        {"2 g", "a mass"},
                                                        {"2 N / (1 kg)", "an acceleration"},
                                                        {"2 N * 1 kg", "kg^2 m s^-2"},
                                                        {"2 N * tilt", "kg m s^-2 rad"},
                                                        {"2 mm^2 * 1 deg", "length^2 angle"}}) {
    EXPECT_EQ(dimension_text(of(text)), name) << text;
  }
}

/// After a number, a name is a unit, even if a parameter has the same name. Elsewhere it is the parameter.
TEST(Expression, ParametersMayHaveTheNamesOfOtherUnits) {
  const std::vector<GeometryParameter> parameters{{"g", Dimension::length, 0.0, ""},
                                                  {"s", Dimension::length, 0.0, ""},
                                                  {"N", Dimension::length, 0.0, ""},
                                                  {"kg", Dimension::length, 0.0, ""}};
  const auto si = [&](const char* text, const Physical& wanted) {
    return evaluate({text, "x", {}, true}, wanted, parameters, std::vector{0.5, 0.25, 2.0, 4.0});
  };
  EXPECT_EQ(si("2 g", kMass), 2e-3);
  EXPECT_EQ(si("2 * g", kLength), 1.0);
  EXPECT_EQ(si("g + s + N + kg", kLength), 6.75);
  EXPECT_EQ(si("2 m / s", kNumber), 8.0);
  EXPECT_EQ(si("2 m/s", kNumber), 8.0);
  EXPECT_EQ(si("2 m/s^2", kAcceleration), 2.0);
  EXPECT_EQ(si("2 m / s^2 * s", kNumber), 8.0);
  EXPECT_EQ(si("2 N/s", {"", {.mass = 1, .time = -2}, "", ""}), 8.0);
  for (const char* name : {"g", "s", "h", "min", "N", "kN", "J", "Pa", "kg", "k"}) {
    EXPECT_EQ(why_no_parameter(name), "") << name;
  }
  for (const char* name : {"m", "mm", "in", "rad", "deg"}) EXPECT_EQ(why_no_parameter(name), "is a unit") << name;
}

TEST(Expression, QuantityThatIsDue) {
  const auto refusal = [](const char* text, const Physical& wanted) -> std::string {
    try {
      evaluate({text, "E", {"m.toml", 7, 5}, true}, wanted, kParameters, kValues);
    } catch (const InputError& error) {
      return error.what();
    }
    return "read";
  };
  EXPECT_EQ(refusal("a", kStiffness),
            "m.toml:7:5: E 'a' is a length, but must be a stiffness (N/m); write it like \"20 N/um\"");
  EXPECT_EQ(refusal("130", kModulus),
            "m.toml:7:5: E '130' is a number, but must be a modulus (Pa); give it a unit, e.g. \"210 GPa\"");
  EXPECT_EQ(refusal("5 mm", kArea),
            "m.toml:7:5: E '5 mm' is a length, but must be an area (mm^2); write it like \"50 mm^2\"");
  EXPECT_EQ(refusal("5 N", kAngle),
            "m.toml:7:5: E '5 N' is a force, but must be an angle; correct the expression or its unit");
  EXPECT_EQ(refusal("tilt", kNumber),
            "m.toml:7:5: E 'tilt' is an angle, but must be a number; correct the expression or its unit");
  const std::string unknown = refusal("5 lbf", kForce);
  EXPECT_NE(unknown.find("unknown unit 'lbf'; known: m, cm, mm, "), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("arcsec, N, kN, N m, N mm, kN m, N/m, "), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("g, m/s^2; write * to multiply"), std::string::npos) << unknown;
}

TEST(Physical, OfADimensionOfTheEngine) {
  for (const Dimension dimension : all_dimensions()) EXPECT_EQ(physical(dimension).name, with_article(dimension));
  EXPECT_EQ(of_dimension(2.0, Dimension::force).powers, kForce.powers);
  EXPECT_TRUE(of_dimension(2.0, Dimension::energy).like(of_dimension(1.0, Dimension::moment)));
  EXPECT_FALSE(of_dimension(2.0, Dimension::angle).like(of_dimension(1.0, Dimension::number)));
}

}  // namespace
}  // namespace poesy::file
