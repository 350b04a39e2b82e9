#include "models/chain/deformation_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "engine/base/contract.h"
#include "models/chain/deformation_solver.h"
#include "models/chain/nominal.h"

namespace poesy::chain {
namespace {

constexpr std::size_t kResponses = 3;

/// The model at a nominal pose, without errors.
struct Nominal {
  std::vector<double> displacements;       ///< [all joints] nominal displacements (rad, m)
  std::optional<Metric> held;              ///< metric by which machines that cannot be assembled are found
  std::optional<PlatformPoints> platform;  ///< reported points at these displacements
};

/// The arguments of the last preparation of the solver. Many blocks of samples may share them.
struct Prepared {
  const Nominal* nominal = nullptr;        ///< model at the nominal pose
  std::vector<FrameError<double>> errors;  ///< [frames] constant errors
  std::vector<FrameEntry> varied;          ///< components of frames' errors that vary
  double range = 0.0;                      ///< if only one component varies, its values are between -range and range

  bool operator==(const Prepared&) const = default;
};

/// The contribution of a varied error to a varied component of a frame's error.
struct Addition {
  std::size_t value;  ///< index of the error among the varied errors
  std::size_t row;    ///< index of the component among the varied components
  double scale;       ///< change of the component per unit of the error
};

class DeformationEvaluator final : public Evaluator {
 public:
  DeformationEvaluator(const DeformationModel& model, const SolverOptions& options, Fidelity fidelity)
      : model_(&model), solver_(model.chain, options, fidelity), errors_(model.chain.frames()) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    const Nominal& nominal = nominal_at(samples.pose);
    const std::size_t motions = nominal.platform ? nominal.platform->rows() : 0;
    POESY_EXPECTS(outcomes.responses.size() == (kResponses + motions) * samples.count);
    const std::span<const double> values = prepare(nominal, samples);
    solver_.solve(values, samples.count);
    double* to = outcomes.responses.data();
    for (std::size_t r = 0; r < kResponses; ++r, to += samples.count) std::ranges::copy(solver_.response(r), to);
    for (std::size_t r = 0; r < motions; ++r, to += samples.count) std::ranges::copy(solver_.platform(r), to);
    std::ranges::copy(solver_.status(), outcomes.status.begin());
    std::ranges::copy(solver_.iterations(), outcomes.iterations.begin());
    if (outcomes.details.empty()) return;
    for (std::size_t d = 0; d < 6 * model_->chain.pairs.size(); ++d) {
      std::ranges::copy(solver_.delta_mu(d), outcomes.details.data() + d * samples.count);
    }
  }

 private:
  /// The Nominal of each pose is kept for later samples, because inverse kinematics may be iterative and so take long.
  /// If Nominals of more poses than this are kept, all are discarded.
  static constexpr std::size_t kMostPoses = 1024;

  const Nominal& nominal_at(std::span<const double> pose) {
    if (nominal_.size() > kMostPoses) {
      nominal_.clear();
      prepared_.nominal = nullptr;
    }
    const auto [place, is_new] = nominal_.try_emplace(std::vector<double>(pose.begin(), pose.end()));
    if (!is_new) return place->second;
    const std::vector<double> displacements = model_->joint_displacements(pose);
    place->second = {displacements, model_->held(displacements), model_->platform_points(displacements)};
    return place->second;
  }

  double& value_of(const FrameEntry& entry) { return errors_[entry.frame][static_cast<Eigen::Index>(entry.component)]; }

  void set_constant(const Nominal& nominal, const SampleBlock& samples) {
    varies_.assign(model_->terms.size(), false);
    for (const FactorIndex factor : samples.varied) varies_[factor.value] = true;
    for (auto& error : errors_) error.setZero();
    for (std::size_t f = 0; f < varies_.size(); ++f) {
      if (varies_[f]) continue;
      for (const ErrorTerm& term : model_->terms[f]) {
        value_of(model_->entry(term)) += term.at(nominal.displacements) * samples.errors[f];
      }
    }
  }

  /// Finds the components of frames' errors that vary, and the contributions of each error to them. Returns true if no
  /// sums are needed: each varied component then has the values of exactly one varied error.
  bool find_varied(const Nominal& nominal, const SampleBlock& samples) {
    varied_.clear();
    additions_.clear();
    bool is_plain = true;
    for (std::size_t v = 0; v < samples.varied.size(); ++v) {
      const ErrorTerms& terms = model_->terms[samples.varied[v].value];
      is_plain = is_plain && terms.size() == 1;
      for (const ErrorTerm& term : terms) {
        const FrameEntry entry = model_->entry(term);
        const auto row = static_cast<std::size_t>(std::ranges::find(varied_, entry) - varied_.begin());
        additions_.push_back({v, row, term.at(nominal.displacements)});
        const bool is_new = row == varied_.size();
        if (is_new) varied_.push_back(entry);
        is_plain = is_plain && is_new && additions_.back().scale == 1.0 && value_of(entry) == 0.0;
      }
    }
    return is_plain;
  }

