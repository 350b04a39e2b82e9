// Zones of a drawing as parts of an allocation. The numbers are compared with those of another program.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "engine/kinds/allocation/search_stages.h"
#include "engine/kinds/allocation/zone_parts.h"
#include "engine/kinds/study_file.h"
#include "engine/random/distribution.h"
#include "models/file/model.h"
#include "tests/support/input_error.h"

namespace poesy::allocation {
namespace {

using nlohmann::json;

const json& oracle() {
  static const json all = json::parse(std::ifstream(POESY_TEST_DATA "/drawing.json"));
  return all;
}

const Catalog& catalog() {
  static const Catalog only = [] {
    std::ostringstream text;
    text << std::ifstream(POESY_TEST_DATA "/mechanisms/linear-delta-drawing.toml").rdbuf();
    return Catalog{file::catalog_entry(text.str(), "linear-delta-drawing.toml")};
  }();
  return only;
}

const std::string kCost = "cost = { law = \"reciprocal\", b = 1, unit = \"mm\" }\n";
const std::string kAlike = "each = true\nidentical_limbs = [1, 2, 3]\n";
const std::string kAll = "[[analysis.parts]]\nzones = \"all\"\n" + kAlike + kCost;

std::string study_text(const std::string& parts, const std::string& scatter = "sigmas = 3") {
  return "format = \"poesy-study\"\nversion = 1\n"
         "mechanism = { model = \"linear-delta\", fidelity = \"first-order\" }\nposes = { count = 3 }\n"
         "errors.zones = { distribution = \"normal\", " +
         scatter + " }\n[analysis]\nkind = \"allocation\"\nlimits = { tip_position = \"0.02 mm\" }\nyield = 0.95\n" +
         parts;
}

Study read(const std::string& parts, const std::string& scatter = "sigmas = 3") {
  return study_of_text(study_text(parts, scatter), "study.toml", catalog(), StudyUse::run);
}

std::vector<AllocatedPart> parts_of(const Study& study) { return asked_of<Options>(study.analysis).parts; }

/// A search at the three poses of the other program.
struct ZoneSearch {
  explicit ZoneSearch(Study asked) : study(std::move(asked)) {}

  Study study;
  std::unique_ptr<Model> model = study.mechanism.entry->build(study.mechanism.geometry, study.mechanism.fidelity);
  PoseSet poses{3, {0, 0, 0.2, 0.08, -0.08, 0.15, -0.05, 0.03, 0.24}};
  RunOptions options{.threads = 2};
  StudyRun run{.study = study, .model = *model, .poses = poses, .options = options};
  SearchProblem problem{run};

