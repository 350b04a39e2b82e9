#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/allocation/mean_squares.h"
#include "engine/kinds/allocation/programme.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/kind.h"
#include "engine/kinds/machine_calibration.h"

/// The search for the tolerances of a study. Its stages are linearise(), settle(), scale_to_yield(), improve(),
/// scale_to_other_machines(), use_remaining_yield() and round_down() (search_stages.h). Each stage computes new
/// tolerances from those of the stage before. The search is a sequence of runs, each with a checkpoint of its own. The
/// decisions of the search depend only on the study.
namespace poesy::allocation {

/// The numbers of rejects that the certificate and the design may have. The design is the set of machines with which
/// the tolerances are found; the certificate is a set of fresh machines that is solved once, after the search.
struct AllowedRejects {
  std::uint64_t certificate;  ///< largest number of rejects with which the certificate holds
  std::uint64_t design;       ///< largest number of rejects among the machines of the design with which the certificate
                              ///< will probably hold; the design has as many machines as the certificate
};

/// The allowed numbers of rejects among this many machines. The certificate allows as many rejects as still show, with
/// this confidence (Clopper and Pearson), that the yield is at least `yield`. The number for the machines of the design
/// is smaller: if the design has no more rejects than this number, fresh machines have with 99 % probability no more
/// rejects than the certificate allows. For this, the numbers of rejects of both sets of machines are approximated as
/// normal. Precondition: machines >= trials_without_failure().
AllowedRejects allowed_rejects(double yield, double confidence, std::uint64_t machines);

/// A seed for a set of machines, which the study uses for nothing else. set: 0 for the machines of the certificate, 1
/// for those of scale_to_other_machines().
std::uint64_t seed_of_others(const Study& study, SampleIndex set);

/// The data that a search needs, which do not change between its stages.
struct SearchProblem {
  /// Keeps a reference to the run.
  explicit SearchProblem(const StudyRun& study_run);

  const StudyRun& run;                            ///< the study, its model and how it is run
  const Options& options;                         ///< the options of the study
  ToleranceProgramme programme;                   ///< the optimisation problem for the tolerances of the parts
  AllowedRejects allowed;                         ///< allowed rejects among as many machines as the study has samples
  std::optional<MachineCalibration> calibration;  ///< how the study's machines are calibrated; none: they are not

  /// The calibration of the machines of another study, which differs from the study of the search only in the sizes of
  /// its errors or in its seed. The other study must outlive the calibration. Null: machines are not calibrated.
  std::unique_ptr<const MachineCalibration> calibration_of(const Study& study) const;
};

/// Mean squares of limited responses, and the tolerances T at which they were measured. Near these tolerances, limits
/// on root mean squares are linear in T^2.
struct Linearisation {
  std::vector<double> at;  ///< [parts] tolerances of the measurement
  MeanSquares squares;     ///< mean squares at these tolerances, and their slopes
};

/// The tolerances at some point of the search, and the solution of the last optimisation (ToleranceProgramme).
struct Candidate {
  TolerancePoint point;     ///< the present tolerances
  ChosenTolerances chosen;  ///< the solution of the last optimisation, with its lower bound and multipliers
  double share = 0.0;       ///< the share of each limit that root mean squares could use in the last optimisation
};

/// The machines of a design with the largest loads. Among them is the machine that decides whether the yield is kept.
struct ScreenedMachines {
  std::vector<std::uint32_t> numbers;  ///< [machines] numbers of the machines, ascending
  std::vector<double> load;  ///< [machines] load of each machine: its largest ratio of a response to its limit
};

/// Tolerances, and the loads of the design's machines with them. The load of a machine is its largest ratio of a
/// response to its limit (MachineLoads).
struct ToleranceDesign {
  Candidate candidate;        ///< the tolerances, with the solution of the last optimisation
  std::uint64_t seed = 0;     ///< the seed of the machines
  std::vector<double> load;   ///< [machines] loads from the last trial of all machines; with_screened_loads() updates
                              ///< them
  ScreenedMachines screened;  ///< screened machines with their loads at these tolerances; empty if the tolerances are
                              ///< the lowest ones
};

/// The stages of a search so far.
struct StageLog {
  std::vector<AllocationStage> stages;  ///< the stages, in order
  std::vector<double> tolerance;        ///< [stages x parts] tolerances at the end of each stage

  /// Adds a stage that ended with this candidate. machines: how many machines the stage tried; rejects: how many of
  /// them were rejects.
  void add(std::string name, const Candidate& candidate, std::uint64_t machines, std::uint64_t rejects);
};

/// The result of a search.
struct FoundTolerances {
  Linearisation linearisation;  ///< the linearisation that the last optimisation used
  ToleranceDesign design;       ///< the tolerances, and the loads of the design's machines with them (MachineLoads)
  std::vector<double> coarser_yield;  ///< [parts] predicted yield if the tolerance of this part alone is larger, see
                                      ///< Result::coarser_yield
  StageLog log;                       ///< the stages of the search
};

/// Runs the search. Returns nothing if the run was stopped. Throws InputError if no tolerances keep the limits; the
/// message names a limit and by how much it is exceeded.
std::optional<FoundTolerances> find_tolerances(const SearchProblem& problem);

/// The limits of the last optimisation of a search.
ToleranceLimits limits_of(const SearchProblem& problem, const FoundTolerances& found);

/// The predicted cost if root mean squares may use `share` of each limit and all limits are multiplied by `wider`: the
/// cost of the tolerances that the optimisation then chooses from the mean squares of the last optimisation, rounded
/// down as the study asks. NaN if no tolerances keep these limits.
double predicted_cost(const SearchProblem& problem, const FoundTolerances& found, double share, double wider);

/// The number of rejects: machines with a load (MachineLoads) above 1.
std::uint64_t rejects_of(std::span<const double> load);

}  // namespace poesy::allocation