  /// Prepares the solver. Returns the values [varied components x samples] of the varied components. These are the
  /// values of the samples' errors, unless a component has a constant part or a sum of several errors, or an error is
  /// scaled or adds to several components.
  std::span<const double> prepare(const Nominal& nominal, const SampleBlock& samples) {
    set_constant(nominal, samples);
    const auto values = find_varied(nominal, samples) ? samples.values : combined(samples);
    const double range = additions_.size() == 1 ? samples.range * std::abs(additions_.front().scale) : 0.0;
    Prepared wanted{&nominal, errors_, varied_, range};
    if (wanted == prepared_) return values;
    solver_.prepare(nominal.displacements, errors_, varied_, wanted.range,
                    nominal.platform ? &*nominal.platform : nullptr, nominal.held ? &*nominal.held : nullptr);
    prepared_ = std::move(wanted);
    return values;
  }

  /// [varied components x samples] The values of the varied components: the constant part of each component plus the
  /// contributions of all varied errors.
  std::span<const double> combined(const SampleBlock& samples) {
    values_.resize(varied_.size() * samples.count);
    for (std::size_t row = 0; row < varied_.size(); ++row) {
      std::fill_n(values_.data() + row * samples.count, samples.count, value_of(varied_[row]));
    }
    for (const Addition& one : additions_) {
      const double* from = samples.values.data() + one.value * samples.count;
      double* to = values_.data() + one.row * samples.count;
      for (std::size_t b = 0; b < samples.count; ++b) to[b] += one.scale * from[b];
    }
    return values_;
  }

  const DeformationModel* model_;
  BlockSolver solver_;
  Prepared prepared_;
  std::map<std::vector<double>, Nominal> nominal_;  ///< nominal models, by pose
  std::vector<bool> varies_;                        ///< [errors] true for each error that varies
  std::vector<FrameError<double>> errors_;
  std::vector<FrameEntry> varied_;
  std::vector<Addition> additions_;
  std::vector<double> values_;  ///< [varied components x samples] values of the varied components
};

/// The contribution of a pair of limbs to a response is the norm of M x (mismatch [omega; v] of the pair). Returns the
/// matrix M, which has six columns.
Eigen::MatrixXd judged_of_pair(std::size_t response) {
  const Eigen::MatrixXd all = lie::Matrix6<double>::Identity();
  if (response == 0) return all.topRows(3);  // angular deformation
  return response == 1 ? Eigen::MatrixXd(all.bottomRows(3)) : all;
}

}  // namespace

std::vector<double> repeated(const Eigen::MatrixXd& of_pair, std::size_t pairs, double share) {
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto count = static_cast<Eigen::Index>(pairs);
  RowMatrix all = RowMatrix::Zero(count * of_pair.rows(), 6 * count);
  for (Eigen::Index n = 0; n < count; ++n) {
    all.block(n * of_pair.rows(), 6 * n, of_pair.rows(), 6) = share * of_pair;
  }
  return {all.data(), all.data() + all.size()};
}

std::vector<double> norm_of_details(const DeformationModel& model, std::size_t response) {
  if (response >= kResponses) return {};
  const std::size_t pairs = model.chain.pairs.size();
  // A mean of norms is about as large as their root mean square. The largest norm is about 1.2 times as large.
  const bool is_largest = response == 2;
  const double share = is_largest ? 1.0 / std::numbers::sqrt2 : 1.0 / std::sqrt(static_cast<double>(pairs));
  return repeated(judged_of_pair(response), pairs, share);
}

std::vector<Response> deformation_responses() {
  // The sum Q of the three squared norms n^2 is additive over independent errors. In a triangle 2 Q <= (sum of n)^2 <=
  // 3 Q, so the square of the mean is between 2 Q / 9 and 3 Q / 9. Also Q / 3 <= (largest n)^2 <= 2 Q / 3.
  constexpr double kMeanOfSides = 3.0 / 2.0;
  constexpr double kLargestSide = 2.0;
  return {
      {"angular_deformation",
       Dimension::angle,
       "mean mismatch of angle between pairs of limbs, whose errors keep them from holding one rigid platform (Du et "
       "al. "
       "2022, Eq. 49)",
       kMeanOfSides,
       {},
       true},
      {"linear_deformation",
       Dimension::length,
       "mean mismatch of position, at the base's origin, between pairs of limbs, whose errors keep them from holding "
       "one "
       "rigid platform (Du et al. 2022, Eq. 50)",
       kMeanOfSides,
       {},
       true},
      {"deformation_max",
       Dimension::number,
       "largest mismatch of a pair of limbs: the norm of angle and position together, rad and m mixed (Du et al. 2022, "
       "Eq. 45)",
       kLargestSide,
       {},
       true}};
}

