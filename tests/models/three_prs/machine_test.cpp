#include "models/three_prs/model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "models/registry.h"
#include "models/three_prs/evaluators.h"
#include "models/three_prs/slides.h"
#include "tests/models/three_prs/reference.h"

namespace poesy::three_prs {
namespace {

const ModelDescription kMachine = machine_catalog_entry().description;
const ModelDescription kHead = catalog_entry().description;
constexpr std::size_t kAll = kFactors + kSlideFactors;
constexpr std::array kFidelities{"exact", "first-order"};

std::vector<double> published_geometry() {
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : kMachine.geometry) geometry.push_back(parameter.published);
  return geometry;
}

std::unique_ptr<Model> machine(std::string_view fidelity) {
  return machine_catalog_entry().build(published_geometry(), fidelity == "exact" ? 0 : 1);
}

/// Random poses: the head in its default workspace, and the slides within their travel (m).
std::vector<std::vector<double>> machine_poses(std::size_t count, unsigned seed) {
  std::vector<std::vector<double>> poses = random_poses(count, seed);
  std::mt19937_64 engine(seed + 1000);
  std::uniform_real_distribution<double> slide(-0.3, 0.3);
  for (std::vector<double>& pose : poses) pose.insert(pose.end(), {slide(engine), slide(engine)});
  return poses;
}

std::span<const double> head_of(const std::vector<double>& pose) { return std::span(pose).first(3); }

std::size_t place(const char* name) { return kMachine.find_factor(name)->value; }

/// Random normal errors. head, slides: standard deviations of their errors (m, rad).
std::vector<double> random_errors(std::mt19937_64& engine, double head, double slides) {
  std::vector<double> errors(kAll);
  std::normal_distribution<double> normal;
  for (std::size_t f = 0; f < kAll; ++f) errors[f] = (f < kFactors ? head : slides) * normal(engine);
  return errors;
}

/// The outcomes of a block of samples.
struct Block {
  explicit Block(std::size_t count) : responses(12 * count), details(3 * count), status(count), iterations(count) {}
  OutcomeBlock outcomes() { return {responses, status, iterations, details}; }