  std::size_t position(const std::string& name) const {
    const auto& parts = problem.programme.parts();
    return static_cast<std::size_t>(std::ranges::find(parts, name, &AllocatedPart::name) - parts.begin());
  }
  /// The tolerances of least cost for which the root mean squares do not exceed the limits.
  Candidate cheapest() const {
    std::vector<double> small = problem.programme.usual();
    for (double& tolerance : small) tolerance *= 0.01;
    return choose(problem, measure(problem, small, 0), 1.0, {}).value();
  }
};

/// Parts with costs b / T: b is 0.5 for distances, hinge_b for hinge_b.parallelism and 1 for other zones.
std::string oracle_parts(const std::string& hinge_b) {
  const auto block = [](const std::string& zones, const std::string& b) {
    return "[[analysis.parts]]\nzones = " + zones + "\n" + kAlike + "cost = { law = \"reciprocal\", b = " + b +
           ", unit = \"mm\" }\n";
  };
  return block("[\"*.position\", \"face.*\", \"rail.*\", \"rod_bore.*\"]", "1") + block("[\"*.tolerance\"]", "0.5") +
         block("[\"hinge_b.parallelism\"]", hinge_b);
}

TEST(ZoneParts, CostWhatAnotherProgramFinds) {
  for (const auto& [b, left_out] :
       std::map<std::string, std::string>{{"1", "rail.perpendicularity,hinge_b.parallelism"},
                                          {"0.1", "hinge_b.parallelism at b = 0.1; left out: rail.perpendicularity"}}) {
    const json expected = oracle()["allocation_left_out"][left_out];
    const ZoneSearch search(read(oracle_parts(b)));
    const Candidate found = search.cheapest();
    EXPECT_NEAR(found.point.cost, expected["cost"], 1e-8 * found.point.cost);
    EXPECT_LE(found.chosen.lower_bound, found.point.cost);
    for (const auto& [name, tolerance] : expected["tolerances"].items()) {
      const std::size_t i = search.position(name.find('.') == std::string::npos ? name + ".tolerance" : name);
      EXPECT_NEAR(found.point.tolerance[i], 1e-3 * tolerance.get<double>(), 1e-8 * found.point.tolerance[i]) << name;
    }
    EXPECT_TRUE(search.problem.programme.is_void(found.point, search.position("rail.perpendicularity")));
    EXPECT_EQ(search.problem.programme.is_void(found.point, search.position("hinge_b.parallelism")), b == "1");
  }
}

TEST(ZoneParts, HaveTheEffectsOfTheOracle) {
  const ZoneSearch search(read(oracle_parts("1")));
  std::vector<double> small = search.problem.programme.usual();
  for (double& tolerance : small) tolerance *= 0.01;
  const Linearisation found = measure(search.problem, small, 0);
  const ToleranceLimits limits = search.problem.programme.limits(found.squares, small, 1.0);
  for (const auto& [name, coefficients] : oracle()["allocation"]["coefficients"].items()) {
    const std::size_t i = search.position(name.find('.') == std::string::npos ? name + ".tolerance" : name);
    for (std::size_t m = 0; m < 3; ++m) {
      EXPECT_NEAR(limits.row(m)[i], coefficients[m].get<double>(), 1e-8 * std::abs(limits.row(m)[i])) << name;
    }
  }
  for (const double room : limits.room) EXPECT_NEAR(room, 4e-10, 1e-18);
}

double sigma(const Study& study, const std::string& error) {
  return study.errors.by_factor[study.model().find_factor(error)->value].standard_deviation();
}

TEST(ZoneParts, GiveTheStandardDeviationsOfTheirZones) {
  // With the tolerances of the drawing, the parts give the same errors as errors.zones.
  const Study study = read(kAll);
  const ZoneSearch search(study);
  const Study drawn = search.problem.programme.at(search.problem.programme.usual());
  for (std::size_t f = 0; f < drawn.errors.by_factor.size(); ++f) {
    const double expected = study.errors.by_factor[f].standard_deviation();
    EXPECT_NEAR(drawn.errors.by_factor[f].standard_deviation(), expected, 1e-15 * expected) << f;
  }
  // `within` states the share of points inside a zone. The number of standard deviations for it is larger for a disc
  // than for an interval.
  const ZoneSearch share(read(kAll, "within = 0.9973002039"));
  const Study shared = share.problem.programme.at(share.problem.programme.usual());
  EXPECT_NEAR(sigma(shared, "rail_x_1"), 3.0 / 3.4393543118 * 7.6376261583e-6, 1e-13);
  EXPECT_NEAR(sigma(shared, "rod_1"), 0.02e-3 / 3.0, 1e-14);
}

TEST(ZoneParts, ReadBackFromTheirText) {
  for (const std::string& parts : {kAll, oracle_parts("0.1"),
                                   "[[analysis.parts]]\nzones = [\"rail_1.*\", \"rod.tolerance\"]\neach = true\n"
                                   "values = [\"0.01 mm\", \"0.02 mm\"]\n" +
                                       kCost,
                                   "[[analysis.parts]]\nzones = [\"*.position\"]\n" + kAlike + kCost}) {
    const Study study = read(parts);
    const std::string text = resolved_text(study);
    const Study again = study_of_text(text, "again.toml", catalog(), StudyUse::run);
    EXPECT_EQ(resolved_text(again), text);
    ASSERT_EQ(parts_of(again).size(), parts_of(study).size());
    for (std::size_t i = 0; i < parts_of(again).size(); ++i) {
      EXPECT_EQ(parts_of(again)[i].name, parts_of(study)[i].name);
      EXPECT_EQ(parts_of(again)[i].factors, parts_of(study)[i].factors);
    }
  }
}

TEST(ZoneParts, KeepAnOrientationThatIsNoPartAsDrawn) {
  const Study study = read("[[analysis.parts]]\nzones = [\"rail.position\"]\n" + kAlike + kCost);
  const std::vector<AllocatedPart> parts = parts_of(study);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].name, "rail.position");
  EXPECT_EQ(parts[1].name, "rail.perpendicularity");
  EXPECT_EQ(parts[1].choice, AllocatedPart::Choice::fixed);
  EXPECT_EQ(parts[1].lo, 0.02e-3);
  const ZoneSearch search(study);
  const ToleranceProgramme& programme = search.problem.programme;
  // With a location zone of 0.1 mm the tilt is as drawn. With 0.01 mm the drawn tilt zone of 0.02 mm has no effect (is
  // void).
  const auto tilt_at = [&](double location) {
    return sigma(programme.at(programme.at_most(std::vector{location, 1.0}).tolerance), "rail_lean_x_2");
  };
  EXPECT_NEAR(tilt_at(0.1e-3), 0.02e-3 / 3.0, 1e-18);
  EXPECT_NEAR(tilt_at(0.01e-3), 0.01e-3 / 3.0 / std::sqrt(2.0), 1e-18);
  EXPECT_EQ(programme.at_bound(programme.at_most(std::vector{0.01e-3, 1.0}), 1), AtBound::single);
}