std::vector<Response> platform_responses(const PlatformReport& report, std::size_t first) {
  constexpr auto kLength = Dimension::length;
  constexpr auto kAngle = Dimension::angle;
  std::vector<Response> list{
      {"x", kLength, "displacement of the platform's origin along the base's x"},
      {"y", kLength, "displacement of the platform's origin along the base's y"},
      {"z", kLength, "displacement of the platform's origin along the base's z"},
      {"theta_x", kAngle, "rotation of the platform about the base's x (rotation vector)"},
      {"theta_y", kAngle, "rotation of the platform about the base's y (rotation vector)"},
      {"theta_z", kAngle, "rotation of the platform about the base's z (rotation vector)"},
      {"position", kLength, "length of the displacement of the platform's origin", 1.0, {first, first + 1, first + 2}},
      {"rotation", kAngle, "angle by which the platform is rotated", 1.0, {first + 3, first + 4, first + 5}}};
  if (!report.tool) return list;
  list.insert(list.end(), {{"tip_x", kLength, "displacement of the tool's point along the base's x"},
                           {"tip_y", kLength, "displacement of the tool's point along the base's y"},
                           {"tip_z", kLength, "displacement of the tool's point along the base's z"},
                           {"tip_position",
                            kLength,
                            "length of the displacement of the tool's point",
                            1.0,
                            {first + 8, first + 9, first + 10}}});
  return list;
}

std::vector<Response> responses_of(const DeformationModel& model) {
  std::vector<Response> list = deformation_responses();
  if (!model.platform) return list;
  for (Response& response : platform_responses(*model.platform, list.size())) list.push_back(std::move(response));
  return list;
}

FrameEntry DeformationModel::entry(const ErrorTerm& term) const {
  return {chain.first_frame(term.limb) + term.frame, term.component};
}

std::optional<PlatformPoints> DeformationModel::platform_points(std::span<const double> displacements) const {
  if (!platform) return std::nullopt;
  const Limb& limb = chain.limbs.front();
  PlatformPoints reported{chain.rounded
                              ? mean_platform(chain, displacements)
                              : forward_kinematics<double>(limb, limb.home, displacements.first(limb.joints.size()),
                                                           [](std::size_t, const lie::Screw<double>&) {})};
  if (platform->tool) reported.tool = reported.platform.R * *platform->tool + reported.platform.p;
  return reported;
}

std::optional<Metric> DeformationModel::held(std::span<const double> displacements) const {
  if (held_at.empty()) return std::nullopt;
  return platform_metric(chain, held_at, displacements);
}

DeformationMeasure deformation_measure(const DeformationModel& model) {
  return {kResponses - 1, rounding_level(model.chain)};
}

double effect_rounding(const DeformationModel& model) {
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  return kRounding * std::max(1.0, model.chain.reach());
}

std::vector<Detail> deformation_details(std::span<const LimbPair> pairs) {
  std::vector<Detail> details;
  for (const LimbPair& pair : pairs) {
    const std::string k = std::to_string(pair.k + 1);
    const std::string i = std::to_string(pair.i + 1);
    details.push_back({"delta_mu_" + k + i,
                       {"omega_x", "omega_y", "omega_z", "v_x", "v_y", "v_z"},
                       "rad,rad,rad,m,m,m",
                       "end-pose deviation of limb " + k + " from limb " + i +
                           ", screw in the base frame (Du et al. 2022, Eqs. 30, 46)"});
  }
  return details;
}

std::vector<JointDisplacement> joint_displacement_names(const ParallelChain& chain) {
  std::vector<JointDisplacement> list;
  for (std::size_t i = 0; i < chain.limbs.size(); ++i) {
    const std::vector<Joint>& joints = chain.limbs[i].joints;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      list.push_back({"q_" + std::to_string(i + 1) + "_" + std::to_string(j + 1),
                      joints[j].type == JointType::revolute ? Dimension::angle : Dimension::length,
                      joints[j].actuated && !joints[j].fixed});
    }
  }
  return list;
}

std::unique_ptr<Evaluator> deformation_evaluator(const DeformationModel& model, const SolverOptions& options,
                                                 Fidelity fidelity) {
  return std::make_unique<DeformationEvaluator>(model, options, fidelity);
}

}  // namespace poesy::chain
