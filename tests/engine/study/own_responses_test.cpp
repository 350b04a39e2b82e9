#include "engine/model/own_responses.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "engine/kinds/study_file.h"
#include "models/registry.h"
#include "tests/support/input_error.h"

// Tests the responses that a study defines with [[response]], and the mistakes that are refused.
namespace poesy {
namespace {

constexpr const char* kTilt = "[[response]]\nname = \"tilt\"\nnorm = [\"theta_x\", \"theta_y\"]\n";
constexpr const char* kHeight = "[[response]]\nname = \"height\"\nsum = { z = 2, theta_x = \"-20 mm\" }\n";

std::string study_text(const std::string& responses, const std::string& keys = "") {
  return "format = \"poesy-study\"\nversion = 1\n" + responses +
         "[mechanism]\nmodel = \"3-prs\"\n[poses]\ncount = 2\n[analysis]\nkind = \"monte-carlo\"\n" + keys;
}

Study read(const std::string& responses, const std::string& keys = "") {
  return study_of_text(study_text(responses, keys), "study.toml", registry(), StudyUse::run);
}

std::size_t position_of(const ModelDescription& model, std::string_view name) {
  const auto found = std::ranges::find(model.responses, name, &Response::name);
  EXPECT_NE(found, model.responses.end()) << name;
  return static_cast<std::size_t>(found - model.responses.begin());
}

/// `count` random errors with the standard deviation 1e-4: 0.1 mm or 0.1 mrad.
std::vector<double> random_errors(std::size_t count, std::uint64_t seed = 4) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0.0, 1e-4);
  std::vector<double> errors(count);
  for (double& error : errors) error = normal(engine);
  return errors;
}

/// [responses] The responses to random errors at the middle of the workspace.
std::vector<double> responses_of(const Study& study) {
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const ModelDescription& description = model->description();
  const std::vector<double> errors = random_errors(description.factors.size());
  std::vector<double> pose;
  for (std::size_t c = 0; c < description.pose_lower.size(); ++c) {
    pose.push_back(0.5 * (description.pose_lower[c] + description.pose_upper[c]));
  }
  std::vector<double> responses(description.responses.size());
  SolveStatus status{};
  std::uint32_t iterations = 0;
  model->evaluator({})->evaluate({pose, errors, {}, {}, 1}, {responses, {&status, 1}, {&iterations, 1}, {}});
  EXPECT_TRUE(solved(status));
  const std::optional<SolveTrace> trace = model->trace(pose, errors, {});
  for (std::size_t r = 0; trace && r < responses.size(); ++r) EXPECT_NEAR(trace->responses[r], responses[r], 1e-12);
  return responses;
}

TEST(OwnResponses, AreFormedFromThoseOfTheMechanism) {
  for (const char* keys : {"", "calibrated = true\n"}) {
    const Study study = read(std::string(kTilt) + kHeight, keys);
    const std::vector<double> found = responses_of(study);
    const auto value = [&](std::string_view name) { return found[position_of(study.model(), name)]; };
    EXPECT_DOUBLE_EQ(value("tilt"), std::hypot(value("theta_x"), value("theta_y")));
    EXPECT_NEAR(value("height"), 2.0 * value("z") - 0.02 * value("theta_x"), 1e-19);
    const Study plain = read("", keys);
    const std::vector<double> before = responses_of(plain);
    EXPECT_EQ(before, std::vector(found.begin(), found.end() - 2));
  }
}

TEST(OwnResponses, AreDescribedAsWhatTheyAre) {
  const Study study = read(std::string(kTilt) + kHeight);
  const ModelDescription& model = study.model();
  const Response& tilt = model.responses[position_of(model, "tilt")];
  const Response& height = model.responses[position_of(model, "height")];
  EXPECT_EQ(tilt.dimension, Dimension::angle);
  EXPECT_EQ(height.dimension, Dimension::length);
  EXPECT_TRUE(tilt.is_magnitude());
  EXPECT_FALSE(height.is_magnitude());
  const std::vector components{position_of(model, "theta_x"), position_of(model, "theta_y")};
  EXPECT_EQ(tilt.components, components);
  EXPECT_EQ(height.description, "sum of -20 mm times theta_x and 2 times z, a response of one's own");
  ASSERT_GE(model.headline.size(), 2U);
  EXPECT_EQ(model.headline[0], position_of(model, "tilt"));
  const std::unique_ptr<Model> built = build_model(study.mechanism);
  EXPECT_EQ(built->description().responses.size(), model.responses.size());
}

