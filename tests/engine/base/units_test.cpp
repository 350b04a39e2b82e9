#include "engine/base/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "engine/base/readable_line.h"
#include "engine/base/text.h"

namespace poesy {
namespace {

/// What parse_quantity() says of a text; empty when it takes it.
std::string refusal(std::string_view text, std::optional<Dimension> wanted = std::nullopt) {
  try {
    parse_quantity(text, wanted);
    return {};
  } catch (const QuantityError& error) {
    return error.what();
  }
}

TEST(Units, HaveTheSizesOfTheSi) {
  const double degree = std::numbers::pi / 180.0;
  const std::pair<std::string_view, double> sizes[]{
      {"1 m", 1.0},        {"1 cm", 0.01},    {"1 mm", 1e-3},        {"1 um", 1e-6},          {"1 rad", 1.0},
      {"1 mrad", 1e-3},    {"1 deg", degree}, {"60 arcmin", degree}, {"3600 arcsec", degree}, {"1 s", 1.0},
      {"1 ms", 1e-3},      {"1 min", 60.0},   {"1 h", 3600.0},       {"1 in", 0.0254},        {"1 mil", 2.54e-5},
      {"1 thou", 2.54e-5}, {"1 N", 1.0},      {"1 kN", 1e3},         {"1 N m", 1.0},          {"1 N mm", 1e-3},
      {"1 kN m", 1e3},     {"1 J", 1.0},      {"1 mJ", 1e-3},        {"1 uJ", 1e-6}};
  EXPECT_EQ(std::size(sizes), units().size());
  for (const auto& [text, si] : sizes) EXPECT_DOUBLE_EQ(parse_quantity(text).si, si) << text;
}

TEST(Units, MayHaveAnotherSpelling) {
  for (const std::string_view micrometre : {"7 \xC2\xB5m", "7 \xCE\xBCm", "7\xC2\xB5m"}) {
    EXPECT_EQ(parse_quantity(micrometre).si, parse_quantity("7 um").si);
    EXPECT_EQ(parse_quantity(micrometre).dimension, Dimension::length);
  }
  EXPECT_EQ(parse_quantity("-0.5\xC2\xB0").si, parse_quantity("-0.5 deg").si);
  EXPECT_EQ(parse_quantity("2 inch").si, parse_quantity("2 in").si);
  EXPECT_EQ(parse_quantity("-0.5 \xC2\xB0").dimension, Dimension::angle);
  for (const std::string_view microjoule : {"7 \xC2\xB5J", "7 \xCE\xBCJ"}) {
    EXPECT_EQ(parse_quantity(microjoule).si, parse_quantity("7 uJ").si);
  }
}

TEST(Units, MayHoldABlank) {
  for (const std::string_view text : {"2 N m", "2N m", " 2000 N mm ", "0.002 kN m"}) {
    EXPECT_DOUBLE_EQ(parse_quantity(text).si, 2.0) << text;
    EXPECT_EQ(parse_quantity(text).dimension, Dimension::moment) << text;
  }
  EXPECT_EQ(refusal("2 Nm", Dimension::moment), "unknown unit 'Nm' in '2 Nm' (known: N m, N mm, kN m)");
  EXPECT_EQ(refusal("2 N s", Dimension::force), "unknown unit 'N s' in '2 N s' (known: N, kN)");
}

TEST(Dimensions, HaveWordsAndAUnitOfTheSi) {
  const std::string_view names[]{"a length", "an angle", "a time", "a number", "a force", "a moment", "an energy"};
  ASSERT_EQ(all_dimensions().size(), std::size(names));
  for (std::size_t d = 0; d < std::size(names); ++d) {
    const Dimension dimension = all_dimensions()[d];
    EXPECT_EQ(static_cast<std::size_t>(dimension), d);
    EXPECT_EQ(with_article(dimension), names[d]);
    EXPECT_EQ(dimension_of(si_unit(dimension)), dimension);
    EXPECT_EQ(display_unit(dimension).dimension, dimension);
    if (dimension == Dimension::number) continue;
    EXPECT_EQ(parse_quantity(to_text({0.3, dimension})).si, 0.3);
  }
}

TEST(Dimensions, OfALineAreReadInTheUnitsThatPeopleUse) {
  EXPECT_EQ(with_readable_quantities("limits.tip = \"0.00015 m\""), "limits.tip = \"0.15 mm\"");
  EXPECT_EQ(with_readable_quantities("[\"-2e-04 m\", \"name\"]"), "[\"-0.2 mm\", \"name\"]");
  EXPECT_EQ(with_readable_quantities("title = \"open"), "title = \"open");
  using TwoLines = std::pair<std::string, std::string>;
  EXPECT_EQ(with_readable_quantities(TwoLines("\"0.0001 m\"", "\"0.0002 m\"")), TwoLines("\"0.1 mm\"", "\"0.2 mm\""));
  const TwoLines alike("\"0.0001 m\"", "\"0.00010000000000000002 m\"");
  EXPECT_EQ(with_readable_quantities(alike), alike);
}

TEST(Dimensions, AreReadInTheUnitsThatPeopleUse) {
  EXPECT_EQ(readable_text({0.08, Dimension::length}), "80 mm");
  EXPECT_EQ(readable_text({-5.0, Dimension::force}), "-5 N");
  EXPECT_EQ(readable_text({0.25, Dimension::moment}), "0.25 N m");
  EXPECT_EQ(readable_text({3e-7, Dimension::energy}), "3e-07 J");
  EXPECT_EQ(readable_text({250.0, Dimension::energy}), "250 J");
}

TEST(Units, AreListedForOneDimension) {
  EXPECT_EQ(unit_names(Dimension::length), "m, cm, mm, um, in, mil, thou");
  EXPECT_EQ(unit_names(Dimension::angle), "rad, mrad, deg, arcmin, arcsec");
  EXPECT_EQ(unit_names(Dimension::moment), "N m, N mm, kN m");
  EXPECT_EQ(unit_names(),
            "m, cm, mm, um, in, mil, thou, rad, mrad, deg, arcmin, arcsec, s, ms, min, h, "
            "N, kN, N m, N mm, kN m, J, mJ, uJ");
  EXPECT_EQ(refusal("8 furlong", Dimension::length),
            "unknown unit 'furlong' in '8 furlong' (known: m, cm, mm, um, in, mil, thou)");
  EXPECT_EQ(refusal("8", Dimension::angle), "'8' has no unit (known: rad, mrad, deg, arcmin, arcsec)");
}

TEST(ParseQuantity, NamesADecimalComma) {
  for (const std::string_view text : {"0,08 m", "1,5mm", "-3,25 deg"}) {
    EXPECT_NE(refusal(text).find("decimal comma; write a decimal point"), std::string::npos) << refusal(text);
  }
  EXPECT_EQ(refusal("1, mm").find("comma"), std::string::npos);
}

TEST(ParseQuantity, TellsTooSmallFromTooLarge) {
  for (const std::string_view text : {"1e-999 mm", "-1E-999 mm", "+3e-400 rad"}) {
    EXPECT_NE(refusal(text).find("is too small to be told from 0"), std::string::npos) << refusal(text);
  }
  const std::string tiny = "0." + std::string(400, '0') + "1 mm";
  EXPECT_NE(refusal(tiny).find("is too small"), std::string::npos);
  for (const std::string& text :
       {std::string("1e999 mm"), std::string("-1e+999 mm"), std::string(400, '7').append(" mm")}) {
    EXPECT_NE(refusal(text).find("too large"), std::string::npos) << refusal(text);
  }
  for (const std::string_view text : {"nan mm", "inf mm", "left", ""}) {
    EXPECT_NE(refusal(text).find("is not a finite number"), std::string::npos) << refusal(text);
  }
}

TEST(NumberProblem, SaysWhatParseNumberRefuses) {
  const std::pair<std::string_view, std::string_view> problems[]{
      {"1e-999", "is too small to be told from 0"},
      {"1e999", "is not a finite number, because it is too large"},
      {"0,5", "has a decimal comma; write a decimal point"},
      {"nan", "is not a finite number"},
      {"1x", "is not a finite number"}};
  for (const auto& [text, problem] : problems) {
    EXPECT_FALSE(parse_number(text)) << text;
    EXPECT_EQ(number_problem(text), problem) << text;
  }
}

TEST(LowerCase, ChangesCapitalsOfAsciiAlone) {
  EXPECT_EQ(lower_case("2UPR-RPU [@`{"), "2upr-rpu [@`{");
  EXPECT_EQ(lower_case("\xC3\x84Z"), "\xC3\x84z");  // a letter beyond ASCII keeps its bytes
}

}  // namespace
}  // namespace poesy
