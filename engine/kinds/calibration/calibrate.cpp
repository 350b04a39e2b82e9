#include "engine/kinds/calibration/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/calibration/drive_correction.h"
#include "engine/calibration/inference.h"
#include "engine/calibration/left.h"
#include "engine/calibration/next_poses.h"
#include "engine/kinds/calibration/kept_limits.h"
#include "engine/kinds/commanded.h"
#include "engine/kinds/fitted_errors.h"
#include "engine/run/run_in_slots.h"
#include "engine/study/calibration.h"

namespace poesy::calibration {
namespace {

using calibration::Components;
using calibration::Matrix;
using calibration::Vector;

// Step of the finite differences for the derivatives of the parameters that an operator types into the controller
// (TypedNumber), as a share of the scale of a fitted error.
constexpr double kStepOfTyped = 1e-6;

Eigen::Index position(std::size_t at) { return static_cast<Eigen::Index>(at); }

template <class AnArray>
AnArray array_of(const Vector& values) {
  return AnArray({static_cast<std::size_t>(values.size())}, std::vector<double>(values.begin(), values.end()));
}

template <class AnArray>
AnArray array_of(const Matrix& values) {
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = values;
  return AnArray({static_cast<std::size_t>(values.rows()), static_cast<std::size_t>(values.cols())},
                 std::vector<double>(rows.data(), rows.data() + rows.size()));
}

std::vector<double> pose_of(const PoseSet& poses, std::size_t m) {
  const std::span<const double> pose = poses[PoseIndex(m)];
  return {pose.begin(), pose.end()};
}

/// The index of a measured quantity in kComponents, the components of a displacement.
std::size_t component_of(const std::string& quantity) {
  return static_cast<std::size_t>(std::ranges::find(calibration::kComponents, quantity) -
                                  calibration::kComponents.begin());
}

Dimension dimension_of(const MachineValue& value) {
  const bool is_angle = value.column == MachineColumn::deviation && value.quantity.starts_with("theta");
  return is_angle ? Dimension::angle : Dimension::length;
}

/// The stated standard deviation of this quantity; none if the study states none.
std::optional<double> stated_sd(const CalibrationTable& table, const std::string& quantity) {
  const auto found = std::ranges::find(table.noise, quantity, &StatedNoise::what);
  return found == table.noise.end() ? std::nullopt : std::optional(found->sd);
}

/// Standard deviations by which the residuals of the measured values are divided: their noise, or 1 if all noise is 0.
struct Weights {
  Vector sd;             ///< [values] standard deviation of each value, or 1
  bool is_noise = true;  ///< whether `sd` is the noise
};

Weights weights_of(const MachineToCalibrate& machine, const CalibrationTable& table) {
  const std::vector<MachineValue>& values = machine.file.values;
  Weights weights{Vector(position(values.size()))};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto sd = values[i].sd ? values[i].sd : stated_sd(table, values[i].quantity);
    if (!sd) {
      throw InputError(
          {machine.path, 1, 1},
          fmt::format("{} has neither a column sd_{} nor noise", values[i].column_name(), values[i].quantity),
          fmt::format("write noise = {{ {} = \"...\" }} in [analysis.calibration], or 0", values[i].quantity));
    }
    weights.sd(position(i)) = *sd / std::sqrt(static_cast<double>(table.repeats));
  }
  if ((weights.sd.array() > 0.0).all()) return weights;
  if ((weights.sd.array() > 0.0).any()) {
    throw InputError({machine.path, 1, 1}, "some values have noise 0, and others have noise",
                     "state the noise of all, or 0 for all");
  }
  const auto other = std::ranges::find_if(
      values, [&](const MachineValue& value) { return dimension_of(value) != dimension_of(values.front()); });
  if (other != values.end()) {
    throw InputError(table.place, "noise is 0 and values have lengths and angles: say how they are weighed",
                     "state the noise of each");
  }
  if (table.prior == PriorKnowledge::tolerances || table.sd == NoiseLevel::estimated) {
    throw InputError(table.place, "noise is 0, so nothing can be weighed against the tolerances or estimated",
                     "state the noise, or write prior = \"none\" and sd = \"given\"");
  }
  return {Vector::Ones(weights.sd.size()), false};
}

/// The measured values of the table in the form that the fit uses. sd: standard deviation of each value.
std::vector<calibration::MeasuredValue> measured_values(const MachineToCalibrate& machine, const Vector& sd) {
  std::vector<calibration::MeasuredValue> list;
  for (const MachineValue& value : machine.file.values) {
    list.push_back({.what = static_cast<calibration::Measured>(value.column),
                    .row = value.row,
                    .other = value.other,
                    .component = value.column == MachineColumn::distance ? 0 : component_of(value.quantity),
                    .value = value.value,
                    .sd = sd(position(list.size()))});
  }
  return list;
}

calibration::ExactMachine exact_machine(const MachineToCalibrate& machine) {
  try {
    return {machine.model, machine.study.solver};
  } catch (const std::invalid_argument& reason) {
    throw InputError(machine.study.mechanism.place,
                     "mechanism '" + machine.model.description().name + "' " + reason.what(),
                     "take another mechanism, or fidelity");
  }
}

/// The objects with which one thread solves machines.
struct SolverOfThread {
  SolverOfThread(const MachineToCalibrate& machine, const calibration::CoordinateError& commanded)
      : exact(exact_machine(machine)), correction(exact, commanded) {}
  SolverOfThread(const SolverOfThread&) = delete;
  SolverOfThread& operator=(const SolverOfThread&) = delete;