TEST(OwnResponses, AreInTheResolvedText) {
  const Study study =
      read(std::string(kTilt) + kHeight + "description = \"by the probe\"\n", "limits = { tilt = \"1 mrad\" }\n");
  const std::string text = resolved_text(study);
  const Study again = study_of_text(text, "again.toml", registry(), StudyUse::run);
  EXPECT_EQ(resolved_text(again), text);
  EXPECT_EQ(responses_of(again), responses_of(study));
  EXPECT_EQ(again.model().responses.back().description, "by the probe");
  EXPECT_EQ(resolved_text(read("")).find("response"), std::string::npos);
}

// The direction of the line from the origin to the tip, which is 0.4 m long, as an angle.
TEST(OwnResponses, AreAnglesIfDisplacementsAreDividedByALength) {
  const Study study = read("[[response]]\nname = \"aim\"\nsum = { tip_x = \"1 / 400 mm\", x = \"-1/0.4 m\" }\n",
                           "limits = { aim = \"1 mrad\" }\n");
  const std::vector<double> found = responses_of(study);
  const ModelDescription& model = study.model();
  const auto value = [&](std::string_view name) { return found[position_of(model, name)]; };
  EXPECT_NEAR(value("aim"), (value("tip_x") - value("x")) / 0.4, 1e-17);
  const Response& aim = model.responses[position_of(model, "aim")];
  EXPECT_EQ(aim.dimension, Dimension::angle);
  EXPECT_EQ(aim.description, "sum of x over -400 mm and tip_x over 400 mm, a response of one's own");
  const std::string text = resolved_text(study);
  const Study again = study_of_text(text, "again.toml", registry(), StudyUse::run);
  EXPECT_EQ(resolved_text(again), text);
  EXPECT_EQ(responses_of(again), found);
}

TEST(OwnResponses, AreDisplacementsAlongADirection) {
  const Study study = read(
      "[[response]]\nname = \"edge\"\npoint = \"tip\"\ndirection = [3, 0, -4]\n"
      "[[response]]\nname = \"rise\"\npoint = \"origin\"\ndirection = [0, 0, 1e-3]\n");
  const std::vector<double> found = responses_of(study);
  const ModelDescription& model = study.model();
  const auto value = [&](std::string_view name) { return found[position_of(model, name)]; };
  EXPECT_NEAR(value("edge"), 0.6 * value("tip_x") - 0.8 * value("tip_z"), 1e-19);
  EXPECT_DOUBLE_EQ(value("rise"), value("z"));
  const Response& edge = model.responses[position_of(model, "edge")];
  EXPECT_FALSE(edge.is_magnitude());
  EXPECT_EQ(edge.description, "displacement of tip along [3, 0, -4], a response of one's own");
  const std::string text = resolved_text(study);
  const Study again = study_of_text(text, "again.toml", registry(), StudyUse::run);
  EXPECT_EQ(resolved_text(again), text);
  EXPECT_EQ(responses_of(again), found);
}

TEST(OwnResponses, MayBeFormedOfEachOther) {
  const Study study = read(std::string(kHeight) +
                           "[[response]]\nname = \"twice\"\nsum = { height = 2 }\n"
                           "[[response]]\nname = \"far\"\nnorm = [\"twice\", \"x\"]\n");
  const std::vector<double> found = responses_of(study);
  const auto value = [&](std::string_view name) { return found[position_of(study.model(), name)]; };
  EXPECT_DOUBLE_EQ(value("twice"), 2.0 * value("height"));
  EXPECT_DOUBLE_EQ(value("far"), std::hypot(value("twice"), value("x")));
  EXPECT_EQ(resolved_text(study_of_text(resolved_text(study), "a.toml", registry(), StudyUse::run)),
            resolved_text(study));
}