  std::vector<double> responses, details;
  std::vector<SolveStatus> status;
  std::vector<std::uint32_t> iterations;
};

TEST(Machine, WithoutSlideErrorsIsTheHeadAnywhere) {
  std::mt19937_64 engine(21);
  for (const char* fidelity : kFidelities) {
    const auto whole = machine(fidelity);
    const auto head = published(fidelity);
    for (std::vector<double>& pose : machine_poses(50, 20)) {
      const std::vector<double> errors = random_errors(engine, 1e-3, 0.0);
      for (const bool at_zero : {false, true}) {
        if (at_zero) pose[3] = pose[4] = 0.0;
        const Solved expected = solve(*head, head_of(pose), std::span(errors).first(kFactors));
        const Solved found = solve(*whole, pose, errors);
        for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(found.responses[r], expected.responses[r], 1e-15);
        for (std::size_t r = 3; r < 9; ++r) EXPECT_EQ(found.responses[r], expected.responses[r]);
        EXPECT_NEAR(found.responses[9], expected.responses[9], 1e-15);
        for (std::size_t r = 10; r < 12; ++r) EXPECT_DOUBLE_EQ(found.responses[r], expected.responses[r]);
        EXPECT_EQ(found.swing, expected.swing);
        EXPECT_EQ(found.status, expected.status);
        EXPECT_EQ(found.iterations, expected.iterations);
      }
    }
  }
}

TEST(Slides, EveryColumnIsTheDerivativeOfTheExactMachine) {
  const auto exact = machine("exact");
  const auto first_order = machine("first-order");
  for (const std::vector<double>& pose : machine_poses(20, 22)) {
    for (std::size_t f = kFactors; f < kAll; ++f) {
      const double step = 1e-5;
      std::vector<double> errors(kAll, 0.0);
      errors[f] = step;
      const Solved above = solve(*exact, pose, errors);
      const Solved linear = solve(*first_order, pose, errors);
      errors[f] = -step;
      const Solved below = solve(*exact, pose, errors);
      Eigen::Matrix<double, 9, 1> difference, column;
      for (std::size_t r = 0; r < 9; ++r) {
        difference[Eigen::Index(r)] = (above.responses[r] - below.responses[r]) / (2 * step);
        column[Eigen::Index(r)] = linear.responses[r] / step;
      }
      EXPECT_LE((difference - column).norm(), 1e-7 * column.norm()) << kMachine.factors[f].name;
    }
  }
}

// An independent composition of the machine: each joint and each error is a 4 x 4 matrix.

using Matrix4 = Eigen::Matrix4d;

Matrix4 shift(double x, double y, double z) {
  Matrix4 m = Matrix4::Identity();
  m.topRightCorner<3, 1>() = Eigen::Vector3d(x, y, z);
  return m;
}

Matrix4 turn(const Eigen::Vector3d& w) {
  Matrix4 m = Matrix4::Identity();
  if (w.norm() > 0.0) m.topLeftCorner<3, 3>() = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
  return m;
}

/// The transform from the rack to the head frame. The squareness error turns the direction of the y slide, but not the
/// head.
Matrix4 rack_M_head(const std::vector<double>& pose, std::span<const double> errors) {
  const auto e = [&](const char* name) { return errors[place(name)]; };
  const Matrix4 x_carriage = shift(pose[3] + e("x_position"), e("x_straightness_y"), e("x_straightness_z")) *
                             turn({e("x_roll"), e("x_pitch"), e("x_yaw")});
  const Matrix4 y_carriage = shift(e("y_straightness_x"), pose[4] + e("y_position"), e("y_straightness_z"));
  const Eigen::Vector3d out_of_square(0.0, 0.0, e("squareness"));
  return x_carriage * turn(out_of_square) * y_carriage * turn(-out_of_square) *
         turn({e("y_pitch"), e("y_roll"), e("y_yaw")});
}

/// The transform from the head frame to the platform, displaced by motion = [theta; dr] (rad, m).
Matrix4 head_M_platform(const std::vector<double>& pose, std::span<const double> motion) {
  const lie::Transform<double> nominal = base_T_platform({}, {pose[0], pose[1], pose[2]});
  Matrix4 m = shift(nominal.p.x() + motion[3], nominal.p.y() + motion[4], nominal.p.z() + motion[5]);
  m.topLeftCorner<3, 3>() = turn({motion[0], motion[1], motion[2]}).topLeftCorner<3, 3>() * nominal.R;
  return m;
}

TEST(Machine, ExactIsTheProductOfItsParts) {
  const auto whole = machine("exact");
  const auto head = published("exact");
  const Matrix4 tool = shift(0.0, 0.0, Geometry{}.h);
  const std::vector<double> none(kAll, 0.0);
  std::mt19937_64 engine(24);
  for (const std::vector<double>& pose : machine_poses(100, 23)) {
    const std::vector<double> errors = random_errors(engine, 1e-3, 2e-2);
    const Solved in_head = solve(*head, head_of(pose), std::span(errors).first(kFactors));
    const Solved found = solve(*whole, pose, errors);
    const Matrix4 nominal = rack_M_head(pose, none) * head_M_platform(pose, none);
    const Matrix4 actual = rack_M_head(pose, errors) * head_M_platform(pose, in_head.responses);
    const Eigen::AngleAxisd rotation(
        Eigen::Matrix3d(actual.topLeftCorner<3, 3>() * nominal.topLeftCorner<3, 3>().transpose()));
    const Eigen::Vector3d theta = rotation.angle() * rotation.axis();
    const Matrix4 P = actual - nominal;
    const Matrix4 tip = actual * tool - nominal * tool;
    for (int k = 0; k < 3; ++k) {
      const auto r = static_cast<std::size_t>(k);
      EXPECT_NEAR(found.responses[r], theta[k], 1e-13);
      EXPECT_NEAR(found.responses[3 + r], P(k, 3), 1e-14);
      EXPECT_NEAR(found.responses[6 + r], tip(k, 3), 1e-14);
    }
    EXPECT_DOUBLE_EQ(found.responses[9], lie::Vector3<double>(found.responses.data()).norm());
    EXPECT_DOUBLE_EQ(found.responses[11], lie::Vector3<double>(found.responses.data() + 6).norm());
    EXPECT_EQ(found.swing, in_head.swing);
  }
}

TEST(Machine, FirstOrderIsTheSumOfHeadAndSlides) {
  const auto model = machine("first-order");
  std::mt19937_64 engine(26);
  for (const std::vector<double>& pose : machine_poses(20, 25)) {
    const std::vector<double> both = random_errors(engine, 1e-3, 1e-3);
    std::vector<double> head = both, slides = both;
    std::fill(head.begin() + kFactors, head.end(), 0.0);
    std::fill(slides.begin(), slides.begin() + kFactors, 0.0);
    const Solved sum = solve(*model, pose, both), a = solve(*model, pose, head), b = solve(*model, pose, slides);
    for (std::size_t r = 0; r < 9; ++r) EXPECT_NEAR(sum.responses[r], a.responses[r] + b.responses[r], 1e-16);
    EXPECT_EQ(sum.swing, a.swing);
  }
}

TEST(Machine, HeadAndSlideErrorsCoupleToSecondOrder) {
  // The exact machine differs from the first order quadratically: with a tenth of the errors, the difference is a
  // hundredth.
  const auto exact = machine("exact");
  const auto first_order = machine("first-order");
  std::mt19937_64 engine(27);
  for (const std::vector<double>& pose : machine_poses(20, 28)) {
    std::vector<double> errors = random_errors(engine, 1e-3, 1e-3);
    const auto distance = [&] {
      const Solved a = solve(*exact, pose, errors), b = solve(*first_order, pose, errors);
      return (lie::Vector3<double>(a.responses.data() + 6) - lie::Vector3<double>(b.responses.data() + 6)).norm();
    };
    const double large = distance();
    for (double& error : errors) error *= 0.1;
    EXPECT_GT(large, 0.0);
    EXPECT_NEAR(distance() / large, 0.01, 0.002);
  }
}

TEST(Slides, SquarenessMovesAcrossInProportionToY) {
  const double squareness = 1e-4;
  std::vector<double> errors(kAll, 0.0);
  errors[place("squareness")] = squareness;
  for (const std::vector<double>& pose : machine_poses(20, 29)) {
    const double y = pose[4];
    const Solved linear = solve(*machine("first-order"), pose, errors);
    const Solved exact = solve(*machine("exact"), pose, errors);
    for (const std::size_t point : {3U, 6U}) {
      EXPECT_NEAR(linear.responses[point], -squareness * y, 1e-18);
      EXPECT_EQ(linear.responses[point + 1], 0.0);
      EXPECT_NEAR(exact.responses[point], -std::sin(squareness) * y, 1e-15);
      EXPECT_NEAR(exact.responses[point + 1], (std::cos(squareness) - 1.0) * y, 1e-15);
      EXPECT_NEAR(exact.responses[point + 2], 0.0, 1e-15);
    }
    EXPECT_EQ(linear.responses[9], 0.0);
    EXPECT_LE(exact.responses[9], 1e-15);
  }
}

/// The errors with these names, in this order.
std::vector<FactorIndex> factors_named(std::initializer_list<const char*> names) {
  std::vector<FactorIndex> list;
  for (const char* name : names) list.push_back(*kMachine.find_factor(name));
  return list;
}

TEST(Machine, BlocksEqualSingleSolvesForAnyMixAndOrder) {
  constexpr std::size_t kCount = 70;
  std::mt19937_64 engine(31);
  const std::vector<double> pose{0.1, -0.2, 0.8, 0.25, -0.15};
  const std::vector<double> constant = random_errors(engine, 1e-4, 1e-4);
  std::normal_distribution<double> normal(0.0, 2e-3);
  for (const char* fidelity : kFidelities) {
    const auto model = machine(fidelity);
    const auto evaluator = model->evaluator({});
    for (const auto& varied : {factors_named({"theta_A_x_2", "x_yaw", "y_position"}),
                               factors_named({"squareness", "c_y_3", "x_roll", "q_1"}), factors_named({"y_roll"}),
                               factors_named({"q_2"}), factors_named({"x_pitch", "y_yaw"}), factors_named({})}) {
      std::vector<double> values(varied.size() * kCount);
      for (double& value : values) value = normal(engine);
      Block block(kCount);
      evaluator->evaluate({pose, constant, varied, values, kCount}, block.outcomes());
      std::vector<double> errors = constant;
      for (std::size_t b = 0; b < kCount; ++b) {
        for (std::size_t v = 0; v < varied.size(); ++v) errors[varied[v].value] = values[v * kCount + b];
        const Solved single = solve(*model, pose, errors);
        for (std::size_t r = 0; r < 12; ++r) EXPECT_NEAR(block.responses[r * kCount + b], single.responses[r], 1e-14);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(block.details[i * kCount + b], single.swing[i], 1e-14);
        EXPECT_TRUE(solved(block.status[b]));
      }
    }
  }
}

TEST(Machine, ASampleDoesNotDependOnItsNeighbours) {
  const std::size_t count = 70;
  std::mt19937_64 engine(32);
  const std::vector<double> pose{-0.2, 0.1, 0.75, -0.1, 0.3}, errors(kAll, 0.0);
  std::normal_distribution<double> normal(0.0, 1e-3);
  for (const char* fidelity : kFidelities) {
    const auto evaluator = machine(fidelity)->evaluator({});
    for (const char* set : {"all", "head", "slides"}) {
      const std::vector<FactorIndex>& varied = kMachine.find_set(set)->factors;
      std::vector<double> values(varied.size() * count);
      for (double& value : values) value = normal(engine);
      Block together(count);
      evaluator->evaluate({pose, errors, varied, values, count}, together.outcomes());
      for (std::size_t b = 0; b < count; ++b) {
        std::vector<double> own;
        for (std::size_t v = 0; v < varied.size(); ++v) own.push_back(values[v * count + b]);
        Block alone(1);
        evaluator->evaluate({pose, errors, varied, own, 1}, alone.outcomes());
        for (std::size_t r = 0; r < 12; ++r) EXPECT_EQ(together.responses[r * count + b], alone.responses[r]);
        EXPECT_EQ(together.iterations[b], alone.iterations[0]);
      }
    }
  }
}

/// A head that records the number of samples of each block that it evaluates.
class CountingHead final : public Evaluator {
 public:
  CountingHead(std::unique_ptr<Evaluator> head, std::vector<std::size_t>& asked)
      : head_(std::move(head)), asked_(asked) {}
  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    asked_.push_back(samples.count);
    head_->evaluate(samples, outcomes);
  }