TEST(ZoneParts, AreRoundedDownWithoutALargerError) {
  const ZoneSearch search(read("[[analysis.parts]]\nzones = \"all\"\n" + kAlike + kCost + "round = \"0.003 mm\"\n"));
  const ToleranceProgramme& programme = search.problem.programme;
  const std::size_t location = search.position("rail.position");
  const std::size_t tilt = search.position("rail.perpendicularity");
  EXPECT_EQ(programme.lowest().tolerance[location], 0.003e-3);
  TolerancePoint point = programme.at_most(programme.usual());
  for (const auto& [wide, fine, expected_wide, expected_fine] :
       {std::array{50.0, 20.0, 48.0, 18.0},
        {48.01, 20.9, 45.0, 18.0},
        {48.0, 18.0, 48.0, 18.0},
        {14.0, 9.8, 12.0, 12.0 / std::sqrt(2.0)}}) {  // last: the tilt zone is as wide as the location allows
    point.tolerance[location] = 1e-6 * wide;
    point.tolerance[tilt] = 1e-6 * fine;
    const TolerancePoint rounded = programme.rounded(point);
    EXPECT_NEAR(rounded.tolerance[location], 1e-6 * expected_wide, 1e-15);
    EXPECT_NEAR(rounded.tolerance[tilt], 1e-6 * expected_fine, 1e-15);
    const Study before = programme.at(point.tolerance);
    const Study after = programme.at(rounded.tolerance);
    for (const FactorIndex factor : before.analysis.factors) {
      const double sigma = before.errors.by_factor[factor.value].standard_deviation();
      EXPECT_LE(after.errors.by_factor[factor.value].standard_deviation(), sigma * (1.0 + 1e-12)) << factor.value;
    }
  }
  EXPECT_TRUE(programme.is_void(programme.rounded(point), tilt));
}