constexpr const char* kZero = "relative_to = { alpha = 0, beta = \"3 deg\", z = \"650 mm\" }\n";
constexpr const char* kPrevious = "relative_to = \"previous\"\n";
constexpr const char* kMachines = "draws = \"per machine\"\n";
constexpr const char* kRise = "[[response]]\nname = \"rise\"\nsum = { z = 1, theta_x = \"-20 mm\" }\n";

/// One evaluator that evaluates blocks of three samples at one pose after the other.
class Poses {
 public:
  explicit Poses(const Study& study)
      : model_(build_model(study.mechanism)), evaluator_(model_->evaluator({})), description_(study.model()) {}

  /// [responses x 3] Responses of three random machines. previous: the pose before this one; empty if there is none.
  std::vector<double> at(const std::vector<double>& pose, std::span<const double> previous, std::uint64_t seed) {
    const std::vector<double> none(description_.factors.size(), 0.0);
    std::vector<FactorIndex> varied;
    for (std::size_t f = 0; f < none.size(); ++f) varied.emplace_back(f);
    const std::vector<double> values = random_errors(3 * none.size(), seed);
    std::vector<double> responses(3 * description_.responses.size());
    evaluator_->evaluate({pose, none, varied, values, 3, 0.0, previous}, {responses, status_, iterations_, {}});
    return responses;
  }
  std::size_t row(std::string_view name) const { return 3 * position_of(description_, name); }
  std::span<const SolveStatus> status() const { return status_; }

 private:
  std::unique_ptr<Model> model_;
  std::unique_ptr<Evaluator> evaluator_;
  ModelDescription description_;
  std::array<SolveStatus, 3> status_{};
  std::array<std::uint32_t, 3> iterations_{};
};

const std::vector<double> kReference{0.0, 3.0 * 3.14159265358979323846 / 180.0, 0.65};
const std::vector<std::vector<double>> kPoses{{0.1, 0.0, 0.6}, {-0.05, 0.1, 0.62}, {0.1, 0.0, 0.6}, {0.0, 0.02, 0.7}};

TEST(RelativeResponses, AreLessTheirValueAtThePose) {
  for (const char* keys : {"", "calibrated = true\n"}) {
    const std::string analysis = std::string(kMachines) + keys;
    const Study study =
        read(kRise + std::string(kZero) + kTilt + kZero + "[[response]]\nname = \"step\"\nsum = { x = 1 }\n" + kZero,
             analysis);
    const Study plain = read(kRise, analysis);
    Poses relative(study);
    for (const std::uint64_t seed : {1U, 2U}) {
      for (const std::vector<double>& pose : kPoses) {
        const std::vector<double> found = relative.at(pose, {}, seed);
        Poses fresh(plain);
        const std::vector<double> here = fresh.at(pose, {}, seed);
        const std::vector<double> there = fresh.at(kReference, {}, seed);
        for (std::size_t b = 0; b < 3; ++b) {
          const auto less = [&](std::string_view name) {
            return here[fresh.row(name) + b] - there[fresh.row(name) + b];
          };
          EXPECT_NEAR(found[relative.row("rise") + b], less("rise"), 1e-16);
          EXPECT_NEAR(found[relative.row("step") + b], less("x"), 1e-16);
          EXPECT_NEAR(found[relative.row("tilt_theta_y") + b], less("theta_y"), 1e-16);
          EXPECT_NEAR(found[relative.row("tilt") + b], std::hypot(less("theta_x"), less("theta_y")), 1e-16);
          EXPECT_EQ(found[relative.row("z") + b], here[fresh.row("z") + b]);
        }
      }
    }
    const std::vector<double> zero = relative.at(kReference, {}, 5);
    EXPECT_EQ(zero[relative.row("rise")], 0.0);
    EXPECT_EQ(zero[relative.row("tilt")], 0.0);
  }
}

