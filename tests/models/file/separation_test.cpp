// Tests what calibration can remove for mechanisms from files, compared with their exact solver and with the compiled
// 3-PRS.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "engine/model/calibrated.h"
#include "models/file/model.h"
#include "models/registry.h"
#include "tests/models/file/files.h"
#include "tests/support/names.h"

namespace poesy::file {
namespace {

/// The responses of one sample by name.
std::map<std::string, double> responses_of(const Model& model, const std::vector<double>& pose,
                                           const std::vector<double>& errors) {
  const ModelDescription& description = model.description();
  std::vector<double> values(description.responses.size());
  std::vector<SolveStatus> status(1);
  std::vector<std::uint32_t> iterations(1);
  model.evaluator({.tolerance = description.tolerance})
      ->evaluate({pose, errors, {}, {}, 1}, {values, status, iterations, {}});
  EXPECT_TRUE(solved(status.front()));
  std::map<std::string, double> named;
  for (std::size_t r = 0; r < values.size(); ++r) named[description.responses[r].name] = values[r];
  return named;
}

/// A pose in the middle half of the workspace.
std::vector<double> draw_pose(const ModelDescription& model, std::mt19937_64& engine) {
  std::vector<double> pose;
  for (std::size_t c = 0; c < model.pose_lower.size(); ++c) {
    const double share = std::uniform_real_distribution<double>(0.25, 0.75)(engine);
    pose.push_back(model.pose_lower[c] + share * (model.pose_upper[c] - model.pose_lower[c]));
  }
  return pose;
}

TEST(SeparationOfFile, IsThatOfTheCompiledThreePrs) {
  const std::unique_ptr<Model> compiled = build(*find(registry(), "3-prs"));
  std::ostringstream text;
  text << std::ifstream(POESY_TEST_DATA "/../../results/gallery/3-prs/3-prs.toml").rdbuf();
  const CatalogEntry entry = catalog_entry(text.str(), "3-prs.toml");
  std::mt19937_64 engine(5);
  for (const std::size_t fidelity : {0u, 1u}) {
    const std::unique_ptr<Model> from_file = build(entry, fidelity);
    for (int n = 0; n < 30; ++n) {
      const std::vector<double> pose = draw_pose(from_file->description(), engine);
      ASSERT_FALSE(compiled->unreachable(pose));
      const Separation truth = compiled->separation(pose);
      const Separation found = from_file->separation(pose);
      for (const auto part :
           {&Separation::drive, &Separation::constraint, &Separation::effect, &Separation::residual}) {
        for (std::size_t f = 0; f < truth.effect.size(); ++f) {
          const std::string& name = compiled->description().factors[f].name;
          const double value = (found.*part)[from_file->description().find_factor(name)->value];
          EXPECT_NEAR(value, (truth.*part)[f], 1e-12 * (1.0 + truth.effect[f])) << name;
          EXPECT_EQ(value == 0.0, (truth.*part)[f] == 0.0) << name;
        }
      }
    }
  }
}

/// All errors act together, each up to 0.3 mm or 0.3 mrad.
TEST(CalibratedFile, IsTheCompiledThreePrs) {
  std::ostringstream text;
  text << std::ifstream(POESY_TEST_DATA "/../../results/gallery/3-prs/3-prs.toml").rdbuf();
  const CatalogEntry entry = catalog_entry(text.str(), "3-prs.toml");
  std::mt19937_64 engine(9);
  for (const std::size_t fidelity : {0u, 1u}) {
    const std::unique_ptr<Model> compiled = calibrated(build(*find(registry(), "3-prs"), fidelity));
    const std::unique_ptr<Model> from_file = calibrated(build(entry, fidelity));
    for (int n = 0; n < 10; ++n) {
      const std::vector<double> pose = draw_pose(from_file->description(), engine);
      std::vector<double> errors(compiled->description().factors.size());
      std::vector<double> same(from_file->description().factors.size(), 0.0);
      for (std::size_t f = 0; f < errors.size(); ++f) {
        errors[f] = std::uniform_real_distribution<double>(-3e-4, 3e-4)(engine);
        same[from_file->description().find_factor(compiled->description().factors[f].name)->value] = errors[f];
      }
      const auto truth = responses_of(*compiled, pose, errors);
      const auto found = responses_of(*from_file, pose, same);
      for (const auto& [name, value] : found) EXPECT_NEAR(value, truth.at(name), 1e-12) << name << " " << fidelity;
    }
  }
}

/// One joint of a drive. Its motion is described by errors of the frame after it: a rotation about the joint's axis and
/// a displacement along the axis. A screw has both.
struct Driven {
  std::size_t turn;      ///< index of the error about the axis
  std::size_t slide;     ///< index of the error along the axis
  double turn_by = 0.0;  ///< rotation per unit of the drive
  double slide_by = 0.0;
};

/// A mechanism of tests/data in which all six errors of each frame are errors of the model.
class OfMechanism : public testing::TestWithParam<std::string> {
 protected:
  OfMechanism() {
    std::string text = text_of(GetParam());
    // A file without these tables has all errors.
    text = text.substr(0, std::min(text.find("\n[errors]"), text.find("\n[[error]]")));
    const MechanismFile file = read_mechanism_file(text, GetParam());
    mechanism_ = mechanism(file, default_geometry(file));
    entry_ = catalog_entry(text, GetParam());
    find_drives();
  }

