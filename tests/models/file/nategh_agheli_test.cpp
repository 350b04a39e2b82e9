// Compares the 6-UPS of Nategh and Agheli 2009 and its 42 measured errors with displacements that others computed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "engine/base/sanitizers.h"
#include "engine/model/model.h"
#include "models/registry.h"

namespace poesy {
namespace {

const std::string kFolder = POESY_TEST_DATA "/../../results/gallery/6-ups/";
constexpr double kMillimetre = 1e-3;

const CatalogEntry& hexapod() {
  static const CatalogEntry entry = [] {
    std::ostringstream text;
    text << std::ifstream(kFolder + "6-ups.toml").rdbuf();
    return registry().from_text(text.str(), kFolder + "6-ups.toml");
  }();
  return entry;
}

/// [42] The measured errors (m) in the order of the model.
std::vector<double> measured() {
  std::ifstream file(kFolder + "measured.csv");
  std::string names, values, name, value;
  std::getline(file, names);
  std::getline(file, values);
  std::istringstream name_stream(names), value_stream(values);
  std::vector<double> errors(hexapod().description.factors.size());
  std::getline(name_stream, name, ',');
  std::getline(value_stream, value, ',');
  while (std::getline(name_stream, name, ',') && std::getline(value_stream, value, ',')) {
    const auto factor = hexapod().description.find_factor(name.substr(0, name.find(' ')));
    errors.at(factor.value().value) = std::stod(value) * kMillimetre;
  }
  return errors;
}

/// [responses x samples] The responses to errors [errors x samples] at a level pose. place: x, y, z (m).
std::vector<double> responses(Evaluator& evaluator, const std::array<double, 3>& place,
                              const std::vector<double>& errors) {
  const std::array<double, 6> pose{place[0], place[1], place[2], 0.0, 0.0, 0.0};
  const ModelDescription& model = hexapod().description;
  std::vector<FactorIndex> varied;
  for (std::size_t f = 0; f < model.factors.size(); ++f) varied.emplace_back(f);
  const std::size_t count = errors.size() / varied.size();
  std::vector<double> found(model.responses.size() * count);
  std::vector<SolveStatus> status(count);
  std::vector<std::uint32_t> iterations(count);
  evaluator.evaluate({pose, std::vector<double>(varied.size(), 0.0), varied, errors, count},
                     {found, status, iterations, {}});
  for (const SolveStatus one : status) EXPECT_TRUE(solved(one));
  return found;
}

std::size_t position_of(const std::string& response) {
  const auto& all = hexapod().description.responses;
  return static_cast<std::size_t>(std::ranges::find(all, response, &Response::name) - all.begin());
}

constexpr std::array kNames{"x", "y", "z", "theta_x", "theta_y", "theta_z"};
constexpr std::size_t kExact = 0;
constexpr std::size_t kFirstOrder = 1;

TEST(NateghAgheli, ExactDisplacementsAgreeInAllPrintedDigits) {
  const std::unique_ptr<Model> model = hexapod().build({{0.8}}, kExact);
  const auto evaluator = model->evaluator({.tolerance = model->description().tolerance});
  struct Case {
    double scale;
    std::array<double, 6> expected;  // mm and rad
    double digits;                   // one unit of the last printed digit, mm
    double angle_digits;             // one unit of the last printed digit, rad
  };
  for (const Case& one :
       {Case{
            1.0, {41.2083300137, 13.5917372283, 1.5504403769, 0.0221825652, -0.0889669875, 0.0064959656}, 1e-10, 1e-10},
        Case{0.01,
             {0.3786134479, 0.167952093, 0.0268091607, 2.6380559e-4, -8.4547488e-4, 2.7625362e-5},
             1e-10,
             1e-11}}) {
    std::vector<double> errors = measured();
    for (double& error : errors) error *= one.scale;
    const std::vector<double> found = responses(*evaluator, {0.0, 0.0, 0.8}, errors);
    for (std::size_t c = 0; c < kNames.size(); ++c) {
      const bool length = c < 3;
      EXPECT_NEAR(found[position_of(kNames[c])] / (length ? kMillimetre : 1.0), one.expected[c],
                  length ? one.digits : one.angle_digits)
          << kNames[c] << " at " << one.scale;
    }
  }
}

/// Whether no nominal leg is longer than kLongest (m) at the level pose (x, y, 0.8 m). home: the sketch at (0, 0, 0.8
/// m).
bool within_reach(const Sketch& home, double x, double y) {
  constexpr double kLongest = 1.1;
  for (const auto& limb : home.limbs) {
    const SketchVector& base = limb.front().point;
    const SketchVector& joint = limb.back().point;
    if (std::hypot(joint[0] + x - base[0], joint[1] + y - base[1], joint[2] - base[2]) > kLongest) return false;
  }
  return true;
}

#ifdef POESY_SANITIZED  // a sanitizer takes a hundred times as long, so the grid is coarser
constexpr int kStep = 5;
constexpr std::size_t kPoses = 1580;
constexpr double kMeanTolerance = 0.05;  // mm
#else
constexpr int kStep = 1;
constexpr std::size_t kPoses = 39376;
constexpr double kMeanTolerance = 1e-5;
#endif

TEST(NateghAgheli, MeanOfFirstOrderOverTheirPosesIsTheirs) {
  const std::unique_ptr<Model> model = hexapod().build({{0.8}}, kFirstOrder);
  const auto evaluator = model->evaluator({});
  const Sketch home = model->sketch({}).value();
  const std::vector<double> errors = measured();
  std::size_t poses = 0;
  double sum = 0.0;
  for (int i = -200; i <= 200; i += kStep) {
    for (int j = -200; j <= 200; j += kStep) {
      const double x = 5.0 * kMillimetre * i;
      const double y = 5.0 * kMillimetre * j;
      if (!within_reach(home, x, y)) continue;
      ++poses;
      sum += responses(*evaluator, {x, y, 0.8}, errors)[position_of("position")];
    }
  }
  EXPECT_EQ(poses, kPoses);
  EXPECT_NEAR(sum / static_cast<double>(poses) / kMillimetre, 47.62550, kMeanTolerance);  // published: 47.62552
}

TEST(NateghAgheli, RootMeanSquaresOfManyDrawsAreTheClosedForms) {
  const std::unique_ptr<Model> model = hexapod().build({{0.8}}, kFirstOrder);
  const auto evaluator = model->evaluator({});
  constexpr std::size_t kDraws = 200'000;
  constexpr double kSigma = 1e-5;
  std::mt19937_64 engine(3);
  std::normal_distribution<double> normal(0.0, kSigma);
  std::vector<double> errors(42 * kDraws);
  for (double& error : errors) error = normal(engine);
  const std::vector<double> found = responses(*evaluator, {0.0, 0.0, 0.8}, errors);
  const auto check = [&](const std::string& response, double expected) {
    double sum = 0.0;
    double fourth = 0.0;
    for (std::size_t n = 0; n < kDraws; ++n) {
      const double square = std::pow(found[position_of(response) * kDraws + n] / kSigma, 2);
      sum += square;
      fourth += square * square;
    }
    const double mean = sum / kDraws;
    const double deviation = std::sqrt((fourth / kDraws - mean * mean) / kDraws);
    EXPECT_NEAR(mean, expected * expected, 3.9 * deviation) << response;  // alpha = 1e-4
  };
  check("position", 9.447575736);
  check("rotation", 0.0427701256 / kMillimetre);
}

}  // namespace
}  // namespace poesy
