#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/kinds/allocation/search.h"
#include "engine/run/result.h"

/// The stages of the search for tolerances. The function of a stage returns new tolerances and adds the stage to a log.
/// It throws SearchStopped if a run of machines was stopped.
namespace poesy::allocation {

/// The exception with which a stage ends if a run of machines was stopped. find_tolerances() catches it.
struct SearchStopped {};

/// The value that a run returned. Throws SearchStopped if there is none, because the run was stopped.
template <class Value>
Value unless_stopped(std::optional<Value> value) {
  if (!value) throw SearchStopped();
  return *std::move(value);
}

/// @name Functions that several stages use
/// @{

/// Measures mean squares at these tolerances [parts], with `draws` draws of the other errors while one error is varied.
/// If machines are calibrated, the other errors are at their centres instead. known: [parts] the tolerances from which
/// a calibration takes its prior knowledge; empty: `tolerance`.
Linearisation measure(const SearchProblem& problem, std::span<const double> tolerance, std::size_t draws,
                      std::span<const double> known = {});
/// Solves the optimisation problem (ToleranceProgramme) in which root mean squares may use this share of each limit.
/// None if it is infeasible. Throws InputError if it is unbounded.
std::optional<Candidate> choose(const SearchProblem& problem, const Linearisation& linearisation, double share,
                                const TrustRegion& region);
/// The candidate that choose() returns for the smallest feasible share between `low` and `high`. The share is accurate
/// to a thousandth. None if `high` is infeasible too.
std::optional<Candidate> choose_by_least_share(const SearchProblem& problem, const Linearisation& linearisation,
                                               double low, double high, const TrustRegion& region);
/// The largest of the ratios a_i / b_i and b_i / a_i, over all i; 1 if a and b are equal.
double largest_ratio(std::span<const double> a, std::span<const double> b);

/// The study whose machines have this seed and these tolerances [parts].
Study machine_study(const SearchProblem& problem, std::uint64_t seed, std::span<const double> tolerance);
/// The loads (MachineLoads) of the first `machines` machines, or of all machines if `machines` is not given.
std::vector<double> loads_of(const SearchProblem& problem, std::uint64_t seed, std::span<const double> tolerance,
                             std::optional<std::size_t> machines = std::nullopt);
/// The deciding load: the largest load after those of the `rejects` worst machines. If the limit were at this load,
/// exactly `rejects` machines would be rejected.
double deciding_load(std::vector<double> load, std::uint64_t rejects);
/// The numbers of the machines that may decide whether the yield is kept: those with at least kScreeningLoad times the
/// deciding load.
std::vector<std::uint32_t> screen(const SearchProblem& problem, std::span<const double> load);
/// Solves, at the tolerances of `point`, those machines of a design that may decide whether the yield is kept
/// (screen()).
ScreenedMachines try_screened(const SearchProblem& problem, const ToleranceDesign& design, const TolerancePoint& point);
/// Solves all machines with this seed at the tolerances of a candidate, and selects those that may decide (screen()).
ToleranceDesign try_all(const SearchProblem& problem, Candidate candidate, std::uint64_t seed);
/// The design in which the loads of the screened machines replace the loads that these machines had in the last trial
/// of all machines.
ToleranceDesign with_screened_loads(ToleranceDesign design);
/// Solves only a part of all machines (a pilot) at the design's tolerances. Returns whether one of its rejects is a
/// machine that screen() did not select.
bool misses_rejects(const SearchProblem& problem, const ToleranceDesign& design);
/// Multiplies all tolerances by one factor, except those of the parts marked in `stays` [parts], so that the screened
/// machines have as many rejects as the design may have. If no factor that was tried keeps the yield for these
/// machines, the design is returned unchanged, and the certificate will show whether the yield is kept.
ToleranceDesign scale_screened(const SearchProblem& problem, const ToleranceDesign& from,
                               const std::vector<bool>& stays);

/// Scores of parts: sums of x^2 - 1 over some machines, where x is an error divided by its standard deviation. A
/// positive score means that the part's errors are larger in these machines than in all.
struct PartScores {
  /// [parts] Score of each part: the sum, over its errors, of the error's score times the error's factor `growth`. This
  /// factor says by how many per cent the error's standard deviation grows if the part's tolerance grows by 1 %
  /// (ToleranceProgramme::growth()).
  std::vector<double> of_part;
  std::vector<bool> is_sure;  ///< [parts] whether the score is significant (kSignificance)
};

/// The scores of parts in these machines of a design.
PartScores part_scores(const SearchProblem& problem, const ToleranceDesign& design,
                       std::span<const std::uint32_t> machines);
/// @}

/// Tolerances that an optimisation chose, and the mean squares (Linearisation) that it used.
struct Linearised {
  Linearisation linearisation;  ///< the linearisation that the optimisation used
  Candidate candidate;          ///< the tolerances that the optimisation chose
};

/// Finds the tolerances that would keep the yield if every effect were linear and every response normal. If root mean
/// squares cannot be made small enough for that, makes them as small as possible.
Linearised linearise(const SearchProblem& problem, StageLog& log);

/// Tolerances that hardly change any more when mean squares are measured again.
struct Settled {
  Linearisation linearisation;  ///< the last linearisation
  Candidate candidate;          ///< the last tolerances, or the lowest ones if the last optimisation problem was
                                ///< infeasible
  Candidate feasible;           ///< the last tolerances that an optimisation chose
};

/// Alternately measures mean squares at the present tolerances and optimises the tolerances, until cost and tolerances
/// hardly change.
Settled settle(const SearchProblem& problem, Linearised from, StageLog& log);

/// Tolerances with which the design's machines keep the yield, and the mean squares that the optimisation used.
struct Scaled {
  Linearisation linearisation;  ///< the linearisation that the optimisation used
  ToleranceDesign design;       ///< a design with at most the allowed number of rejects
};

/// Changes the share of limits that root mean squares may use, until the design has as many rejects as allowed. If this
/// fails, or needs a much smaller share, tightens the parts whose errors cause the rejects.
Scaled scale_to_yield(const SearchProblem& problem, Settled from, StageLog& log);

/// Makes some parts finer and others coarser, along the gradient of the yield, if that reduces the cost at the same
/// yield. The gradient is estimated from the machines with the largest loads.
ToleranceDesign improve(const SearchProblem& problem, const Linearisation& linearisation, ToleranceDesign from,
                        StageLog& log);

/// Scales all tolerances until other machines, drawn with another seed, keep the yield. The machines with which the
/// tolerances were chosen show a yield that is biased upwards.
ToleranceDesign scale_to_other_machines(const SearchProblem& problem, const ToleranceDesign& from, StageLog& log);

/// Tolerances, the loads of the design's machines with them, and the predicted yield if only one part is made coarser.
struct Probed {
  ToleranceDesign design;             ///< the tolerances, and the loads of machines with them (MachineLoads)
  std::vector<double> coarser_yield;  ///< [parts] predicted yield if the tolerance of this part alone is larger, see
                                      ///< Result::coarser_yield
};

/// Predicts the yield for each part if only this part is coarser. Makes parts coarser if that saves cost and the design
/// still has no more rejects than it may have. At the least cost, no part can be made coarser without breaking the
/// yield.
Probed use_remaining_yield(const SearchProblem& problem, ToleranceDesign from, StageLog& log);

/// Rounds tolerances down as the study asks for their parts. If a tolerance changes, tries all machines again.
Probed round_down(const SearchProblem& problem, Probed from, StageLog& log);

/// @name Refusals: these functions throw InputError
/// @{
/// Refuses a study if the mechanism with perfect parts breaks a limit at some pose.
void refuse_perfect_beyond(const SearchProblem& problem);
[[noreturn]] void refuse_infeasible(const SearchProblem& problem, const Infeasible& infeasible);
[[noreturn]] void refuse_unbounded(const SearchProblem& problem, const Unbounded& unbounded);
/// Refuses a study if the lowest tolerances have too many rejects. The message differs if perfect parts have too many.
[[noreturn]] void refuse_lowest(const SearchProblem& problem, std::uint64_t rejects);
/// Refuses a study in which only the lowest tolerances keep the limits and some of them are 0, so that parts would have
/// to be perfect. rejects: number of rejects at the smallest tolerances tried before.
[[noreturn]] void refuse_perfect(const SearchProblem& problem, std::uint64_t rejects);
/// @}

}  // namespace poesy::allocation