 private:
  std::unique_ptr<Evaluator> head_;
  std::vector<std::size_t>& asked_;
};

TEST(Machine, AsksTheHeadOncePerBlockAndOneSampleWhereItDoesNotVary) {
  std::vector<std::size_t> asked;
  const auto evaluator =
      machine_evaluator({}, Fidelity::exact, std::make_unique<CountingHead>(published("exact")->evaluator({}), asked));
  const std::vector<double> pose{0.1, 0.1, 0.8, 0.1, 0.1}, errors(kAll, 1e-4), values(2 * 50, 1e-3);
  Block block(50);
  evaluator->evaluate({pose, errors, factors_named({"a_x_1", "x_roll"}), values, 50}, block.outcomes());
  evaluator->evaluate({pose, errors, factors_named({"x_yaw", "x_roll"}), values, 50}, block.outcomes());
  EXPECT_EQ(asked, (std::vector<std::size_t>{50, 1}));
}

TEST(Machine, StatusIsTheHeadsUnlessTheSlidesOverflow) {
  const std::vector<double> pose{0.1, 0.2, 0.7, 0.1, 0.1};
  std::vector<double> errors(kAll, 0.0);
  Block block(1);
  const auto status_with = [&](const char* fidelity, const SolverOptions& options) {
    machine(fidelity)->evaluator(options)->evaluate({pose, errors, {}, {}, 1}, block.outcomes());
    return block.status[0];
  };
  errors[place("a_x_1")] = 1e-3;
  EXPECT_EQ(status_with("exact", {.tolerance = 1e-8}), SolveStatus::converged);
  EXPECT_EQ(status_with("exact", {.max_iterations = 1}), SolveStatus::iteration_cap);
  EXPECT_EQ(status_with("first-order", {}), SolveStatus::converged);
  EXPECT_EQ(block.iterations[0], 1u);
  errors[place("x_position")] = 1e300;
  for (const char* fidelity : kFidelities) EXPECT_EQ(status_with(fidelity, {}), SolveStatus::non_finite);
  errors[place("x_position")] = 0.0;
  errors[place("a_x_1")] = 1e300;
  for (const char* fidelity : kFidelities) EXPECT_EQ(status_with(fidelity, {}), SolveStatus::non_finite);
}