  /// Joints with the same drive name have one drive. Every other actuated joint has its own drive.
  void find_drives() {
    std::map<std::string, std::size_t> named;
    for (std::size_t i = 0; i < mechanism_.limbs.size(); ++i) {
      const std::vector<Joint>& joints = mechanism_.limbs[i].joints;
      for (std::size_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].actuated) continue;
        ASSERT_LT(j + 1, joints.size());
        const auto factor = [&](const char* kind) {
          const std::string name = std::string(kind) + "_" + std::to_string(i + 1) + "_" + std::to_string(j + 1) + "_z";
          return entry_.description.find_factor(name)->value;
        };
        const bool slides = joints[j].motion == Motion::prismatic;
        const double pitch = joints[j].motion == Motion::helical ? joints[j].pitch : 0.0;
        const std::string own = std::to_string(i) + "," + std::to_string(j);
        const auto [place, is_new] = named.try_emplace(joints[j].drive.empty() ? own : joints[j].drive, drives_.size());
        if (is_new) drives_.emplace_back();
        drives_[place->second].push_back(
            {factor("epsilon"), factor("delta"), slides ? 0.0 : 1.0, slides ? 1.0 : pitch});
      }
    }
  }

  bool drives_are_shared() const {
    return std::ranges::any_of(drives_, [](const std::vector<Driven>& drive) { return drive.size() > 1; });
  }

  /// [3 points x samples] The displacements of the platform's points, divided by the square root of their number.
  /// errors: [errors x samples].
  Eigen::MatrixXd displacements(const Model& model, const std::vector<double>& pose,
                                const Eigen::MatrixXd& errors) const {
    const ModelDescription& description = model.description();
    const auto samples = static_cast<std::size_t>(errors.cols());
    std::vector<FactorIndex> varied;
    for (std::size_t f = 0; f < description.factors.size(); ++f) varied.emplace_back(f);
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = errors;
    std::vector<double> responses(description.responses.size() * samples);
    std::vector<SolveStatus> status(samples);
    std::vector<std::uint32_t> iterations(samples);
    const std::vector<double> zeros(varied.size(), 0.0);
    model.evaluator({.tolerance = description.tolerance, .max_iterations = 500})
        ->evaluate({pose, zeros, varied, {rows.data(), varied.size() * samples}, samples},
                   {responses, status, iterations, {}});
    const Limb& limb = mechanism_.limbs[0];
    const std::vector<double> joints = model.joint_displacements(pose);
    const Transform platform = limb_transform(limb, std::span(joints).first(limb.moving()));
    const auto row = static_cast<std::size_t>(std::ranges::find(description.responses, "x", &Response::name) -
                                              description.responses.begin());
    const auto points = static_cast<Eigen::Index>(mechanism_.points.size());
    Eigen::MatrixXd moved(3 * points, errors.cols());
    for (std::size_t b = 0; b < samples; ++b) {
      EXPECT_TRUE(solved(status[b]));
      const auto triple = [&](std::size_t r) {
        return Vector3(responses[r * samples + b], responses[(r + 1) * samples + b], responses[(r + 2) * samples + b]);
      };
      const lie::Matrix3<double> turn = lie::exp<double>(triple(row + 3));
      for (Eigen::Index a = 0; a < points; ++a) {
        const Vector3 arm = platform.R * mechanism_.points[static_cast<std::size_t>(a)];
        moved.col(static_cast<Eigen::Index>(b)).segment<3>(3 * a) = triple(row) + turn * arm - arm;
      }
    }
    return moved / std::sqrt(static_cast<double>(points));
  }