TEST(ZoneParts, GrowByTheirOwnErrorsAndTheMiddle) {
  const ZoneSearch search(read(kAll));
  const ToleranceProgramme& programme = search.problem.programme;
  const TolerancePoint point = programme.at_most(programme.usual());
  const double location = point.tolerance[search.position("rail.position")];
  const double tilt = point.tolerance[search.position("rail.perpendicularity")];
  const double rest = location * location - tilt * tilt;
  for (const auto& [error, growth] : programme.growth(point, search.position("rail.position"))) {
    EXPECT_NEAR(growth, location * location / rest, 1e-12);
  }
  const auto of_tilt = programme.growth(point, search.position("rail.perpendicularity"));
  ASSERT_EQ(of_tilt.size(), 12u);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(of_tilt[k].factor, 1.0);
  for (std::size_t k = 6; k < 12; ++k) EXPECT_NEAR(of_tilt[k].factor, -tilt * tilt / rest, 1e-12);
  // variation() agrees with the change of the standard deviations when the tilt zone becomes 1 % coarser.
  TolerancePoint coarser = *programme.coarser(point, search.position("rail.perpendicularity"), 1.01);
  const Study before = programme.at(point.tolerance);
  const Study after = programme.at(coarser.tolerance);
  for (const auto& [error, factor] : programme.variation(point, search.position("rail.perpendicularity"), -1.01)) {
    const std::size_t f = search.study.analysis.factors[error].value;
    const double ratio =
        after.errors.by_factor[f].standard_deviation() / before.errors.by_factor[f].standard_deviation();
    EXPECT_NEAR(factor, -ratio, 1e-12);
  }
}

TEST(ZoneParts, LeaveAnOrientationOutWhereItCannotBeCoarser) {
  const ZoneSearch search(read(kAll));
  const ToleranceProgramme& programme = search.problem.programme;
  const std::size_t outer = search.position("rail.position");
  const std::size_t inner = search.position("rail.perpendicularity");
  std::vector<double> wanted = programme.usual();
  wanted[inner] = 0.7 * wanted[outer];
  const TolerancePoint near = programme.at_most(wanted);
  EXPECT_FALSE(programme.is_void(near, inner));
  const TolerancePoint out = programme.coarser(near, inner, 1.05).value();
  EXPECT_TRUE(programme.is_void(out, inner));
  EXPECT_EQ(programme.cost(out, inner), 0.0);
  EXPECT_NEAR(out.cost, near.cost - programme.cost(near, inner), 1e-9);
  EXPECT_FALSE(programme.coarser(out, inner, 1.05));
  // The orientation stays void when all tolerances are scaled, and when the location becomes coarser.
  std::vector<double> finer = out.tolerance;
  for (double& tolerance : finer) tolerance *= 0.9;
  EXPECT_TRUE(programme.is_void(programme.at_most(finer), inner));
  EXPECT_TRUE(programme.is_void(programme.coarser(out, outer, 1.05).value(), inner));
  std::vector<double> only_tilt = out.tolerance;
  only_tilt[inner] *= 0.5;
  programme.keep_void(out, only_tilt);
  EXPECT_EQ(only_tilt[inner], out.tolerance[inner]);
}

// Each certificate holds with a probability of 99 %, so 18 or more of 20 hold with a probability of 99.9 %.
TEST(ZoneParts, HoldTheirCertificateOnOtherMachines) {
  const ZoneSearch search(read(kAll));
  const auto found = find_tolerances(search.problem);
  ASSERT_TRUE(found);
  const std::vector<double>& tolerance = found->design.candidate.point.tolerance;
  int held = 0;
  for (std::uint64_t seed = 1001; seed <= 1020; ++seed) {
    if (rejects_of(loads_of(search.problem, seed, tolerance)) <= search.problem.allowed.certificate) ++held;
  }
  EXPECT_GE(held, 18);
  EXPECT_TRUE(
      search.problem.programme.is_void(found->design.candidate.point, search.position("rail.perpendicularity")));
}

TEST(ZoneParts, MayAllGrowByOneFactor) {
  const ZoneSearch search(read("aim = \"common-factor\"\n[[analysis.parts]]\nzones = \"all\"\n" + kAlike));
  const std::vector<double> usual = search.problem.programme.usual();
  const std::vector<double> found = search.cheapest().point.tolerance;
  for (std::size_t i = 1; i < found.size(); ++i) EXPECT_NEAR(found[i] / usual[i], found[0] / usual[0], 1e-12);
  const double rms = 0.02e-3 / (found[0] / usual[0]);  // with the drawn tolerances, at the worst of the three poses
  double worst = 0.0;
  for (const json& pose : oracle()["linear_delta"]["poses"]) worst = std::max(worst, pose["rms_tip"].get<double>());
  EXPECT_NEAR(rms, worst, 1e-8 * worst);
}