// An evaluator reuses results of the block before. Its responses must not depend on this.
TEST(RelativeResponses, AreLessTheirValueAtThePoseBefore) {
  const Study study = read(kRise + std::string(kPrevious) + kTilt + kPrevious, kMachines);
  Poses remembering(study);
  Poses plain(read(kRise, kMachines));
  for (const std::uint64_t seed : {1U, 2U}) {
    for (std::size_t m = 0; m < kPoses.size(); ++m) {
      const std::span<const double> before = m == 0 ? std::span<const double>() : std::span(kPoses[m - 1]);
      const std::vector<double> found = remembering.at(kPoses[m], before, seed);
      EXPECT_EQ(found, Poses(study).at(kPoses[m], before, seed));
      const std::vector<double> here = plain.at(kPoses[m], {}, seed);
      const std::vector<double> there = plain.at(kPoses[m == 0 ? 0 : m - 1], {}, seed);
      for (std::size_t b = 0; b < 3; ++b) {
        const auto less = [&](std::string_view name) { return here[plain.row(name) + b] - there[plain.row(name) + b]; };
        EXPECT_NEAR(found[remembering.row("rise") + b], less("rise"), 1e-16);
        EXPECT_NEAR(found[remembering.row("tilt") + b], std::hypot(less("theta_x"), less("theta_y")), 1e-16);
      }
    }
  }
}

TEST(RelativeResponses, AreDescribedAndResolved) {
  const Study study = read(kRise + std::string(kZero) + kTilt + kZero + "[[response]]\nname = \"step\"\n" +
                               "point = \"tip\"\ndirection = [0, 0, 1]\n" + kPrevious,
                           kMachines);
  const ModelDescription& model = study.model();
  const Response& tilt = model.responses[position_of(model, "tilt")];
  EXPECT_EQ(tilt.components, (std::vector{position_of(model, "tilt_theta_x"), position_of(model, "tilt_theta_y")}));
  EXPECT_EQ(model.responses[position_of(model, "tilt_theta_x")].description,
            "theta_x, a response of one's own, less its value at alpha = 0 deg, beta = 3 deg, z = 650 mm");
  EXPECT_NE(model.responses[position_of(model, "step")].description.find("less its value at the pose before"),
            std::string::npos);
  const std::string text = resolved_text(study);
  EXPECT_NE(text.find("relative_to = { alpha = \"0 rad\""), std::string::npos) << text;
  const Study again = study_of_text(text, "again.toml", registry(), StudyUse::run);
  EXPECT_EQ(resolved_text(again), text);
  Poses one(study);
  Poses other(again);
  EXPECT_EQ(one.at(kPoses[0], kPoses[1], 3), other.at(kPoses[0], kPoses[1], 3));
  const std::vector<std::string> remarks = build_model(study.mechanism)->remarks();
  EXPECT_TRUE(
      std::ranges::any_of(remarks, [](const std::string& remark) { return remark.starts_with("rise is less"); }));
}

/// A model with one coordinate and one error; the response is their product. At the pose 1 the error determines the
/// status of the solve.
class Product final : public Model {
 public:
  Product() {
    description_.pose_coordinates = {{"q", Dimension::number, ""}};
    description_.factors = {{"e", Dimension::number, 1, 0, ""}};
    description_.responses = {{"y", Dimension::number, ""}};
  }
  const ModelDescription& description() const override { return description_; }
  std::optional<std::string> unreachable(std::span<const double>) const override { return std::nullopt; }
  std::vector<double> joint_displacements(std::span<const double>) const override { return {}; }
  double condition(std::span<const double>) const override { return 1.0; }
  std::unique_ptr<Evaluator> evaluator(const SolverOptions&) const override {
    struct OfProduct final : Evaluator {
      void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
        for (std::size_t b = 0; b < samples.values.size() && !samples.pose.empty(); ++b) {
          outcomes.responses[b] = samples.pose[0] * samples.values[b];
          const auto named = static_cast<SolveStatus>(std::lround(samples.values[b]));
          outcomes.status[b] = samples.pose[0] == 1.0 ? named : SolveStatus::stagnated;
          outcomes.iterations[b] = 1;
        }
      }
    };
    return std::make_unique<OfProduct>();
  }

 private:
  ModelDescription description_;
};

