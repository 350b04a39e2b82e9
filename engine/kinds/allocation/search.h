#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/allocation/mean_squares.h"
#include "engine/kinds/allocation/near_limit.h"
#include "engine/kinds/allocation/programme.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/allocation/trial.h"
#include "engine/kinds/allocation/variations.h"
#include "engine/kinds/kind.h"

namespace poesy {

/// How many rejects a certificate allows, and how many the design may have so that its certificate will hold.
struct AllowedRejects {
  std::uint64_t certificate;  ///< of so many fresh machines
  std::uint64_t design;       ///< of as many others
};

/// For a share `yield` of good machines, shown with this confidence (Clopper and Pearson) by so many machines. The
/// design may have so many rejects that, with 99 % probability, as many fresh machines have no more than the
/// certificate allows; both numbers of rejects are taken as normal. Precondition: machines >= trials_without_failure().
AllowedRejects allowed_rejects(double yield, double confidence, std::uint64_t machines);

/// The seed of a set of machines that no other part of the study draws: set 0 is the certificate's, set 1 that of the
/// last scaling.
std::uint64_t seed_of_others(const Study& study, SampleIndex set);

/// Looks for the tolerances of a study, in stages; each stage is a run of its own, from its checkpoint on. What a stage
/// decides follows from the study alone.
class ToleranceSearch {
 public:
  /// Refers to the run.
  explicit ToleranceSearch(const StudyRun& run);

  /// Whether it came to its end; false when stopped. Throws InputError where no tolerances keep the limits, with the
  /// limit, and by how much.
  bool find();

  const ToleranceProgramme& programme() const { return programme_; }               ///< The parts.
  const TolerancePoint& found() const { return found_; }                           ///< The tolerances.
  const std::vector<double>& stage_tolerance() const { return stage_tolerance_; }  ///< [stages x N].
  const std::vector<AllocationStage>& stages() const { return stages_; }           ///< The way to them.
  const AllowedRejects& allowed() const { return allowed_; }                       ///< With so many machines.
  /// [n] Loads of the design's machines at found(); below kNear of the limit as they were before the last scaling.
  std::span<const double> loads() const { return trial_.load; }
  std::uint64_t rejects() const { return trial_.rejects(); }                   ///< Of these machines.
  const std::vector<double>& coarser_yield() const { return coarser_yield_; }  ///< [N] as AllocationResult has it.
  /// The last programme under limits on root mean squares, for what its prices say.
  const ToleranceLimits& limits() const { return limits_; }
  const ChosenTolerances& chosen() const { return chosen_; }  ///< Of that programme.
  const MeanSquares& squares() const { return squares_; }     ///< By which these limits were found.
  double share() const { return share_; }                     ///< Of each limit that its root mean square may take.
  /// The cost of another share, or of wider limits, by the last programme; NaN where it has none.
  double cost_at(double share, double wider) const;

 private:
  bool measure(std::span<const double> tolerance, std::size_t draws);
  bool choose(const TrustRegion& region);
  bool choose_by_least_share(double low, double high, const TrustRegion& region);
  bool linearise();
  bool settle_effects();
  bool rescale(double load);
  bool come_near();
  bool meet_yield();
  bool improve_by_gradient();
  bool scale_near(const std::vector<bool>& stays);
  std::vector<bool> none_stays() const { return std::vector<bool>(programme_.size(), false); }
  std::optional<bool> left_out() const;
  bool scale_to_others();
  bool leave_none_idle();

  /// Machines of the design that were tried at some tolerances.
  struct Tried {
    std::vector<std::uint32_t> machines;  ///< their numbers
    Trial trial;                          ///< of these
  };

  /// Tolerances by a programme.
  struct Programmed {
    TolerancePoint point;
    ChosenTolerances chosen;
    double share;
  };

  std::size_t trial_machines() const { return run_.study.analysis.samples; }
  Study tried_at(std::span<const double> tolerance) const;
  std::optional<Trial> try_all() const;
  std::optional<Tried> try_some(const TolerancePoint& point, std::vector<std::uint32_t> machines) const;
  std::vector<std::uint32_t> near_machines() const;
  std::optional<Tried> try_near(const TolerancePoint& point) const;
  bool try_found();

  /// A part that is made coarser.
  struct CoarserPart {
    std::size_t part;
    double step;   ///< its errors are so many times as large
    double steps;  ///< to the next tolerance that can be had, in T^2
  };

  bool try_coarser(std::span<const std::size_t> parts);
  bool try_small(std::span<const CoarserPart> parts);
  Variation varied(std::size_t part, double factor) const;
  std::optional<std::vector<double>> try_varied(const NearLimit& near, std::span<const Variation> variations) const;
  void set_coarser_yield(const CoarserPart& of, double come);
  std::vector<std::size_t> idle_parts(std::span<const std::size_t> parts) const;
  std::optional<bool> loosen(std::vector<std::size_t> idle);
  void take(const Programmed& of);
  std::optional<bool> lower_what_rejects();
  bool lower_to_least();

  /// Scores of errors among some machines.
  struct Scores {
    std::vector<double> of_part;  ///< [N] sums over its errors and the machines
    double machines = 0.0;        ///< how many
  };

  std::vector<double> shares_by_price() const;
  std::vector<std::uint32_t> machines_of_largest_load() const;
  Scores scores(std::span<const std::uint32_t> machines) const;
  bool is_sure(const Scores& of, std::size_t part) const;
  std::vector<bool> rejecting_parts() const;
  ToleranceLimits gradient_limits() const;
  std::optional<bool> fit_gradient(ToleranceLimits direction);

  void add_stage(std::string name, std::uint64_t machines, std::uint64_t rejects);
  std::string row_text(std::size_t row) const;
  [[noreturn]] void refuse(const Infeasible& broken) const;
  [[noreturn]] void refuse_lowest() const;
  [[noreturn]] void refuse_unbounded(std::uint64_t rejects) const;
  [[noreturn]] void refuse_endless(const Unbounded& endless) const;

  const StudyRun& run_;
  const AllocationOptions& asked_;
  ToleranceProgramme programme_;
  AllowedRejects allowed_;
  std::uint64_t seed_;                 ///< of the machines that are tried
  double share_;                       ///< of a limit, for root mean squares
  MeanSquares squares_;                ///< at measured_
  std::vector<double> measured_;       ///< [N] tolerances at which squares_ hold
  ToleranceLimits limits_;             ///< of the last programme
  ChosenTolerances chosen_;            ///< by it
  Programmed settled_;                 ///< the last one before machines were tried
  TolerancePoint found_;               ///< the best so far
  Trial trial_;                        ///< of all machines of the design, the last one
  Tried near_;                         ///< machines that may decide, at found_
  std::vector<double> coarser_yield_;  ///< [N]
  std::vector<AllocationStage> stages_;
  std::vector<double> stage_tolerance_;  ///< [stages x N]
};

}  // namespace poesy