  calibration::ExactMachine exact;
  calibration::DriveCorrection correction;
};

/// The displacements that remain at one pose after calibration.
struct LeftThere {
  std::optional<calibration::LeftAtPose> left;  ///< result for the measured machine; none if the pose cannot be reached
  Matrix machines;  ///< [components x machines] displacements, rad and m, of the machines by which limits are judged
                    ///< (KeptLimits)
};

/// The calibration of one machine.
class Calibration {
 public:
  explicit Calibration(const MachineToCalibrate& machine)
      : machine_(machine),
        table_(*machine.study.analysis.calibration),
        exact_(exact_machine(machine)),
        commanded_(commanded_coordinates(machine.study, machine.model, exact_, machine.measured_at)),
        weights_(weights_of(machine, table_)),
        columns_(fitted_columns(machine.study, table_, exact_)),
        measurement_(exact_, measured_poses(), measured_values(machine, weights_.sd), frame(), target()) {
    check_count();
    check_deviations();
  }

  Calibrated run() {
    fit_ = calibration::fit({measurement_, columns_.directions, weights_.sd, columns_.prior});
    Calibrated made;
    made.result.converged = fit_.solved && fit_.converged ? 1 : 0;
    if (fit_.solved) set_result(made);
    made.solves = exact_.solves() + solves_;
    return made;
  }

 private:
  void set_result(Calibrated& made) {
    inference_ = calibration::infer(
        fit_, weights_.sd, columns_.directions.scale, columns_.prior,
        {table_.sd == NoiseLevel::estimated, machine_.study.analysis.conf_level, machine_.measured_at.size()});
    set_fitted(made.result);
    set_values(made.result);
    set_test(made.result);
    set_typed(made.result);
    set_left(made);
    if (table_.next > 0) set_next(made);
  }

  calibration::Frame frame() const { return static_cast<calibration::Frame>(table_.frame); }
  calibration::Target target() const { return static_cast<calibration::Target>(table_.target); }
  bool has_prior() const { return table_.prior == PriorKnowledge::tolerances; }
  std::size_t places() const { return numbers_of(frame()) + numbers_of(target()); }

  /// The values of the fitted errors that the controller already corrected while the machine was measured, SI.
  std::vector<double> present() const {
    return table_.present.empty() ? std::vector(table_.fit.size(), 0.0) : table_.present;
  }

  /// The measured poses, with the drive positions that the controller set by its present parameters.
  std::vector<calibration::MeasuredPose> measured_poses() {
    std::vector<calibration::MeasuredPose> poses;
    const std::vector<double> corrected = present();
    const Vector errors =
        columns_.directions.F * Eigen::Map<const Vector>(corrected.data(), position(corrected.size()));
    const calibration::DriveCorrection correction(exact_, commanded_);
    for (std::size_t row = 0; row < machine_.measured_at.size(); ++row) {
      const std::vector<double> pose = pose_of(machine_.measured_at, row);
      const auto drive_at = errors.isZero(0.0) ? std::optional(pose) : correction.drive_at(pose, errors);
      if (!drive_at) {
        throw InputError({machine_.path, row + 2, 1}, "the drives with the present corrections do not reach this pose",
                         "check analysis.calibration.present, or leave the row out");
      }
      poses.push_back({pose, *drive_at});
    }
    return poses;
  }