TEST(TipChart, GivesThePoseWhoseTipItNames) {
  const auto model = machine("exact");
  const Matrix4 tool = shift(0.0, 0.0, Geometry{}.h);
  const std::vector<double> none(kAll, 0.0);
  ASSERT_EQ(kMachine.charts.size(), 1u);
  ASSERT_EQ(kMachine.charts[0].coordinates.size(), 5u);
  for (const std::vector<double>& pose : machine_poses(100, 33)) {
    const Matrix4 tip = rack_M_head(pose, none) * head_M_platform(pose, none) * tool;
    const std::vector<double> back =
        model->pose_from_chart(0, std::vector{pose[0], pose[1], tip(0, 3), tip(1, 3), tip(2, 3)}).value();
    ASSERT_EQ(back.size(), 5u);
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(back[k], pose[k], 1e-15);
  }
  EXPECT_FALSE(model->pose_from_chart(0, std::vector{1.6, 0.0, 0.0, 0.0, 0.9}));
  EXPECT_FALSE(model->pose_from_chart(0, std::vector{0.0, -1.6, 0.0, 0.0, 0.9}));
}

TEST(Machine, SaysWhyAPoseIsOutOfReach) {
  const auto model = machine("exact");
  const auto reason = [&](double alpha, double z, double x, double y) {
    return model->unreachable(std::vector{alpha, 0.0, z, x, y}).value_or("");
  };
  EXPECT_EQ(reason(0.1, 0.7, 0.3, -0.3), "");
  EXPECT_NE(reason(1.6, 0.7, 0.0, 0.0).find("alpha"), std::string::npos);
  EXPECT_NE(reason(0.0, 1.1, 0.0, 0.0).find("below the lower end"), std::string::npos);
  EXPECT_TRUE(reason(0.0, 0.7, 0.301, 0.0).starts_with("slide_x lies outside its travel"));
  EXPECT_TRUE(reason(0.0, 0.7, 0.0, -0.301).starts_with("slide_y lies outside its travel"));
  EXPECT_TRUE(reason(0.0, 0.7, std::nan(""), 0.0).starts_with("slide_x"));
}