  /// [3 points x drives] The displacements per unit of each drive. by_errors: the displacements per unit of each error.
  Eigen::MatrixXd by_drives(const Eigen::MatrixXd& by_errors) const {
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(by_errors.rows(), static_cast<Eigen::Index>(drives_.size()));
    for (std::size_t d = 0; d < drives_.size(); ++d) {
      for (const Driven& joint : drives_[d]) {
        columns.col(static_cast<Eigen::Index>(d)) +=
            joint.turn_by * by_errors.col(static_cast<Eigen::Index>(joint.turn)) +
            joint.slide_by * by_errors.col(static_cast<Eigen::Index>(joint.slide));
      }
    }
    return columns;
  }

  /// The errors [errors x samples] plus the corrections [drives x samples] of the drives.
  Eigen::MatrixXd corrected(Eigen::MatrixXd errors, const Eigen::MatrixXd& corrections) const {
    for (std::size_t d = 0; d < drives_.size(); ++d) {
      const auto correction = corrections.row(static_cast<Eigen::Index>(d));
      for (const Driven& joint : drives_[d]) {
        errors.row(static_cast<Eigen::Index>(joint.turn)) += joint.turn_by * correction;
        errors.row(static_cast<Eigen::Index>(joint.slide)) += joint.slide_by * correction;
      }
    }
    return errors;
  }

  void check(const Model& model, const std::vector<double>& pose) const {
    const auto factors = static_cast<Eigen::Index>(model.description().factors.size());
    const Separation found = model.separation(pose);
    const Eigen::MatrixXd units = Eigen::MatrixXd::Identity(factors, factors);
    constexpr double kStep = 1e-6;
    const Eigen::MatrixXd effects =
        (displacements(model, pose, kStep * units) - displacements(model, pose, -kStep * units)) / (2.0 * kStep);
    const Eigen::MatrixXd corrections = -by_drives(effects).completeOrthogonalDecomposition().solve(effects);
    const Eigen::MatrixXd left = displacements(model, pose, kStep * corrected(units, corrections)) / kStep;
    for (Eigen::Index f = 0; f < factors; ++f) {
      const auto at = static_cast<std::size_t>(f);
      const std::string& name = model.description().factors[at].name;
      const double effect = effects.col(f).norm();
      EXPECT_NEAR(found.effect[at], effect, 1e-7 * (1.0 + effect)) << name;
      // The tolerance allows for second-order effects of the errors and the corrections.
      EXPECT_NEAR(found.residual[at], left.col(f).norm(), 1e-4 * (1.0 + effect)) << name;
    }
  }

  Mechanism mechanism_;
  CatalogEntry entry_;
  std::vector<std::vector<Driven>> drives_;  ///< the joints of each drive
};

TEST_P(OfMechanism, CorrectionsLeaveTheResidual) {
  std::mt19937_64 engine(6);
  const std::unique_ptr<Model> model = build(entry_);
  check(*model, draw_pose(entry_.description, engine));
  check(*model, draw_pose(entry_.description, engine));
  if (!entry_.other_metric) return;
  check(*build(*entry_.other_metric), draw_pose(entry_.description, engine));
}

/// The responses after calibration equal the residual of each error, for both fidelities.
TEST_P(OfMechanism, CalibrationLeavesTheResidual) {
  std::mt19937_64 engine(8);
  constexpr double kStep = 1e-6;
  for (const std::size_t fidelity : {0u, 1u}) {
    const std::unique_ptr<Model> model = calibrated(build(entry_, fidelity));
    const std::vector<double> pose = draw_pose(entry_.description, engine);
    const Separation found = model->separation(pose);
    const auto factors = static_cast<Eigen::Index>(found.effect.size());
    const Eigen::MatrixXd left =
        displacements(*model, pose, kStep * Eigen::MatrixXd::Identity(factors, factors)) / kStep;
    for (Eigen::Index f = 0; f < factors; ++f) {
      const auto at = static_cast<std::size_t>(f);
      EXPECT_NEAR(found.residual[at], left.col(f).norm(), 2e-5 * (1.0 + found.effect[at])) << fidelity;
    }
  }
}

