#include "engine/fits/it_grade.h"

#include <array>
#include <cstddef>

namespace poesy {
namespace {

constexpr std::size_t kTabulated = 13;  // number of grades in the table: IT01 to IT11
constexpr std::size_t kFive = 5;        // grades from IT12 on: ten times the width of the grade five steps finer

/// The widths of the tolerance zones for sizes up to and including `up_to`.
struct SizeStep {
  double up_to;                               ///< largest nominal size, mm
  std::array<double, kTabulated> micrometre;  ///< widths for IT01, IT0, IT1, ..., IT11; 0 if there is none
};

constexpr std::array<SizeStep, 21> kSteps{{{3, {0.3, 0.5, 0.8, 1.2, 2, 3, 4, 6, 10, 14, 25, 40, 60}},
                                           {6, {0.4, 0.6, 1, 1.5, 2.5, 4, 5, 8, 12, 18, 30, 48, 75}},
                                           {10, {0.4, 0.6, 1, 1.5, 2.5, 4, 6, 9, 15, 22, 36, 58, 90}},
                                           {18, {0.5, 0.8, 1.2, 2, 3, 5, 8, 11, 18, 27, 43, 70, 110}},
                                           {30, {0.6, 1, 1.5, 2.5, 4, 6, 9, 13, 21, 33, 52, 84, 130}},
                                           {50, {0.6, 1, 1.5, 2.5, 4, 7, 11, 16, 25, 39, 62, 100, 160}},
                                           {80, {0.8, 1.2, 2, 3, 5, 8, 13, 19, 30, 46, 74, 120, 190}},
                                           {120, {1, 1.5, 2.5, 4, 6, 10, 15, 22, 35, 54, 87, 140, 220}},
                                           {180, {1.2, 2, 3.5, 5, 8, 12, 18, 25, 40, 63, 100, 160, 250}},
                                           {250, {2, 3, 4.5, 7, 10, 14, 20, 29, 46, 72, 115, 185, 290}},
                                           {315, {2.5, 4, 6, 8, 12, 16, 23, 32, 52, 81, 130, 210, 320}},
                                           {400, {3, 5, 7, 9, 13, 18, 25, 36, 57, 89, 140, 230, 360}},
                                           {500, {4, 6, 8, 10, 15, 20, 27, 40, 63, 97, 155, 250, 400}},
                                           {630, {0, 0, 9, 11, 16, 22, 32, 44, 70, 110, 175, 280, 440}},
                                           {800, {0, 0, 10, 13, 18, 25, 36, 50, 80, 125, 200, 320, 500}},
                                           {1000, {0, 0, 11, 15, 21, 28, 40, 56, 90, 140, 230, 360, 560}},
                                           {1250, {0, 0, 13, 18, 24, 33, 47, 66, 105, 165, 260, 420, 660}},
                                           {1600, {0, 0, 15, 21, 29, 39, 55, 78, 125, 195, 310, 500, 780}},
                                           {2000, {0, 0, 18, 25, 35, 46, 65, 92, 150, 230, 370, 600, 920}},
                                           {2500, {0, 0, 22, 30, 41, 55, 78, 110, 175, 280, 440, 700, 1100}},
                                           {3150, {0, 0, 26, 36, 50, 68, 96, 135, 210, 330, 540, 860, 1350}}}};

}  // namespace

std::string it_grade_name(ItGrade grade) {
  const int place = static_cast<int>(grade);
  return place == 0 ? "IT01" : "IT" + std::to_string(place - 1);
}

std::optional<double> it_grade_width(double nominal_size, ItGrade grade) {
  const double size = nominal_size * 1e3 * (1.0 - 1e-12);  // a size converted to m may be above a step by rounding
  if (!(size > 0.0) || (grade >= ItGrade::it14 && size <= 1.0)) return std::nullopt;
  auto place = static_cast<std::size_t>(grade);
  double micrometre = 1.0;
  for (; place >= kTabulated; place -= kFive) micrometre *= 10.0;
  for (const SizeStep& step : kSteps) {
    if (size > step.up_to) continue;
    if (step.micrometre[place] == 0.0) return std::nullopt;
    return step.micrometre[place] * micrometre / 1e6;
  }
  return std::nullopt;
}

}  // namespace poesy