TEST(Machine, JointsAndConditionAreTheHeadsWithTheSlides) {
  const auto whole = machine("exact");
  const auto head = published("exact");
  for (const std::vector<double>& pose : machine_poses(20, 34)) {
    std::vector<double> expected = head->joint_displacements(head_of(pose));
    expected.insert(expected.end(), {pose[3], pose[4]});
    EXPECT_EQ(whole->joint_displacements(pose), expected);
    EXPECT_EQ(whole->condition(pose), head->condition(head_of(pose)));
    EXPECT_EQ(whole->unreachable(pose), std::nullopt);
  }
  EXPECT_EQ(kMachine.joints.size(), kHead.joints.size() + 2);
  EXPECT_EQ(kMachine.joints.back().name, "slide_y");
}

TEST(Machine, RefusesImpossibleGeometry) {
  for (std::size_t k = 0; k < kMachine.geometry.size(); ++k) {
    std::vector<double> geometry = published_geometry();
    geometry[k] = -0.1;
    try {
      machine_catalog_entry().build(geometry, 0);
      ADD_FAILURE() << kMachine.geometry[k].name;
    } catch (const std::invalid_argument& reason) {
      EXPECT_TRUE(std::string(reason.what()).starts_with(kMachine.geometry[k].name + " must"));
    }
  }
}

TEST(Machine, BoundsErrorsOfASlideByItsTravel) {
  std::vector<double> geometry = published_geometry();
  geometry[5] = 0.4;
  const auto model = machine_catalog_entry().build(geometry, 0);
  const auto head = published("exact");
  const auto bound = [&](const char* name) { return model->error_bound(*kMachine.find_factor(name)).size; };
  EXPECT_EQ(bound("x_straightness_z"), 0.4);
  EXPECT_EQ(bound("y_position"), 0.6);
  EXPECT_EQ(bound("squareness"), std::numeric_limits<double>::infinity());
  for (const char* name : {"a_x_1", "l_2", "theta_A_x_3"}) {
    EXPECT_EQ(bound(name), head->error_bound(*kHead.find_factor(name)).size);
  }
}

