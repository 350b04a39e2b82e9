#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/kinds/allocation/search.h"
#include "engine/run/result.h"

/// The stages of the search for tolerances. Each function returns a new value, adds what users see to a log, and throws
/// SearchStopped if a run of machines was stopped.
namespace poesy::allocation {

/// Thrown by the stages and caught by find_tolerances().
struct SearchStopped {};

/// The value of a run; throws SearchStopped if there is none.
template <class Value>
Value unless_stopped(std::optional<Value> value) {
  if (!value) throw SearchStopped();
  return *std::move(value);
}

/// @name Parts of several stages
/// @{

/// Measures mean squares at these tolerances [N], among `draws` draws of the other errors.
Linearisation measure(const SearchProblem& problem, std::span<const double> tolerance, std::size_t draws);
/// The tolerances of a programme that allows root mean squares this share of each limit; none if it is infeasible.
/// Throws InputError if it is unbounded.
std::optional<Candidate> choose(const SearchProblem& problem, const Linearisation& linearisation, double share,
                                const TrustRegion& region);
/// The tolerances of the programme with the least feasible share between these two, to a thousandth.
std::optional<Candidate> choose_by_least_share(const SearchProblem& problem, const Linearisation& linearisation,
                                               double low, double high, const TrustRegion& region);
/// The largest a_i / b_i or b_i / a_i.
double largest_ratio(std::span<const double> a, std::span<const double> b);

/// The study that draws the machines of this seed with these tolerances [N].
Study machine_study(const SearchProblem& problem, std::uint64_t seed, std::span<const double> tolerance);
/// The loads of the first `machines` machines, or of all if no number is given.
std::vector<double> loads_of(const SearchProblem& problem, std::uint64_t seed, std::span<const double> tolerance,
                             std::optional<std::size_t> machines = std::nullopt);
/// The load that would be the limit with exactly this many rejects: the one after the `rejects` largest.
double deciding_load(std::vector<double> load, std::uint64_t rejects);
/// The numbers of the machines that may decide: their loads are at least kScreeningLoad times the deciding one.
std::vector<std::uint32_t> screen(const SearchProblem& problem, std::span<const double> load);
/// Tries the design's screened machines at other tolerances.
ScreenedMachines try_screened(const SearchProblem& problem, const ToleranceDesign& design, const TolerancePoint& point);
/// Tries all machines of a seed with the candidate's tolerances.
ToleranceDesign try_all(const SearchProblem& problem, Candidate candidate, std::uint64_t seed);
/// The design with the loads of its screened machines inserted among those of all.
ToleranceDesign with_screened_loads(ToleranceDesign design);
/// Whether a pilot of all machines has rejects that were screened out.
bool misses_rejects(const SearchProblem& problem, const ToleranceDesign& design);
/// Multiplies all tolerances except those that stay [N] by one factor, with which the screened machines have the
/// rejects that the design allows. If even the lowest tolerances break the yield, although they kept it for other
/// machines, the design stays as it is and the certificate decides.
ToleranceDesign scale_screened(const SearchProblem& problem, const ToleranceDesign& from,
                               const std::vector<bool>& stays);

/// Scores of parts: sums of x^2 - 1 over some machines, where x is an error over its standard deviation.
struct PartScores {
  std::vector<double> of_part;  ///< [N] sums over the errors of each part, each times its growth with the tolerance
  std::vector<bool> is_sure;    ///< [N] whether the score is more than noise (kSignificance)
};

/// The scores of these machines of a design.
PartScores part_scores(const SearchProblem& problem, const ToleranceDesign& design,
                       std::span<const std::uint32_t> machines);
/// @}

/// A candidate and the linearisation that its programme used.
struct Linearised {
  Linearisation linearisation;  ///< the linearisation of its limits
  Candidate candidate;          ///< the tolerances of its programme
};

/// The tolerances if every effect were linear. If root mean squares cannot be as small as a normal response needs for
/// the yield, they are as small as possible.
Linearised linearise(const SearchProblem& problem, StageLog& log);

/// Tolerances at which effects have settled.
struct Settled {
  Linearisation linearisation;  ///< the last linearisation
  Candidate candidate;          ///< the settled tolerances; the lowest ones where the last programme was infeasible
  Candidate feasible;           ///< the last tolerances that a programme chose
};

/// Measures effects at the tolerances and chooses tolerances by them, until they no longer change.
Settled settle(const SearchProblem& problem, Linearised from, StageLog& log);

/// A design and the linearisation that its programme used.
struct Scaled {
  Linearisation linearisation;  ///< the linearisation of its limits
  ToleranceDesign design;       ///< a design with no more rejects than allowed
};

/// Scales the limits on root mean squares until the design has the rejects that are allowed, and no more.
Scaled scale_to_yield(const SearchProblem& problem, Settled from, StageLog& log);

/// Corrects the shares of the parts by the gradient of the yield, estimated from the machines of largest load, if that
/// saves cost.
ToleranceDesign improve(const SearchProblem& problem, const Linearisation& linearisation, ToleranceDesign from,
                        StageLog& log);

/// Scales all tolerances to new machines, because those by which the parts' shares were chosen make the yield look
/// better than it is.
ToleranceDesign scale_to_other_machines(const SearchProblem& problem, const ToleranceDesign& from, StageLog& log);

/// A design and the yield that it would have with each part coarser alone.
struct Probed {
  ToleranceDesign design;             ///< the tolerances
  std::vector<double> coarser_yield;  ///< [N] see AllocationResult::coarser_yield
};

/// Finds the effect of each part alone, and makes those parts coarser that the yield allows: at the least cost, no part
/// can be coarser alone.
Probed use_remaining_yield(const SearchProblem& problem, ToleranceDesign from, StageLog& log);

/// Rounds tolerances down to what their parts ask for, and tries all machines again if any changes.
Probed round_down(const SearchProblem& problem, Probed from, StageLog& log);

/// @name Refusals, which throw InputError
/// @{
/// Refuses a study whose perfect mechanism is beyond a limit at some pose.
void refuse_perfect_beyond(const SearchProblem& problem);
[[noreturn]] void refuse_infeasible(const SearchProblem& problem, const Infeasible& infeasible);
[[noreturn]] void refuse_unbounded(const SearchProblem& problem, const Unbounded& unbounded);
/// Refuses a study whose lowest tolerances have too many rejects.
[[noreturn]] void refuse_lowest(const SearchProblem& problem, std::uint64_t rejects);
/// Refuses a study whose lowest tolerances are perfect parts. rejects: those at the smallest tolerances tried before.
[[noreturn]] void refuse_perfect(const SearchProblem& problem, std::uint64_t rejects);
/// @}

}  // namespace poesy::allocation