  /// Throws InputError if there are too few measured values for the numbers that are fitted. With a prior, it is enough
  /// that there are more values than numbers that place frame and target.
  void check_count() const {
    const std::size_t fitted = table_.fit.size() + places();
    const std::size_t measured = machine_.file.values.size();
    if (places() > 0 && places() >= measured) {
      throw InputError({machine_.path},
                       fmt::format("{} numbers of frame and target and {} measured values", places(), measured),
                       "measure at more poses, or in a known frame");
    }
    if (has_prior() || fitted <= measured) return;
    const std::string of_places = places() == 0 ? "" : fmt::format(" with {} numbers of frame and target", places());
    throw InputError({machine_.path},
                     fmt::format("{} fitted errors{} and {} measured values", table_.fit.size(), of_places, measured),
                     "measure at more poses, fit fewer, or take prior = \"tolerances\"");
  }

  /// Throws InputError if, in a known frame, a deviation of the platform is longer than a tenth of the mechanism's
  /// reach. The unit of its column is then wrong, and a fit would take minutes.
  void check_deviations() const {
    constexpr double kMostOfReach = 0.1;
    if (frame() != calibration::Frame::known) return;
    for (const MachineValue& value : machine_.file.values) {
      const bool is_length = value.column == MachineColumn::deviation && dimension_of(value) == Dimension::length;
      if (!is_length || std::abs(value.value) <= kMostOfReach * exact_.reach()) continue;
      throw InputError(
          {machine_.path, value.row + 2, 1},
          fmt::format("{} is {}, which is more than a tenth of the mechanism's reach ({})",
                      machine_.file.name_of(value), readable_text({value.value, Dimension::length}, 4),
                      readable_text({exact_.reach(), Dimension::length}, 4)),
          fmt::format("name the unit of the column in the first line, e.g. '{} [um]'", value.column_name()));
    }
  }

  void set_fitted(Result& result) const {
    for (const FittedErrors& fitted : table_.fit) {
      result.fitted.push_back({fitted.name, std::string(si_unit(fitted.dimension))});
    }
    using Fitted = Array<double, axis::Fitted>;
    using Square = Array<double, axis::Fitted, axis::OtherFitted>;
    const double known = weights_.is_noise ? 1.0 : kNaN;
    result.estimate = array_of<Fitted>(fit_.theta);
    result.sd = array_of<Fitted>(Vector(known * inference_.sd));
    result.low = array_of<Fitted>(Vector(known * inference_.low));
    result.high = array_of<Fitted>(Vector(known * inference_.high));
    result.scale = array_of<Fitted>(columns_.directions.scale);
    result.has_tolerances = columns_.has_tolerances ? 1 : 0;
    result.covariance = array_of<Square>(Matrix(known * inference_.covariance));
    result.correlation = array_of<Square>(inference_.correlation);
    result.null_projector = array_of<Square>(inference_.null_projector);
    result.singular_values = array_of<Array<double, axis::Direction>>(fit_.scaled.singular_values);
    result.conf_level = machine_.study.analysis.conf_level;
    result.has_prior = has_prior() ? 1 : 0;
    result.noise_is_known = weights_.is_noise ? 1 : 0;
    result.sd_is_estimated = table_.sd == NoiseLevel::estimated ? 1 : 0;
    result.rank = fit_.scaled.rank;
    result.frame_rank = fit_.scaled.frame_rank();
    result.steps = fit_.steps;
    result.unfitted = table_.with_tolerance.size() - std::min(table_.with_tolerance.size(), table_.fit.size());
    result.frame = array_of<Array<double, axis::FramePart>>(fit_.phi);
    static const std::array<std::vector<std::string>, 4> kFrameParts{
        {{}, {"height"}, {"height", "slope_x", "slope_y"}, {"x", "y", "z", "rho_x", "rho_y", "rho_z"}}};
    static const std::vector<std::string> kTargetParts{"target_x",     "target_y",     "target_z",
                                                       "target_rho_x", "target_rho_y", "target_rho_z"};
    result.frame_parts = kFrameParts[static_cast<std::size_t>(frame())];
    result.frame_parts.insert(result.frame_parts.end(), kTargetParts.begin(),
                              kTargetParts.begin() + static_cast<std::ptrdiff_t>(numbers_of(target())));
  }

