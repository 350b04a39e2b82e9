// Over-constrained mechanisms with rounded numbers. They are compared with the exact mechanism, in which a wrong axis
// is an error.
#include "models/file/rounding.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "models/file/model.h"
#include "tests/models/file/files.h"

namespace poesy::file {
namespace {

/// The text of a planar 3-RRR in which joint B of limb 2 is along (tilt, 0, 1). The mechanism is rotated by R, and its
/// numbers are written with `digits` digits (17: exactly).
std::string rrr3(double tilt, int digits = 17, const lie::Matrix3<double>& R = lie::Matrix3<double>::Identity()) {
  constexpr std::array<std::array<double, 2>, 3> kPoints{{{300.0, 0.0}, {220.0, 120.0}, {80.0, 0.0}}};
  const auto triple = [&](const Vector3& vector, const char* unit) {
    const auto entry = [&](double value) { return fmt::format("\"{:.{}g}{}\"", value, digits, unit); };
    const Vector3 turned = R * vector;
    return fmt::format("[{}, {}, {}]", entry(turned.x()), entry(turned.y()), entry(turned.z()));
  };
  std::string text =
      "format = \"poesy-mechanism\"\nversion = 1\nname = \"rrr\"\n[platform]\norigin = [0, 0, 0]\n"
      "points = [" +
      triple({80.0, 0.0, 0.0}, " mm") + ", " + triple({-40.0, 69.0, 0.0}, " mm") + ", " +
      triple({-40.0, -69.0, 0.0}, " mm") + "]\n";
  const bool turned = !R.isIdentity();
  text += turned ? "coordinates = [\"x\", \"y\", \"rz\"]\n" : "coordinates = [\"x\", \"y\", { phi = \"rz\" }]\n";
  text += fmt::format(
      "workspace = {{ x = [\"-40 mm\", \"40 mm\"], y = [\"-40 mm\", \"40 mm\"], {} = [\"-20 deg\", \"20 deg\"] }}\n",
      turned ? "rz" : "phi");
  for (std::size_t i = 0; i < 3; ++i) {
    const Transform turn = lie::rotation<double>(lie::Axis::z, 2.0 * M_PI / 3.0 * static_cast<double>(i));
    text += "[[limb]]\njoints = [";
    for (std::size_t j = 0; j < 3; ++j) {
      const Vector3 point = turn.R * Vector3(kPoints[j][0], kPoints[j][1], 0.0);
      const double length =
          digits < 17 ? 1.0 + 0.1 * static_cast<double>(3 * i + j) : 1.0;  // so that each axis is rounded differently
      text += fmt::format("{}\n  {{ name = \"{}\", type = \"R\", at = {}, axis = {}{} }}", j == 0 ? "" : ",", "ABC"[j],
                          triple(point, " mm"), triple(length * Vector3(i == 1 && j == 1 ? tilt : 0.0, 0.0, 1.0), ""),
                          j == 0 ? ", actuated = true" : "");
    }
    text += " ]\n";
  }
  return text;
}

/// The same 3-RRR, but a body cuts limb 2 after joint A, so the file is branched.
std::string cut_rrr3(double tilt) {
  std::string text = rrr3(tilt);
  const std::size_t second = text.find("[[limb]]", text.find("[[limb]]") + 1);
  const std::size_t end = text.find("\n", text.find("\"A\"", second));
  text.replace(end - 1, 1, " ]\n[[limb]]\nfrom = \"elbow\"\njoints = [");
  text.insert(second, "[[body]]\nname = \"elbow\"\nat = [0, 0, 0]\n");
  text.insert(text.find("joints", second), "to = \"elbow\"\n");
  return text;
}

/// The text of a mechanism with three cranks that keep the platform parallel. The third crank is shorter by this (m),
/// which has no effect at home, where the cranks are parallel.
std::string cranks(double shorter) {
  std::string text =
      "format = \"poesy-mechanism\"\nversion = 1\nname = \"cranks\"\n[platform]\norigin = [0, \"100 mm\", 0]\n"
      "coordinates = [\"x\"]\nworkspace = { x = [\"-60 mm\", \"60 mm\"] }\n"
      "points = [[0, 0, 0], [\"200 mm\", 0, 0], [0, 0, \"100 mm\"]]\n";
  for (std::size_t i = 0; i < 3; ++i) {
    text += fmt::format(
        "[[limb]]\njoints = [ {{ name = \"A\", type = \"R\", at = [\"{0} mm\", 0, 0], axis = \"z\"{1} }},\n"
        "  {{ name = \"B\", type = \"R\", at = [\"{0} mm\", \"{2:.12g} mm\", 0], axis = \"z\" }} ]\n",
        100 * i, i == 0 ? ", actuated = true" : "", i == 2 ? 100.0 - 1e3 * shorter : 100.0);
  }
  return text;
}

/// A five-bar whose elbows are rounded to a micrometre, as on a drawing, and whose last axis is tilted.
const std::string kFiveBar =
    "format = \"poesy-mechanism\"\nversion = 1\nname = \"five-bar\"\n"
    "[platform]\norigin = [0, \"110 mm\", 0]\ncoordinates = [\"x\", \"y\"]\n"
    "points = [[0, 0, 0], [\"20 mm\", 0, 0], [0, \"20 mm\", 0]]\n"
    "workspace = { x = [\"-20 mm\", \"20 mm\"], y = [\"90 mm\", \"125 mm\"] }\n"
    "[[limb]]\njoints = [ { name = \"A\", type = \"R\", at = [\"-20 mm\", 0, 0], axis = \"z\", actuated = true },\n"
    "  { name = \"B\", type = \"R\", at = [\"-63.402 mm\", \"41.429 mm\", 0], axis = \"z\" } ]\n"
    "[[limb]]\njoints = [ { name = \"A\", type = \"R\", at = [\"20 mm\", 0, 0], axis = \"z\", actuated = true },\n"
    "  { name = \"B\", type = \"R\", at = [\"63.402 mm\", \"41.429 mm\", 0], axis = \"z\" },\n"
    "  { name = \"C\", type = \"R\", at = [0, \"110 mm\", 0], axis = [0, 0.0000037, 1] } ]\n";

Mechanism mechanism_of(const std::string& text) {
  const MechanismFile file = read_mechanism_file(text, "m.toml");
  return mechanism(file, default_geometry(file));
}

Checked checked_of(const std::string& text) { return checked(mechanism_of(text), Workspace::in_reach); }

std::unique_ptr<Model> model_of(const std::string& text, std::size_t fidelity = 0, bool published = false) {
  const CatalogEntry entry = catalog_entry(text, "m.toml");
  return (published ? *entry.other_metric : entry).build({}, fidelity);
}

std::string problem_of(const std::string& text) {
  try {
    static_cast<void>(catalog_entry(text, "m.toml"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

/// The responses to these errors at a pose.
std::vector<double> responses_of(const Model& model, const std::vector<double>& pose,
                                 const std::vector<double>& errors) {
  const ModelDescription& description = model.description();
  std::vector<FactorIndex> varied;
  for (std::size_t f = 0; f < errors.size(); ++f) varied.emplace_back(f);
  std::vector<double> responses(description.responses.size());
  std::array status{SolveStatus::singular};
  std::array iterations{std::uint32_t{0}};
  model.evaluator({.tolerance = description.tolerance})
      ->evaluate({pose, std::vector<double>(errors.size(), 0.0), varied, errors, 1},
                 {responses, status, iterations, {}});
  EXPECT_TRUE(solved(status[0]));
  return responses;
}

std::vector<double> none(const Model& model) { return std::vector<double>(model.description().factors.size(), 0.0); }

/// The errors of the exact 3-RRR that only tilt joint B of limb 2 about its point: the tilt in the frame before the
/// joint, and the opposite tilt in the frame after it.
std::vector<double> tilt_as_errors(const Model& exact, double tilt) {
  const Mechanism mechanism = mechanism_of(rrr3(0.0));
  const Transform& A = mechanism.limbs[1].joints[0].at_home;
  const Transform& B = mechanism.limbs[1].joints[1].at_home;
  const Vector3 turn(0.0, std::atan(tilt), 0.0);  // z towards x
  const Vector3 epsilon_1 = A.R.transpose() * turn;
  const Vector3 delta_1 = A.R.transpose() * (lie::exp<double>(turn) * (A.p - B.p) + B.p - A.p);
  const Vector3 epsilon_2 = -(B.R.transpose() * turn);
  std::vector<double> errors = none(exact);
  const auto set = [&](const std::string& name, const Vector3& value) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      errors[exact.description().find_factor(name + "xyz"[c])->value] = value[c];
    }
  };
  set("epsilon_2_1_", epsilon_1);
  set("delta_2_1_", delta_1);
  set("epsilon_2_2_", epsilon_2);
  return errors;
}

class Tilts : public testing::TestWithParam<double> {
 protected:
  const std::vector<std::vector<double>> poses_{{0.01, 0.0, 0.0}, {-0.03, 0.035, 0.2}, {0.04, -0.02, -0.34}};
};

TEST_P(Tilts, TheMechanismMovesAsTheExactOne) {
  const Checked found = checked_of(rrr3(GetParam()));
  EXPECT_TRUE(found.mechanism.precision.rounded());
  EXPECT_EQ(found.home.rank, 6u);
  EXPECT_EQ(found.home.freedoms, 3u);
  EXPECT_EQ(found.home.over_constraints, 6u);
  const std::vector<PoseMobility> poses = workspace_mobility(found.mechanism);
  EXPECT_TRUE(std::ranges::all_of(poses, &PoseMobility::reached));
  EXPECT_NO_THROW(check_mobility(found.mechanism, found.home, poses));
}

/// Without errors, the mismatch responses are those that the tilt causes in the exact mechanism; all other responses
/// are zero.
TEST_P(Tilts, TheMismatchIsThatOfTheTilt) {
  const double size = GetParam();
  const std::unique_ptr<Model> exact = model_of(rrr3(0.0));
  const std::unique_ptr<Model> first_order = model_of(rrr3(size), 1);
  const std::unique_ptr<Model> rounded = model_of(rrr3(size));
  const std::vector<double> tilt = tilt_as_errors(*exact, size);
  double largest = 0.0;
  for (const std::vector<double>& pose : poses_) {
    const std::vector<double> expected = responses_of(*exact, pose, tilt);
    for (const Model* model : {&*rounded, &*first_order}) {
      const std::vector<double> found = responses_of(*model, pose, none(*model));
      EXPECT_GT(found[0], 0.0);
      for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(found[r], expected[r], 1e-3 * expected[r] + 1e-15);
      for (std::size_t r = 3; r < found.size(); ++r) EXPECT_NEAR(found[r], 0.0, 1e-14);
    }
    largest = std::max(largest, expected[0]);
  }
  const double told = checked_of(rrr3(size)).mismatch;
  EXPECT_GT(told, largest / 3.0);
  EXPECT_LT(told, largest * 3.0);
  EXPECT_LE(told, rounded->description().deformation->rounding);
}

/// Errors displace the platform as in the exact mechanism, up to a difference in proportion to the tilt.
TEST_P(Tilts, ErrorsDoWhatTheyDoToTheExactMechanism) {
  std::mt19937_64 engine(3);
  const std::unique_ptr<Model> exact = model_of(rrr3(0.0));
  const std::unique_ptr<Model> rounded = model_of(rrr3(GetParam()));
  std::vector<double> errors = none(*exact);
  for (double& error : errors) error = std::uniform_real_distribution<double>(-1e-4, 1e-4)(engine);
  for (const std::vector<double>& pose : poses_) {
    const std::vector<double> expected = responses_of(*exact, pose, errors);
    const std::vector<double> found = responses_of(*rounded, pose, errors);
    for (std::size_t r = 3; r < found.size(); ++r) EXPECT_NEAR(found[r], expected[r], 10.0 * GetParam() * 1e-3);
  }
}

/// The published metric has other weights and its own nominal pose. Its deformation without errors must be below the
/// rounding threshold too.
TEST_P(Tilts, AsPublishedToo) {
  const std::unique_ptr<Model> model = model_of(rrr3(GetParam()), 0, true);
  for (const std::vector<double>& pose : poses_) {
    const std::vector<double> found = responses_of(*model, pose, none(*model));
    EXPECT_GT(found[2], 0.0);
    EXPECT_LE(found[2], model->description().deformation->rounding);
    for (std::size_t r = 3; r < found.size(); ++r) EXPECT_NEAR(found[r], 0.0, 1e-13);
  }
}

/// The drive positions of a pose lead back to this pose.
TEST_P(Tilts, PosesByTheDrives) {
  const std::unique_ptr<Model> model = model_of(rrr3(GetParam()));
  const auto& charts = model->description().charts;
  const auto drives = std::ranges::find(charts, "actuators", &PoseChart::name);
  ASSERT_NE(drives, charts.end());
  for (const std::vector<double>& pose : poses_) {
    const std::vector<double> q = model->joint_displacements(pose);
    const auto found =
        model->pose_from_chart(static_cast<std::size_t>(drives - charts.begin()), std::array{q[0], q[3], q[6]});
    ASSERT_TRUE(found);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR((*found)[c], pose[c], 3.0 * GetParam());
  }
}

/// A limb that a body cuts in two moves the platform like the whole limb. Small differences remain, because the
/// mismatch is then divided differently.
TEST_P(Tilts, ALimbMayBeCutByABody) {
  struct Error {
    const char* whole;
    const char* cut;  ///< limb 2 becomes limbs 2 and 3, so limb 3 becomes limb 4
    double size;
  };
  const std::array errors{Error{"epsilon_1_1_x", "epsilon_1_1_x", 1e-4}, Error{"delta_3_2_y", "delta_4_2_y", 1e-4},
                          Error{"delta_1_2_x", "delta_1_2_x", 5e-5}};
  for (const std::size_t fidelity : {0u, 1u}) {
    const std::unique_ptr<Model> whole = model_of(rrr3(GetParam()), fidelity);
    const std::unique_ptr<Model> cut = model_of(cut_rrr3(GetParam()), fidelity);
    EXPECT_EQ(cut->remarks().size(), 1u);
    for (const double size : {0.0, 1.0}) {
      std::vector<double> of_whole = none(*whole);
      std::vector<double> of_cut = none(*cut);
      for (const Error& error : errors) {
        of_whole[whole->description().find_factor(error.whole)->value] = size * error.size;
        of_cut[cut->description().find_factor(error.cut)->value] = size * error.size;
      }
      for (const std::vector<double>& pose : poses_) {
        const std::vector<double> wanted = responses_of(*whole, pose, of_whole);
        const std::vector<double> found = responses_of(*cut, pose, of_cut);
        for (std::size_t r = 3; r < wanted.size(); ++r) {  // responses of the platform
          EXPECT_NEAR(found[r], wanted[r], size * (5e-9 + 1e-3 * GetParam()) + 1e-13);
        }
      }
    }
  }
}

/// Without errors, the mismatch is the one that the tilt causes in the exact mechanism: the tilt about joint B in the
/// frame at the body, and the opposite tilt after the joint.
TEST_P(Tilts, TheMismatchOfACutLimbIsThatOfTheTilt) {
  const std::unique_ptr<Model> exact = model_of(cut_rrr3(0.0));
  EXPECT_TRUE(exact->remarks().empty());
  std::vector<double> tilt = none(*exact);
  const double angle = std::atan(GetParam());
  const lie::Matrix3<double> B = mechanism_of(rrr3(0.0)).limbs[1].joints[1].at_home.R;
  tilt[exact->description().find_factor("epsilon_3_0_y")->value] = angle;
  for (Eigen::Index c = 0; c < 3; ++c) {
    tilt[exact->description().find_factor(std::string("epsilon_3_1_") + "xyz"[c])->value] = -angle * B(1, c);
  }
  for (const std::size_t fidelity : {0u, 1u}) {
    const std::unique_ptr<Model> rounded = model_of(cut_rrr3(GetParam()), fidelity);
    double largest = 0.0;
    for (const std::vector<double>& pose : poses_) {
      const std::vector<double> expected = responses_of(*exact, pose, tilt);
      const std::vector<double> found = responses_of(*rounded, pose, none(*rounded));
      EXPECT_GT(found[0], 0.0);
      for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(found[r], expected[r], 1e-3 * expected[r] + 1e-15);
      largest = std::max(largest, found[0]);
    }
    const double told = checked_of(cut_rrr3(GetParam())).mismatch;
    EXPECT_GT(told, largest / 3.0);
    EXPECT_LT(told, largest * 3.0);
    EXPECT_LE(told, rounded->description().deformation->rounding);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Tilts, testing::Values(1e-10, 3.7e-6, 1e-5, 1e-4),
                         [](const auto& instance) { return "Tilt" + std::to_string(instance.index); });

TEST(Rounding, SixDigitsOfATiltedPlane) {
  const lie::Matrix3<double> R = lie::exp<double>(Vector3(0.4, -0.3, 0.5));
  EXPECT_FALSE(checked_of(rrr3(0.0, 17, R)).mechanism.precision.rounded());
  for (const int digits : {5, 6, 8}) {
    const Checked found = checked_of(rrr3(0.0, digits, R));
    EXPECT_TRUE(found.mechanism.precision.rounded());
    EXPECT_EQ(found.home.rank, 6u) << digits;
    EXPECT_GT(found.mismatch, 0.0);
    EXPECT_LT(found.mismatch, found.mechanism.reach * std::pow(10.0, 1 - digits));
  }
}

TEST(Rounding, AFiveBarAsDrawn) {
  const Checked found = checked_of(kFiveBar);
  EXPECT_EQ(found.home.rank, 3u);
  EXPECT_EQ(found.home.freedoms, 2u);
  EXPECT_GT(found.mismatch, 1e-9);
  EXPECT_LT(found.mismatch, 1e-6);
  EXPECT_EQ(problem_of(kFiveBar), "read");
}

/// Rounding may be visible only away from home. At home the ranks are those of the exact mechanism.
TEST(Rounding, MayShowAwayFromHomeAlone) {
  EXPECT_FALSE(checked_of(cranks(0.0)).mechanism.precision.rounded());
  for (const double shorter : {1e-9, 1e-6, 1e-5}) {
    const Checked found = checked_of(cranks(shorter));
    EXPECT_LT(found.home.below_gap().value(), 1e-14) << "so that it does not show at home";
    EXPECT_TRUE(found.mechanism.precision.rounded()) << shorter;
    EXPECT_EQ(found.home.rank, 5u);
    EXPECT_GT(found.mismatch, 0.01 * shorter);
    EXPECT_LT(found.mismatch, shorter);
  }
}

/// Exact files must not be treated as rounded.
TEST(Rounding, ExactFilesStayExact) {
  for (const char* name : {"rps3", "ups6", "sps6", "upr2-rpu", "tripteron", "rrr3", "press", "odd6", "mixed6", "3-rps",
                           "3-prs", "2upr-rpu", "3-rrr", "6-ups"}) {
    const Checked found = checked(from_file(name), Workspace::in_reach);
    EXPECT_FALSE(found.mechanism.precision.rounded()) << name;
    EXPECT_EQ(found.mechanism.precision.rank_threshold, kRankThreshold) << name;
    EXPECT_EQ(found.mismatch, 0.0) << name;
  }
}

/// Errors in the plane cause no gap above the rounding threshold; errors out of the plane do.
TEST(Rounding, IsBelowWhatDeforms) {
  const std::unique_ptr<Model> model = model_of(rrr3(3.7e-6));
  const double rounding = model->description().deformation->rounding;
  const auto gap = [&](const char* name, double size) {
    std::vector<double> errors = none(*model);
    errors[model->description().find_factor(name)->value] = size;
    return responses_of(*model, {0.03, -0.02, 0.2}, errors)[0];
  };
  EXPECT_LE(gap("delta_1_1_x", 1e-3), rounding);
  EXPECT_LE(gap("epsilon_3_0_z", 1e-2), rounding);
  EXPECT_GT(gap("delta_1_1_z", 1e-4), rounding);
}

TEST(Rounding, SaysWhatTheNumbersLeave) {
  const std::unique_ptr<Model> model = model_of(rrr3(3.7e-6));
  ASSERT_EQ(model->remarks().size(), 1u);
  EXPECT_TRUE(model->remarks().front().starts_with("the file's numbers leave up to ")) << model->remarks().front();
  EXPECT_NE(model->remarks().front().find(" um between the limbs"), std::string::npos) << model->remarks().front();
  EXPECT_NE(model->mobility()[2].find("of the largest count as zero"), std::string::npos) << model->mobility()[2];
  EXPECT_TRUE(model_of(rrr3(0.0))->remarks().empty());
}

/// The geometry of a study may be rounded even if that of the file is exact.
TEST(Rounding, OfAnotherGeometry) {
  std::string text = cranks(0.0);
  const std::string last = "[\"200 mm\", \"100 mm\", 0]";
  text.replace(text.find(last), last.size(), "[\"200 mm\", \"length\", 0]");
  text.insert(text.find("[platform]"), "[geometry]\nlength = \"100 mm\"\n");
  const CatalogEntry entry = catalog_entry(text, "m.toml");
  EXPECT_TRUE(entry.build(std::array{0.1}, 0)->remarks().empty());
  const std::unique_ptr<Model> model = entry.build(std::array{0.100001}, 0);
  EXPECT_EQ(model->remarks().size(), 1u);
  EXPECT_FALSE(model->unreachable(std::array{0.05}));
}

/// The text of a spherical 3-RRR. All axes go through the origin, except that joint B of limb 2 is off by `beside`
/// (mm); empty: no offset.
std::string spherical(const std::string& beside) {
  std::string text =
      "format = \"poesy-mechanism\"\nversion = 1\nname = \"eye\"\n[platform]\norigin = [0, 0, 0]\n"
      "coordinates = [\"rx\", \"ry\", \"rz\"]\nworkspace = { rx = [\"-20 deg\", \"20 deg\"], ry = [\"-20 deg\", "
      "\"20 deg\"], rz = [\"-20 deg\", \"20 deg\"] }\n";
  const auto joint = [&](int axis, const std::string& name, const std::string& more) {
    std::array<std::string, 3> point{"0", "0", "0"};
    point[static_cast<std::size_t>(axis % 3)] = "\"100 mm\"";
    if (!beside.empty() && name == "B" && axis == 2) point[0] = "\"" + beside + " mm\"";
    return "{ name = \"" + name + "\", type = \"R\", at = [" + point[0] + ", " + point[1] + ", " + point[2] +
           "], axis = \"" + "xyz"[axis % 3] + "\"" + more + " }";
  };
  for (int i = 0; i < 3; ++i) {
    text += "[[limb]]\njoints = [ " + joint(i, "A", ", actuated = true") + ",\n  " + joint(i + 1, "B", "") + ",\n  " +
            joint(i + 2, "C", "") + " ]\n";
  }
  return text;
}

TEST(Rounding, NamesTheJointWhoseNumbersWouldDo) {
  const std::string axis = problem_of(rrr3(5e-3));
  EXPECT_TRUE(
      axis.starts_with("m.toml:17:3: the limbs do not fit each other: in the workspace they hold the platform "
                       "up to "))
      << axis;
  EXPECT_NE(axis.find("look at joint 'B' of limb 2: with its axis along ("), std::string::npos) << axis;
  EXPECT_NE(axis.find(") instead of (0.00499994, 0, 0.999988), "), std::string::npos) << axis;
  EXPECT_NE(problem_of(rrr3(0.02)).find("look at joint 'B' of limb 2: with its axis along ("), std::string::npos)
      << problem_of(rrr3(0.02));
  EXPECT_EQ(problem_of(spherical("")), "read");
  EXPECT_EQ(problem_of(spherical("0.001")), "read");
  const std::string point = problem_of(spherical("0.5"));
  EXPECT_NE(point.find("look at joint 'B' of limb 2: with its point at ("), std::string::npos) << point;
  EXPECT_NE(point.find(", 100) mm instead of (0.5, 0, 100) mm, "), std::string::npos) << point;
}

TEST(Rounding, LeavesMistakesMistakes) {
  EXPECT_NE(problem_of(rrr3(0.1)).find("platform.coordinates are not independent"), std::string::npos)
      << problem_of(rrr3(0.1));
}

/// In a branched file, the message names the wrong joint and its limb.
TEST(MisfitOfBranched, NamesTheJoint) {
  const std::string problem = problem_of(cut_rrr3(3e-3));
  EXPECT_NE(problem.find("the limbs do not fit each other"), std::string::npos) << problem;
  EXPECT_NE(problem.find("look at joint 'B' of limb 3"), std::string::npos) << problem;
}

}  // namespace
}  // namespace poesy::file
