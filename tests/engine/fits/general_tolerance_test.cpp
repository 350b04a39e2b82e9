#include "engine/fits/general_tolerance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace poesy {
namespace {

/// A row of a printed table: the values (mm) for lengths above `up_to` of the row before, and at most `up_to` (mm). A
/// value of 0 means that the standard prints a dash.
struct PrintedRow {
  double up_to;
  std::vector<double> value;
};

void expect_value(std::optional<double> found, double printed, double length) {
  if (printed == 0.0) {
    EXPECT_FALSE(found) << length;
  } else {
    ASSERT_TRUE(found) << length;
    EXPECT_DOUBLE_EQ(*found, printed / 1e3) << length;
  }
}

/// Checks the table at both ends of the range of each row. least: where the first range begins (mm).
template <class Found>
void expect_table(const std::vector<PrintedRow>& table, double least, const Found& found) {
  double from = least;
  for (const PrintedRow& row : table) {
    for (std::size_t k = 0; k < row.value.size(); ++k) {
      for (const double length : {from * (1.0 + 1e-9), row.up_to})
        expect_value(found(length / 1e3, k), row.value[k], length);
    }
    from = row.up_to;
  }
  for (std::size_t k = 0; k < table.front().value.size(); ++k) {
    EXPECT_FALSE(found(from * (1.0 + 1e-9) / 1e3, k));
    EXPECT_FALSE(found(0.0, k));
  }
}

// ISO 2768-1:1989, Table 1 (mm). The columns are the classes f, m, c and v.
TEST(GeneralTolerances, OfLengthsAreThoseOfPartOne) {
  expect_table({{3, {0.05, 0.1, 0.2, 0}},
                {6, {0.05, 0.1, 0.3, 0.5}},
                {30, {0.1, 0.2, 0.5, 1}},
                {120, {0.15, 0.3, 0.8, 1.5}},
                {400, {0.2, 0.5, 1.2, 2.5}},
                {1000, {0.3, 0.8, 2, 4}},
                {2000, {0.5, 1.2, 3, 6}},
                {4000, {0, 2, 4, 8}}},
               0.5, [](double size, std::size_t k) { return general_length_tolerance(size, GeneralLengthClass(k)); });
  EXPECT_TRUE(general_length_tolerance(0.5e-3, GeneralLengthClass::f));
  EXPECT_FALSE(general_length_tolerance(0.49e-3, GeneralLengthClass::f));
}

// ISO 2768-2:1989, Tables 1 to 4 (mm). The columns are the classes H, K and L.
TEST(GeneralTolerances, OfZonesAreThoseOfPartTwo) {
  const auto zone = [](GeneralZone of) {
    return [of](double length, std::size_t k) { return general_zone(of, length, GeneralZoneClass(k)); };
  };
  expect_table({{10, {0.02, 0.05, 0.1}},
                {30, {0.05, 0.1, 0.2}},
                {100, {0.1, 0.2, 0.4}},
                {300, {0.2, 0.4, 0.8}},
                {1000, {0.3, 0.6, 1.2}},
                {3000, {0.4, 0.8, 1.6}}},
               1e-3, zone(GeneralZone::flatness));
  expect_table({{100, {0.2, 0.4, 0.6}}, {300, {0.3, 0.6, 1}}, {1000, {0.4, 0.8, 1.5}}, {3000, {0.5, 1, 2}}}, 1e-3,
               zone(GeneralZone::perpendicularity));
  expect_table({{100, {0.5, 0.6, 0.6}}, {300, {0.5, 0.6, 1}}, {1000, {0.5, 0.8, 1.5}}, {3000, {0.5, 1, 2}}}, 1e-3,
               zone(GeneralZone::symmetry));
  expect_table({{3000, {0.1, 0.2, 0.5}}}, 1e-3, zone(GeneralZone::runout));
}

/// A coarser class and a longer feature never have a smaller tolerance.
TEST(GeneralTolerances, Grow) {
  for (const GeneralZone zone :
       {GeneralZone::flatness, GeneralZone::perpendicularity, GeneralZone::symmetry, GeneralZone::runout}) {
    for (double length = 1e-3; length < 3.0; length *= 1.1) {
      const double H = general_zone(zone, length, GeneralZoneClass::H).value();
      const double K = general_zone(zone, length, GeneralZoneClass::K).value();
      EXPECT_LE(H, K);
      EXPECT_LE(K, general_zone(zone, length, GeneralZoneClass::L).value());
      EXPECT_LE(K, general_zone(zone, std::min(3.0, 1.1 * length), GeneralZoneClass::K).value());
    }
  }
}

}  // namespace
}  // namespace poesy