  void set_values(Result& result) const {
    using Value = Array<double, axis::Value>;
    using Position = Array<std::uint64_t, axis::Value>;
    result.value_row = Position({machine_.file.values.size()});
    result.value_to = result.value_row;
    for (const MachineValue& value : machine_.file.values) {
      const bool is_distance = value.column == MachineColumn::distance;
      result.value_row(result.values.size()) = value.row;
      result.value_to(result.values.size()) = is_distance ? value.other : value.row;
      result.values.push_back(machine_.file.name_of(value));
      result.value_units.emplace_back(si_unit(dimension_of(value)));
      if (is_distance) ++result.distances;
    }
    result.rows = machine_.file.names;
    const PoseSet& poses = machine_.measured_at;
    result.measured_at = Array<double, axis::Measurement, axis::Coordinate>({poses.size(), poses.coordinates()});
    for (std::size_t m = 0; m < poses.size(); ++m) {
      std::ranges::copy(poses[PoseIndex(m)], result.measured_at.row(m).begin());
    }
    const double known = weights_.is_noise ? 1.0 : kNaN;
    result.measured = array_of<Value>(measurement_.measured());
    result.value_sd = array_of<Value>(Vector(known * weights_.sd));
    result.residual = array_of<Value>(fit_.residual);
    result.leverage = array_of<Value>(inference_.leverage);
    result.standardised = array_of<Value>(Vector(known * inference_.standardised));
    result.outlier = Array<std::uint8_t, axis::Value>({result.values.size()});
    result.measured_poses = machine_.measured_at.size();
    if (!weights_.is_noise) return;
    for (const std::size_t i : inference_.outliers) result.outlier(i) = 1;
  }

  void set_test(Result& result) const {
    result.dof = inference_.dof;
    const calibration::ObservabilityIndices& indices = inference_.indices;
    result.O2 = indices.O2;
    result.condition = indices.condition;
    if (!weights_.is_noise) return;
    result.rms = inference_.rms;
    result.chi_square = fit_.sum;
    result.p = inference_.p;
    result.outlier_limit = inference_.outlier_limit;
    result.below_noise = inference_.below_noise;
    result.O1 = indices.O1;
    result.O3 = indices.O3;
    result.O4 = indices.O4;
    result.O5 = indices.O5;
  }

  void set_typed(Result& result) const {
    const std::size_t k = table_.fit.size();
    std::vector<double> estimate(fit_.theta.begin(), fit_.theta.end());
    std::vector<double> nominal;
    std::vector<double> before;
    std::vector<double> value;
    std::vector<double> sd;
    for (const TypedNumber& typed : machine_.typed) {
      result.typed.push_back({typed.name, std::string(si_unit(typed.dimension)), typed.text});
      nominal.push_back(typed.value(std::vector(k, 0.0)));
      before.push_back(typed.value(present()));
      value.push_back(typed.value(estimate));
      Vector gradient(position(k));
      for (std::size_t j = 0; j < k; ++j) {
        const double step = kStepOfTyped * columns_.directions.scale(position(j));
        std::vector<double> up = estimate;
        std::vector<double> down = estimate;
        up[j] += step;
        down[j] -= step;
        gradient(position(j)) = (typed.value(up) - typed.value(down)) / (up[j] - down[j]);
      }
      const double known = weights_.is_noise ? 1.0 : kNaN;
      sd.push_back(known * sd_of(gradient, inference_, columns_.directions.scale, has_prior()));
    }
    result.typed_nominal = {{nominal.size()}, nominal};
    result.typed_present = {{before.size()}, before};
    result.typed_value = {{value.size()}, value};
    result.typed_sd = {{sd.size()}, sd};
  }

