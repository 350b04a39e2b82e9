#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/allocation/mean_squares.h"
#include "engine/kinds/allocation/programme.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/kind.h"

/// The search for the tolerances of a study: linearise, settle, scale, improve, then scale to other machines and use
/// the remaining yield (search_stages.h). Each stage makes a value from that of the stage before. It is a sequence of
/// runs, each with a checkpoint of its own, and its decisions follow from the study alone.
namespace poesy::allocation {

/// How many rejects a certificate allows, and how many the design may have so that its certificate will hold.
struct AllowedRejects {
  std::uint64_t certificate;  ///< rejects that the certificate allows among this many fresh machines
  std::uint64_t design;       ///< rejects that the design may have among as many machines
};

/// How many rejects among this many machines still show, with this confidence (Clopper and Pearson), that the share
/// `yield` of machines is good. The design may have so many that, with 99 % probability, as many fresh machines have no
/// more than the certificate allows; both numbers of rejects are taken as normal. Precondition: machines >=
/// trials_without_failure().
AllowedRejects allowed_rejects(double yield, double confidence, std::uint64_t machines);

/// The seed of machines that no other part of the study draws: set 0 for the certificate, set 1 for the last scaling.
std::uint64_t seed_of_others(const Study& study, SampleIndex set);

/// The problem of a search, the same in all its stages.
struct SearchProblem {
  /// Refers to the run.
  explicit SearchProblem(const StudyRun& study_run);

  const StudyRun& run;               ///< the study, its model and how it is run
  const AllocationOptions& options;  ///< the options of the study
  ToleranceProgramme programme;      ///< the parts
  AllowedRejects allowed;            ///< allowed rejects of as many machines as the study has samples
};

/// Mean squares of limited responses and the tolerances at which they were measured. Around these, limits on root mean
/// squares are linear in T^2.
struct Linearisation {
  std::vector<double> at;  ///< [N] tolerances
  MeanSquares squares;     ///< mean squares at these tolerances, and their slopes
};

/// Tolerances during the search, and the result of the last programme.
struct Candidate {
  TolerancePoint point;     ///< the tolerances
  ChosenTolerances chosen;  ///< the tolerances of the last programme, with its bound and its multipliers
  double share = 0.0;       ///< the share of each limit that this programme allowed its root mean square
};

/// The machines with the largest loads, among which the deciding one is expected.
struct ScreenedMachines {
  std::vector<std::uint32_t> numbers;  ///< [n] ascending
  std::vector<double> load;            ///< [n]
};

/// Tolerances at which the design's machines were tried.
struct ToleranceDesign {
  Candidate candidate;     ///< the tolerances
  std::uint64_t seed = 0;  ///< the seed of the machines
  std::vector<double>
      load;  ///< [machines] the loads when all machines were tried last; newer ones for screened machines
  ScreenedMachines
      screened;  ///< screened machines with their loads at these tolerances; empty if these are the lowest tolerances
};

/// The stages of a search so far.
struct StageLog {
  std::vector<AllocationStage> stages;  ///< in their order
  std::vector<double> tolerance;        ///< [stages x N]

  /// Adds a stage that ended with this candidate, `machines` that were tried, and the rejects among them.
  void add(std::string name, const Candidate& candidate, std::uint64_t machines, std::uint64_t rejects);
};

/// The result of a search.
struct FoundTolerances {
  Linearisation linearisation;        ///< the linearisation of the last programme
  ToleranceDesign design;             ///< the tolerances and the loads of the design's machines
  std::vector<double> coarser_yield;  ///< [N] see AllocationResult::coarser_yield
  StageLog log;                       ///< the stages of the search
};

/// Runs the search. Empty when stopped. Throws InputError if no tolerances keep the limits, naming the limit and by how
/// much it is exceeded.
std::optional<FoundTolerances> find_tolerances(const SearchProblem& problem);

/// The limits of the last programme.
ToleranceLimits limits_of(const SearchProblem& problem, const FoundTolerances& found);

/// The predicted cost with another share, or with limits multiplied by `wider`, from the last programme; NaN if it has
/// none.
double predicted_cost(const SearchProblem& problem, const FoundTolerances& found, double share, double wider);

/// The number of machines with a load above 1.
std::uint64_t rejects_of(std::span<const double> load);

}  // namespace poesy::allocation