/// The mechanism of the drawing, with a nominal size of 340 mm for its rods.
const Catalog& catalog_with_size() {
  static const Catalog only = [] {
    std::ostringstream text;
    text << std::ifstream(POESY_TEST_DATA "/mechanisms/linear-delta-drawing.toml").rdbuf();
    std::string sized = text.str();
    sized.insert(sized.find("tolerance", sized.find("\"rod\"")), "nominal_size = \"340 mm\", ");
    return Catalog{file::catalog_entry(sized, "linear-delta-drawing.toml")};
  }();
  return only;
}

const std::string kRods = "[[analysis.parts]]\nzones = [\"rod.tolerance\"]\n" + kCost + kAlike;

TEST(ZoneGrades, AreThoseOfTheSizeOnTheDrawing) {
  const std::string grades = kRods + "grades = [\"IT5\", \"IT6\"]\n";
  for (const std::string size : {"", "nominal_size = \"340 mm\"\n"}) {
    const auto parts =
        parts_of(study_of_text(study_text(grades + size), "study.toml", catalog_with_size(), StudyUse::run));
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_DOUBLE_EQ(parts[0].nominal_size, 0.34);
  }
  const test::Marked bad(study_text(grades + "nominal_size = ^\"905 mm\"\n"));
  test::expect_input_error([&] { study_of_text(bad.text, "study.toml", catalog_with_size(), StudyUse::run); },
                           {"study.toml", bad.line, bad.column},
                           {"'905 mm', but 'rod_3' is 340 mm in the mechanism's file",
                            "leave it out, or put 'rod_3' into a block of its own"});
  const test::Marked missing(study_text(kRods + "grades = ^[\"IT6\"]\n"));
  test::expect_input_error([&] { study_of_text(missing.text, "study.toml", catalog(), StudyUse::run); },
                           {"study.toml", missing.line, missing.column}, {"nominal_size is missing"});
}

struct WrongZones {
  const char* name;
  std::string parts;  ///< text of the parts; a '^' marks the place of the mistake
  std::vector<std::string> words;
  std::string errors = "errors.zones = { distribution = \"normal\", sigmas = 3 }\n";
};

void PrintTo(const WrongZones& one, std::ostream* out) { *out << one.name; }

class WrongZoneParts : public ::testing::TestWithParam<WrongZones> {};

TEST_P(WrongZoneParts, AreRefused) {
  const WrongZones& wrong = GetParam();
  const test::Marked bad(
      "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"linear-delta\" }\nposes = { count = 3 }\n" +
      wrong.errors + "[analysis]\nkind = \"allocation\"\nlimits = { tip_position = \"0.02 mm\" }\n" + wrong.parts);
  test::expect_input_error([&] { study_of_text(bad.text, "study.toml", catalog(), StudyUse::run); },
                           {"study.toml", bad.line, bad.column}, wrong.words);
}

const std::string kBlock = "[[analysis.parts]]\n";

const auto kName = [](const auto& info) { return std::string(info.param.name); };

