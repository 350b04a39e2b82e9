#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/array.h"
#include "engine/kinds/monte_carlo/machine_table.h"
#include "engine/kinds/monte_carlo/part_sums.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/stats/linear_fit.h"
#include "engine/stats/machines.h"
#include "engine/stats/main_effects.h"
#include "engine/stats/moments.h"
#include "engine/stats/number_block.h"
#include "engine/stats/sums.h"
#include "engine/stats/yield_gradient.h"

/// Units of work that solve machines, and sums over machines.
namespace poesy::monte_carlo {

/// Sums over machines. Their rounding depends on the order of addition, so MergeTree adds them in a fixed order.
struct MachineSums {
  Array<Moments, axis::Pose, axis::Response> at_pose;  ///< moments of the samples that count in statistics (counts())
  std::vector<Moments> mean;                           ///< [responses] moments of the machines' means over the poses
  std::vector<Moments> largest;                        ///< [responses] moments of the machines' largest magnitudes
  std::vector<Moments> rms;                            ///< [responses] moments of the machines' root mean squares
  std::optional<ScoreSums> scores;  ///< sums of the scores of the errors over rejected machines, for the gradient of
                                    ///< the yield; set if there are limits
  /// Sums of the scores of the errors that machines draw anew at each pose, over the machines that are rejected at
  /// exactly one pose, with the errors at that pose. Set if there are limits and such errors, and all limits are judged
  /// at each pose.
  std::optional<ScoreSums> pose_scores;
  std::optional<LinearFitSums> fit;  ///< sums for the fit of a linear map from the errors to the limited vectors
                                     ///< (LimitedVector) at all poses together
  /// [poses] Sums for a separate linear fit at each pose. They replace `fit` if machines draw errors anew at each pose;
  /// otherwise empty.
  std::vector<std::optional<LinearFitSums>> fit_at_pose;
  std::optional<PartSums> parts;  ///< sums of the influence of each measured part (one measured value of an error) on
                                  ///< the share of rejects; set if there are limits and measured errors
  std::vector<MainEffectSums> effects;  ///< [MachineTable::effects()] sums for main effects

  /// Empty sums.
  explicit MachineSums(const MachineTable& table);
  /// Adds later machines. Precondition: the machines of `later` come after those of this object.
  void merge(const MachineSums& later);

  /// The fitted linear map from the errors to the limited vectors at all poses, whose components are listed pose by
  /// pose; none if too few machines were fitted.
  std::optional<LinearFit> map() const;
  void state(Archive& archive);  ///< Reads or writes the sums, bit for bit.

 private:
  const MachineTable* table_;
};

/// Numbers of calibrated machines that would be rejected without calibration, and with the best correction of the
/// drives at each pose.
struct CalibrationCounts {
  std::uint64_t not_fitted = 0;    ///< machines that were not calibrated: they were not solved where they are measured,
                                   ///< or their fit did not converge
  std::uint64_t uncalibrated = 0;  ///< rejects if no machine is calibrated
  /// Rejects after the best correction of the drives at each pose, if the model can compute it.
  std::uint64_t best = 0;

  /// Adds the counts of other machines.
  void merge(const CalibrationCounts& other);
  /// Reads or writes the counts. machines: the number of machines, which no count may exceed.
  void state(Archive& archive, std::uint64_t machines);
};

/// Reads or writes whether each machine of a range is rejected, 1 or 0. This is recorded only for the first
/// MachineTable::kept() machines.
void rejected_state(Archive& archive, std::vector<std::uint8_t>& rejected, const MachineTable& table,
                    const NumberRange& machines);

/// The result of solving a unit of machines.
struct MachineUnit {
  MachineUnit() = default;
  /// An empty unit for this range of machines.
  MachineUnit(const MachineTable& table, const NumberRange& range);

  std::optional<MachineSums> sums;  ///< empty only in a default-constructed unit
  MachineCounts counts;             ///< numbers of good and rejected machines
  CalibrationCounts calibration;    ///< counts for calibrated machines; 0 if machines are not calibrated
  /// The samples that count in statistics (counts()), prepared for a quantile sketch.
  Array<NumberBlock, axis::Pose, axis::Response> at_pose;
  std::vector<NumberBlock> largest;    ///< [responses] largest magnitude of each machine that is solved at every pose
  std::vector<NumberBlock> rms;        ///< [responses] root mean square of each machine that is solved at every pose
  std::vector<NumberBlock> judged;     ///< value by which each machine is judged, for each response
                                       ///< of MachineTable::judged()
  std::vector<std::uint8_t> rejected;  ///< 1 if the machine is rejected, otherwise 0, for the first
                                       ///< MachineTable::kept() machines of the study
  std::vector<SolveCounts> solves;     ///< [poses] how the solves at each pose ended
  std::vector<FailedSamples> failed;   ///< [poses] the first failed samples at each pose
  SolveCounts total;                   ///< how the solves at all poses ended