  /// Estimates and covariance of all errors that have a tolerance or are fitted; if all noise is 0, of the fitted
  /// errors only, with covariance 0. None if the fit of all these errors does not converge.
  std::optional<calibration::Knowledge> knowledge_of_all() const {
    if (!weights_.is_noise) {
      const Eigen::Index all = fit_.theta.size() + fit_.phi.size();
      return calibration::Knowledge{columns_.directions, fit_.theta, fit_.phi, Matrix::Zero(all, all)};
    }
    const FittedColumns all = all_columns(machine_.study, table_, exact_);
    const Vector sd = inference_.sd_factor * weights_.sd;
    const calibration::FitResult found = calibration::fit({measurement_, all.directions, sd, all.prior});
    if (!found.solved || !found.converged) return std::nullopt;
    return calibration::knowledge(found, all.directions, sd, all.prior, 1.0);
  }

  void set_left(Calibrated& made) {
    Result& result = made.result;
    const std::size_t poses = machine_.predicted_at.size();
    result.drives = drives_of(machine_.study);
    result.left_mean = Array<double, axis::Pose, axis::Moved>({poses, calibration::kComponents.size()}, kNaN);
    result.left_sd = result.left_mean;
    result.drive_shift = Array<double, axis::Pose, axis::Drive>({poses, result.drives.size()}, kNaN);
    const auto known = knowledge_of_all();
    if (!known) {
      made.warnings.emplace_back(
          "the remaining displacement is not predicted, because the estimate of all errors was not found");
      return;
    }
    const calibration::Corrected corrected{columns_.directions.F * fit_.theta, fit_.phi, frame()};
    result.left_in_device_frame = frame() == calibration::Frame::known ? 0 : 1;
    KeptLimits kept(machine_.study, machine_.model, *known);
    const auto solve = [&](SolverOfThread& solver, std::size_t m) {
      const std::vector<double> pose = pose_of(machine_.predicted_at, m);
      LeftThere there{calibration::left_at(solver.exact, solver.correction, pose, corrected, *known), {}};
      if (there.left) there.machines = kept.left_at(solver.exact, pose, there.left->drive_at, corrected);
      return there;
    };
    const auto keep = [&](std::size_t m, LeftThere& there) {
      if (!there.left) {
        made.warnings.push_back(fmt::format("pose {} cannot be reached with the corrected drives", m));
        return;
      }
      set_left_at(m, *there.left, result);
      kept.add(there.machines);
    };
    over_poses<LeftThere>(poses, solve, keep);
    result.kept = weights_.is_noise ? kept.share() : kNaN;
    if (const std::string unjudged = kept.not_judged(); !unjudged.empty()) made.warnings.push_back(unjudged);
  }

  void set_left_at(std::size_t m, const calibration::LeftAtPose& left, Result& result) const {
    std::ranges::copy(left.mean, result.left_mean.row(m).begin());
    std::ranges::copy(left.sd, result.left_sd.row(m).begin());
    if (!weights_.is_noise) std::ranges::fill(result.left_sd.row(m), kNaN);
    const std::vector<double> pose = pose_of(machine_.predicted_at, m);
    std::ranges::copy(drive_shift(machine_.model, result.drives, pose, left.drive_at),
                      result.drive_shift.row(m).begin());
  }

  /// Calls solve(solver, n) for each n = 0 .. count - 1 on a pool of threads, and passes each result to keep(n,
  /// result), in the order of n.
  template <class Found, class Solve, class Keep>
  void over_poses(std::size_t count, const Solve& solve, const Keep& keep) {
    const RunOptions options{.threads = machine_.threads};
    struct FoundInSlot {
      Found found;
      std::uint64_t solves = 0;
    };
    std::vector<FoundInSlot> slots(pool_slots(options));
    const auto make_work = [&]() -> SlotJob {
      return [&, solver = std::make_shared<SolverOfThread>(machine_, commanded_)](std::size_t n, std::size_t slot) {
        const std::uint64_t before = solver->exact.solves();
        slots[slot].found = solve(*solver, n);
        slots[slot].solves = solver->exact.solves() - before;
      };
    };
    const auto finish = [&](std::size_t n, std::size_t slot) {
      keep(n, slots[slot].found);
      solves_ += slots[slot].solves;
    };
    run_alone(count, options, {.make_work = make_work, .finish = finish, .state = {}});
  }