TEST(RelativeResponses, FailWhereAMachineFailsAtThePose) {
  OwnResponse own{"own", Dimension::number, false, {{0}}};
  for (const std::vector<double>& reference : {std::vector{1.0}, std::vector<double>()}) {
    own.relative_to = ReferencePose{reference, {}};
    const std::unique_ptr<Model> model = with_responses(std::make_unique<Product>(), {own});
    const std::vector<double> values{0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
    const std::vector<FactorIndex> varied{FactorIndex(0)};
    const std::unique_ptr<Evaluator> evaluator = model->evaluator({});
    for (const double pose : {3.0, 2.0}) {
      std::vector<double> responses(12);
      std::array<SolveStatus, 6> status{};
      std::array<std::uint32_t, 6> iterations{};
      evaluator->evaluate({{&pose, 1}, {values.data(), 1}, varied, values, 6, 0.0, std::array{1.0}},
                          {responses, status, iterations, {}});
      for (std::size_t b = 0; b < 6; ++b) {
        EXPECT_EQ(status[b], b < 2 ? SolveStatus::stagnated : static_cast<SolveStatus>(b));
        EXPECT_EQ(responses[6 + b], (pose - 1.0) * values[b]);
      }
    }
  }
}

TEST(RelativeResponses, TakeNoErrorsThatAreDrawnAnewAtEachPose) {
  const std::string errors =
      "[errors]\noverride = { a_x_1 = { distribution = \"normal\", sigma = \"1 um\", draws = \"per pose\" } }\n";
  const auto study = [&](const std::string& responses) { return read(responses, kMachines + errors); };
  EXPECT_EQ(test::refusal_of([&] { study(kRise); }), "");
  const std::string refusal = test::refusal_of([&] { study(kRise + std::string(kZero)); });
  EXPECT_NE(refusal.find(
                "machines draw 'a_x_1' anew at each pose, and 'rise' is the difference from its value at another pose"),
            std::string::npos)
      << refusal;
}

TEST(OwnResponses, AreRefusedWithPlaceAndRemedy) {
  const auto refused = [](const std::string& marked, const std::vector<std::string>& words,
                          const std::string& keys = kMachines) {
    SCOPED_TRACE(marked);
    const test::Marked text(study_text(marked, keys));
    test::expect_input_error([&] { study_of_text(text.text, "study.toml", registry(), StudyUse::run); },
                             {"study.toml", text.line, text.column}, words);
  };
  const std::string head = "[[response]]\n";
  const std::string named = head + "name = \"a\"\n";
  refused("response = ^1\n", {"response", "list"});
  refused("^" + head + "norm = [\"x\", \"y\"]\n", {"name", "e.g. name = \"tilt\""});
  refused(head + "name = ^\"Tilt\"\nnorm = [\"x\", \"y\"]\n", {"response[0].name is 'Tilt'", "small letters"});
  refused(head + "name = ^\"\"\nnorm = [\"x\", \"y\"]\n", {"response[0].name", "small letters"});
  refused(head + "name = ^\"position\"\nnorm = [\"x\", \"y\"]\n", {"name of another response", "another name"});
  refused(std::string(kTilt) + head + "name = ^\"tilt\"\nnorm = [\"x\", \"y\"]\n",
          {"for the second time", "another name"});
  refused("^" + named, {"neither a norm nor a sum", "write one of them"});
  refused("^" + named + "norm = [\"x\", \"y\"]\nsum = { z = 1 }\n", {"a norm and a sum", "write one of them"});
  refused(named + "norm = ^[]\n", {"response[0].norm is empty", "at least two"});
  refused(named + "norm = ^[\"x\"]\n", {"names one response", "at least two"});
  refused(named + "norm = ^\"x\"\n", {"response[0].norm", "list"});
  refused(named + "norm = [\"x\", ^\"theta_u\"]\n", {"names 'theta_u'", "theta_"});
  refused(named + "norm = [\"x\", ^\"x\"]\n", {"for the second time", "once"});
  refused(named + "norm = [\"x\", ^\"theta_x\"]\n", {"is an angle, but the first one is a length", "one dimension"});
  refused(named + "norm = [\"x\", ^1]\n", {"response[0].norm[1]", "text"});
  refused(named + "sum = ^{}\n", {"response[0].sum is empty", "sum = { z = 1 }"});
  refused(named + "sum = ^[\"z\"]\n", {"response[0].sum is a list", "key = value"});
  refused(named + "sum = { z = ^0 }\n", {"response[0].sum.z is 0", "leave the response out"});
  refused(named + "sum = { position = ^1 }\n", {"which has no sign", "norm"});
  refused(named + "sum = { z = ^\"20 mm\" }\n", {"is a length", "weigh it with a number"});
  refused(named + "sum = { z = ^\"20 deg\" }\n", {"response[0].sum.z", "length"});
  refused(named + "sum = { theta_x = ^\"1 / 20 mm\" }\n", {"is a number over a length", "weigh it with a number"});
  refused(named + "sum = { z = ^\"1 / L\" }\n", {"cannot be read", "mm"});
  refused(named + "sum = { z = ^\"L / 20 mm\" }\n", {"'L / 20 mm', which has no number before the '/'", "1 / 20 mm"});
  refused(named + "sum = { z = ^\"1 / 0 mm\" }\n", {"divides by a length of 0", "1 / 20 mm"});
  refused(named + "sum = { z = ^\"1 / 1e-310 m\" }\n", {"is not finite", "1 / 20 mm"});
  refused(named + "sum = { theta_x = 1, z = ^1 }\n", {"makes a length, but the first term is an angle", "20 mm"});
  refused(named + "sum = { zz = ^1 }\n", {"names 'zz'", "z"});
  refused(named + "sum = { z = ^true }\n", {"response[0].sum.z", "number"});
  refused(named + "^norms = [\"x\", \"y\"]\n", {"unknown key 'norms'", "norm"});
  const std::string point = named + "point = \"tip\"\n";
  refused("^" + named + "direction = [0, 0, 1]\n", {"'point' is missing", "point = \"origin\""});
  refused(named + "point = ^\"tip\"\nsum = { z = 1 }\n", {"point has no direction", "direction = [0.6, 0, 0.8]"});
  refused("^" + point + "direction = [0, 0, 1]\nsum = { z = 1 }\n", {"a direction and a norm or sum", "one of them"});
  refused(named + "point = ^\"tpi\"\ndirection = [0, 0, 1]\n", {"'tpi', which is not a point", "tip"});
  refused(named + "point = ^\"theta\"\ndirection = [0, 0, 1]\n", {"'theta', which is not a point", "origin, tip"});
  refused(named + "point = ^1\ndirection = [0, 0, 1]\n", {"response[0].point", "text"});
  refused(point + "direction = ^[0, 0, 0]\n", {"direction has no length", "[0, 0, 1]"});
  refused(point + "direction = ^[0, 1]\n", {"direction", "three numbers"});
  refused(point + "direction = [0, ^\"1 mm\", 0]\n", {"direction[1]", "number"});
  refused(point + "direction = ^\"z\"\n", {"direction", "list"});
  const std::string height = named + "sum = { z = 1 }\n";
  refused(height + "relative_to = ^\"home\"\n", {"is 'home'", "\"previous\", or a pose such as { alpha = "});
  refused(height + "relative_to = ^1\n", {"relative_to", "key = value"});
  refused(height + "relative_to = ^{ alpha = 0, beta = 0 }\n", {"z", "give every coordinate, e.g. { alpha = "});
  refused(height + "relative_to = { alpha = 0, beta = 0, z = \"600 mm\", ^x = 0 }\n",
          {"unknown coordinate 'x'", "alpha"});
  refused(height + "relative_to = { alpha = 0, beta = 0, z = ^\"6 deg\" }\n", {"relative_to.z", "length"});
  refused(height + "relative_to = { alpha = 0, beta = 0, z = ^600 }\n", {"relative_to.z", "mm"});
  refused(height + "relative_to = ^{ alpha = 0, beta = 0, z = \"9 m\" }\n",
          {"'a' is relative to a pose that the mechanism does not reach", "a pose of the workspace"});
  refused(height + "relative_to = ^\"previous\"\n", {"'a' is relative to the pose before", "per machine"},
          "draws = \"per pose\"\n");
  refused(kRise + std::string(kZero) + named + "sum = { rise = 1 }\nrelative_to = ^\"previous\"\n",
          {"made of 'rise', which is relative to a pose itself", "leave out one of them"});
  refused(named + "norm = [^\"position\", \"x\"]\n" + kZero, {"no sign", "components"});
  refused("[[response]]\nname = \"a_x\"\nsum = { z = 1 }\n" + named + "norm = [^\"x\", \"y\"]\n" + kZero,
          {"gives a response 'a_x', which there is already", "another name"});
}

}  // namespace
}  // namespace poesy