TEST(Machine, IsInTheRegistry) { EXPECT_NE(find(registry(), "xy-3-prs"), nullptr); }

TEST(MachineDescription, ExtendsTheHeads) {
  EXPECT_EQ(kMachine.name, "xy-3-prs");
  EXPECT_EQ(kMachine.fidelities, kHead.fidelities);
  EXPECT_FALSE(kMachine.deformation);
  EXPECT_FALSE(kMachine.separation);
  EXPECT_TRUE(kMachine.curves.empty());
  ASSERT_EQ(kMachine.pose_coordinates.size(), 5u);
  ASSERT_EQ(kMachine.pose_lower.size(), 5u);
  EXPECT_EQ(kMachine.pose_coordinates[3].name, "slide_x");
  EXPECT_EQ(kMachine.pose_upper[4], 0.3);
  ASSERT_EQ(kMachine.factors.size(), kAll);
  std::set<std::string> names;
  for (std::size_t f = 0; f < kAll; ++f) {
    names.insert(kMachine.factors[f].name);
    if (f < kFactors) {
      EXPECT_EQ(kMachine.factors[f].name, kHead.factors[f].name);
    }
  }
  EXPECT_EQ(names.size(), kAll);
  for (std::size_t r = 0; r < 12; ++r) EXPECT_EQ(kMachine.responses[r].name, kHead.responses[r].name);
}

TEST(MachineDescription, BothMechanismsShowTheNormsTheTipFirst) {
  for (const ModelDescription* description : {&kHead, &kMachine}) {
    std::vector<std::string> shown;
    for (const std::size_t r : description->headline) shown.push_back(description->responses.at(r).name);
    EXPECT_EQ(shown, (std::vector<std::string>{"tip_position", "rotation", "position"}));
  }
}

TEST(MachineDescription, SetsPartHeadAndSlides) {
  const auto size = [](const char* set) { return kMachine.find_set(set)->factors.size(); };
  EXPECT_EQ(size("all"), 64u);
  EXPECT_EQ(size("head"), 51u);
  EXPECT_EQ(size("slides"), 13u);
  EXPECT_EQ(kMachine.find_set("head")->factors, kHead.find_set("all")->factors);
  for (const FactorIndex factor : kMachine.find_set("slides")->factors) EXPECT_GE(factor.value, kFactors);
  for (const FactorSet& set : kHead.factor_sets) {
    if (set.name != "all") {
      EXPECT_EQ(kMachine.find_set(set.name)->factors, set.factors);
    }
  }
  std::set<std::string> names;
  for (const FactorSet& set : kMachine.factor_sets) names.insert(set.name);
  EXPECT_EQ(names.size(), kMachine.factor_sets.size());
}

TEST(Slides, ErrorsCarryIsoSymbolsThatFitTheirComponents) {
  for (const Factor& factor : slide_factors()) {
    const std::size_t bracket = factor.description.find('(');
    const std::string symbol = factor.description.substr(bracket + 1, 3);
    const bool of_x = factor.limb == 4;
    EXPECT_EQ(factor.limb, of_x ? 4u : 5u);
    if (factor.name == "squareness") {
      EXPECT_EQ(symbol, "C0Y");
      EXPECT_EQ(factor.axis, "");
      EXPECT_EQ(factor.frame, kFrames + 4);
      continue;
    }
    // The ISO symbol has E, the component (X, Y, Z: along; A, B, C: about) and the slide.
    const bool is_angle = factor.dimension == Dimension::angle;
    const auto component = static_cast<std::size_t>(factor.axis.at(0) - 'x');
    EXPECT_EQ(symbol, std::string("E") + (is_angle ? "ABC" : "XYZ")[component] + (of_x ? 'X' : 'Y')) << factor.name;
    EXPECT_TRUE(factor.name.starts_with(of_x ? "x_" : "y_"));
    EXPECT_EQ(factor.frame, kFrames + (is_angle ? 1 : 0) + (of_x ? 0 : 2));
    const bool along = is_angle ? factor.name.ends_with("roll") : factor.name.ends_with("position");
    if (along || is_angle == false) {
      EXPECT_EQ(along, factor.axis == (of_x ? "x" : "y")) << factor.name;
    }
  }
}

}  // namespace
}  // namespace poesy::three_prs