  /// For each candidate pose, the derivatives of the values that would be measured there with respect to the fitted
  /// numbers, divided by the noise. Each matrix has a row for each quantity in the table of measurements (such as the
  /// height), and a column for each fitted error, scaled, and for each number of frame and target. Distances are left
  /// out.
  std::vector<Matrix> rows_of_candidates() {
    std::vector<calibration::MeasuredValue> kinds;
    for (const calibration::MeasuredValue& value : measurement_.values()) {
      if (value.what == calibration::Measured::distance) continue;
      const auto same = std::ranges::find_if(kinds, [&](const calibration::MeasuredValue& kind) {
        return kind.what == value.what && kind.component == value.component;
      });
      if (same == kinds.end()) kinds.push_back(value);
    }
    const Vector none = Vector::Zero(fit_.theta.size());
    const auto solve = [&](SolverOfThread& solver, std::size_t c) {
      const std::vector<double> pose = pose_of(machine_.candidates, c);
      std::vector<calibration::MeasuredValue> values = kinds;
      Vector sd(position(values.size()));
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i].row = 0;
        sd(position(i)) = inference_.sd_factor * values[i].sd;
      }
      const calibration::Measurement measurement(solver.exact, {{pose, pose}}, values, frame(), target());
      const auto derivatives =
          calibration::FittedMeasurement(measurement, columns_.directions).derivatives(none, fit_.phi);
      Matrix all = Matrix::Zero(sd.size(), fit_.theta.size() + fit_.phi.size());
      if (derivatives) {
        all << derivatives->errors * columns_.directions.scale.asDiagonal(), derivatives->places;
        all = sd.cwiseInverse().asDiagonal() * all;
      }
      return all;
    };
    std::vector<Matrix> rows;
    const auto keep = [&](std::size_t, Matrix& found) { rows.push_back(std::move(found)); };
    over_poses<Matrix>(kinds.empty() ? 0 : machine_.candidates.size(), solve, keep);
    return rows;
  }

  void set_next(Calibrated& made) {
    if (!weights_.is_noise) {
      made.warnings.emplace_back("next poses are not chosen, because the noise is 0");
      return;
    }
    if (fit_.scaled.frame_rank() < places()) {
      made.warnings.emplace_back(
          "next poses are not chosen, because the measurements do not determine the frame and the target");
      return;
    }
    const Eigen::Index k = fit_.theta.size();
    Matrix columns(fit_.scaled.A.rows(), k + fit_.phi.size());
    columns << fit_.scaled.A, weights_.sd.cwiseInverse().asDiagonal() * fit_.derivatives.places;
    columns /= inference_.sd_factor;
    Matrix information = columns.transpose() * columns;
    const Matrix root = tolerances_of_fit() * columns_.directions.scale.asDiagonal();
    information.topLeftCorner(k, k) += root.transpose() * root;
    const auto chosen = calibration::next_poses(information, rows_of_candidates(), table_.fit.size(), table_.next);
    const std::size_t coordinates = machine_.candidates.coordinates();
    made.result.next_pose = Array<double, axis::Next, axis::Coordinate>({chosen.size(), coordinates});
    made.result.gain = Array<double, axis::Next>({chosen.size()});
    made.result.candidate = Array<std::uint64_t, axis::Next>({chosen.size()});
    for (std::size_t n = 0; n < chosen.size(); ++n) {
      std::ranges::copy(machine_.candidates[PoseIndex(chosen[n].candidate)], made.result.next_pose.row(n).begin());
      made.result.gain(n) = chosen[n].gain;
      made.result.candidate(n) = chosen[n].candidate;
    }
  }

  /// The matrix Prior::root that follows from the tolerances of the fitted errors, even if the fit uses no prior. If
  /// some fitted error has no tolerance, the scales of the fitted errors are used as tolerances.
  Matrix tolerances_of_fit() const {
    CalibrationTable with_prior = table_;
    with_prior.prior = PriorKnowledge::tolerances;
    if (columns_.has_tolerances) return fitted_columns(machine_.study, with_prior, exact_).prior.root;
    return columns_.directions.scale.cwiseInverse().asDiagonal();
  }

  const MachineToCalibrate& machine_;
  const CalibrationTable& table_;
  calibration::ExactMachine exact_;
  calibration::CoordinateError commanded_;
  Weights weights_;
  FittedColumns columns_;
  calibration::Measurement measurement_;
  calibration::FitResult fit_;
  calibration::Inference inference_;
  std::uint64_t solves_ = 0;  ///< number of solves by the threads of over_poses()
};

}  // namespace

Calibrated calibrate(const MachineToCalibrate& machine) { return Calibration(machine).run(); }

}  // namespace poesy::calibration