  void state(Archive& archive);  ///< Reads or writes the unit, for messages between ranks and for checkpoints.

 private:
  const MachineTable* table_ = nullptr;
  NumberRange machines_{};
};

/// Solves units of machines: draws the errors of the machines of a unit, and solves these machines pose by pose. Owns
/// the scratch memory of one thread. The result of a unit depends only on the study and the unit.
class MachineUnitEvaluator : private UnitSolver {
 public:
  /// Keeps references to both arguments.
  MachineUnitEvaluator(const MachineTable& table, const Model& model);

  /// Solves the machines of unit n at all poses.
  MachineUnit operator()(std::size_t n);

 private:
  /// Calibrates the unit's machines, so that the following solves are with the calibrated controllers. Before that,
  /// counts the machines that are rejected without calibration and with the best correction.
  void calibrate(const WorkUnit& unit, MachineUnit& found);
  /// The number of machines of the unit that are rejected if the evaluator that is set by solve_by() solves them; 0
  /// without limits.
  std::uint64_t count_rejects(const WorkUnit& unit);
  /// Draws the errors that machines draw anew at this pose. If main effects are summed at this pose, also updates the
  /// bins of these errors.
  void draw_at(const WorkUnit& unit, std::size_t pose, EffectBins& bins);
  void solve_pose(const WorkUnit& unit, std::size_t pose, const EffectBins& bins, MachineBlock& block,
                  MachineUnit& found);
  /// Counts the poses at which each machine breaks a limit or is not solved. At the first such pose, records the errors
  /// that machines draw anew at each pose.
  void note_rejects(const UnitOutcomes& outcomes, std::span<const std::uint8_t> ok);
  void add_machines(const MachineBlock& block, const EffectBins& bins, MachineUnit& found);
  /// [errors x machines] The errors of the present draws, minus their means and divided by their standard deviations.
  Array<double, axis::Factor, axis::Sample> standardised(std::size_t machines) const;
  /// Subtracts the mean over the poses from the components of the vectors with LimitedVector::is_centred.
  void centre_rows();
  /// Adds the machines of the present unit to the fit of the limited vectors, whose components at all poses are in
  /// `rows_`. solved: [machines] 1 if the machine is solved at every pose, otherwise 0.
  void add_fit(std::span<const std::uint8_t> solved, MachineUnit& found) const;
  /// Adds the samples at one pose to the fit of that pose. ok: [machines] 1 if the sample counts in statistics,
  /// otherwise 0.
  void add_fit_at(std::size_t pose, std::span<const std::uint8_t> ok, MachineUnit& found) const;
  /// The values for which `counts` is 1.
  std::span<const double> only(std::span<const double> values, std::span<const std::uint8_t> counts);

  const MachineTable* table_;
  std::unique_ptr<MachineCalibrator> calibrator_;  ///< null: machines are not calibrated
  /// Evaluator of machines after the best correction at each pose; null: the model cannot compute this correction.
  std::unique_ptr<Evaluator> best_;
  std::unique_ptr<Evaluator> calibrated_;  ///< evaluator of the calibrated machines of the present unit
  /// [machines] 1 if the sample of the machine at the present pose counts in statistics (counts()), otherwise 0.
  std::vector<std::uint8_t> counts_;
  Array<double, axis::Response, axis::Sample> sum_;  ///< sums of the machines' responses over the poses
  std::vector<double> kept_;                         ///< values of one response in the samples that count, see only()
  bool is_fitted_ = false;                           ///< whether the linear map is fitted to the present unit
  /// Additional outputs of the model at the present pose, if a limited vector is computed from them.
  Array<double, axis::DetailComponent, axis::Sample> details_;
  /// Components of the limited vectors at all poses, if the linear map is fitted to the unit.
  Array<double, axis::Pose, axis::VectorRow, axis::Sample> rows_;
  std::vector<std::uint8_t> poses_beyond_;  ///< [machines] number of poses at which the machine breaks a limit or is
                                            ///< not solved: 0, 1, or 2 for more
  /// [errors x machines] The values of the errors that machines draw anew at each pose, at the first pose at which the
  /// machine breaks a limit or is not solved.
  Array<double, axis::Factor, axis::Sample> deciding_;
};

}  // namespace poesy::monte_carlo