INSTANTIATE_TEST_SUITE_P(
    Parts, WrongZoneParts,
    testing::Values(
        WrongZones{"Word",
                   kBlock + "zones = ^\"every\"\n" + kAlike,
                   {"parts[0].zones is 'every'", "write \"all\", or a list such as [\"face.parallelism\"]"}},
        WrongZones{"UnknownZone",
                   kBlock + "zones = [^\"rail.positoin\"]\n" + kAlike,
                   {"is 'rail.positoin', which is not a zone of the drawing", "did you mean 'rail.position'?"}},
        WrongZones{"ZoneOfAnotherFeature",
                   kBlock + "zones = [\"rail.*\", ^\"face.position\"]\n" + kAlike,
                   {"zones[1] is 'face.position', which is not a zone of the drawing"}},
        WrongZones{"NoZone", kBlock + "zones = ^[]\n" + kAlike, {"zones is empty", "[\"face.parallelism\"]"}},
        WrongZones{"FactorsToo",
                   kBlock + "factors = ^\"linear\"\nzones = \"all\"\n" + kAlike,
                   {"factors is set, and so is analysis.parts[0].zones", "in a block of its own"}},
        WrongZones{"NoScatter",
                   kBlock + "zones = ^\"all\"\n" + kAlike,
                   {"[errors] does not say how much of a zone is used", "write errors.zones = {"},
                   ""},
        WrongZones{"NoNormals",
                   kBlock + "zones = ^\"all\"\n" + kAlike,
                   {"is set, but errors.zones has no normals", "write errors.zones = { distribution = \"normal\""},
                   "errors.zones = { distribution = \"uniform\" }\n"},
        WrongZones{"NotEach",
                   kBlock + "zones = ^\"all\"\n",
                   {"each is not true, and a zone is a tolerance of its own", "write each = true"}},
        WrongZones{"Name",
                   kBlock + "zones = \"all\"\nname = ^\"a\"\n" + kAlike,
                   {"every zone has its name on the drawing", "remove it"}},
        WrongZones{"Sigmas",
                   kBlock + "zones = \"all\"\nsigmas = ^4\n" + kAlike,
                   {"sigmas is set, but errors.zones says how much of a zone is used"}},
        WrongZones{"Cpk", kBlock + "zones = \"all\"\ncpk = ^1\n" + kAlike, {"cpk is set, but errors.zones"}},
        WrongZones{"Shift",
                   kBlock + "zones = [\"rod.*\", \"rail.*\"]\nshift = ^0.1\n" + kAlike,
                   {"shift is set, but 'rail.position' is not a distance", "in a block of their own"}},
        WrongZones{"Grades",
                   kBlock + "zones = [\"cross_b.position\"]\ngrades = ^[\"IT6\"]\nnominal_size = \"50 mm\"\n" + kAlike,
                   {"grades is set, but 'cross_b.position' is not a distance"}},
        WrongZones{"HeldError",
                   "factors = [\"rail_x_1\"]\n" + kBlock + "zones = ^[\"rail_1.*\"]\neach = true\n",
                   {"has 'rail_1.position' with the error 'rail_y_1', which the study does not vary"}},
        WrongZones{"SecondTime",
                   kAll + kBlock + "zones = ^[\"rod.tolerance\"]\n" + kAlike,
                   {"has 'rod.tolerance', which another block has as well", "leave it out of one of them"}},
        WrongZones{"ErrorOfAZone",
                   kAll + kBlock + "factors = ^[\"rod_1\"]\nsigmas = 3\n",
                   {"puts 'rod_1' into part 'rod_1', but part 'rod.tolerance' has it as well"}},
        WrongZones{
            "NoLocation",
            "parts = ^[ { zones = [\"rail.perpendicularity\"], each = true } ]\n",
            {"has 'rail_1.perpendicularity' without the position of the same features", "add \"rail.position\""}},
        WrongZones{"OtherLimbs",
                   "parts = ^[ { zones = [\"rail.position\"], each = true, identical_limbs = [1, 2, 3] }, { zones = "
                   "[\"rail.perpendicularity\"], each = true } ]\n",
                   {"without the position of the same features", "with the same identical_limbs"}},
        WrongZones{"JoinsNothing",
                   kBlock + "zones = [\"rail_1.*\"]\neach = true\nidentical_limbs = ^[1, 2]\n",
                   {"identical_limbs joins no two zones of this block"}},
        WrongZones{"AimWithoutCost",
                   "aim = ^\"equal-effect\"\n" + kBlock + "zones = \"all\"\n" + kAlike,
                   {"gives no tolerance to 'rail.perpendicularity' within 'rail.position'", "aim = \"common-factor\""}},
        WrongZones{"MeasuredError",
                   kBlock + "zones = ^[\"rod.tolerance\"]\n" + kAlike,
                   {"has 'rod_2', whose mean is not zero"},
                   "[errors]\nzones = { distribution = \"normal\", sigmas = 3 }\noverride = { rod_2 = { distribution = "
                   "\"normal\", sigma = \"1 um\", mean = \"2 um\" } }\n"}),
    kName);

}  // namespace
}  // namespace poesy::allocation