/// With six drives for six freedoms every error can be corrected. With fewer drives the residual is between zero and
/// the whole effect.
TEST_P(OfMechanism, SharesAreBetweenNoneAndAll) {
  std::mt19937_64 engine(7);
  const std::unique_ptr<Model> model = build(entry_);
  const Separation found = model->separation(draw_pose(entry_.description, engine));
  for (std::size_t f = 0; f < found.effect.size(); ++f) {
    EXPECT_LE(found.residual[f], found.effect[f] * (1.0 + 1e-12));
    // A drive that moves joints of several limbs cannot remove every error that enters through one of them.
    EXPECT_LE(found.residual[f], (drives_are_shared() ? found.effect[f] : found.constraint[f]) * (1.0 + 1e-12));
    if (drives_.size() < 6) continue;
    EXPECT_EQ(found.residual[f], 0.0);
    EXPECT_EQ(found.constraint[f], 0.0);
    EXPECT_EQ(found.drive[f], found.effect[f]);
  }
  const auto not_removed = std::ranges::count_if(found.residual, [](double value) { return value > 0.0; });
  EXPECT_EQ(not_removed > 0, drives_.size() < 6);
  for (const std::vector<Driven>& drive : drives_) {
    const Driven& joint = drive.front();
    if (drive.size() > 1 || (joint.turn_by != 0.0 && joint.slide_by != 0.0)) continue;
    EXPECT_EQ(found.residual[joint.turn_by != 0.0 ? joint.turn : joint.slide], 0.0);
  }
}

const std::vector<std::string> kMechanisms{"rps3",  "ups6", "sps6",   "upr2-rpu", "tripteron", "rrr3",
                                           "press", "odd6", "mixed6", "delta6",   "geared3"};

INSTANTIATE_TEST_SUITE_P(Mechanisms, OfMechanism, testing::ValuesIn(kMechanisms),
                         test::named({"rps3", "ups6", "sps6", "upr2_rpu", "tripteron", "rrr3", "press", "odd6",
                                      "mixed6", "delta6", "geared3"}));

/// A motor that moves both rods of a carriage cannot correct an error of one rod alone, but it can correct equal errors
/// of both.
TEST(SharedDrives, CorrectWhatTheirJointsDoTogether) {
  const std::unique_ptr<Model> model = build(catalog_entry(text_of("delta6"), "delta6.toml"));
  const Separation found = model->separation(std::vector{0.03, -0.02, 0.04});
  const auto factor = [&](const char* name) { return model->description().find_factor(name)->value; };
  for (const char* stop : {"stop_1", "stop_4"}) {
    EXPECT_NEAR(found.drive[factor(stop)], found.effect[factor(stop)], 1e-12) << stop;
    EXPECT_GT(found.residual[factor(stop)], 0.3 * found.effect[factor(stop)]) << stop;
  }
  // The motors translate the platform but do not rotate it, so the whole rotation remains. Equal errors of both stops
  // are a motion of the carriage.
  const std::unique_ptr<Model> corrected = calibrated(build(catalog_entry(text_of("delta6"), "delta6.toml")));
  std::vector<double> errors(found.effect.size(), 0.0);
  const std::vector<double> pose{0.03, -0.02, 0.04};
  errors[factor("stop_1")] = 1e-4;
  const auto alone = responses_of(*corrected, pose, errors);
  EXPECT_GT(alone.at("rotation"), 1e-3);
  EXPECT_NEAR(alone.at("rotation"), responses_of(*model, pose, errors).at("rotation"), 1e-12);
  errors[factor("stop_4")] = 1e-4;
  const auto both = responses_of(*corrected, pose, errors);
  EXPECT_NEAR(both.at("rotation"), 0.0, 1e-12);
  EXPECT_LT(both.at("position"), 1e-6);
}

}  // namespace
}  // namespace poesy::file
