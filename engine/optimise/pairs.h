#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/optimise/sized_problem.h"

/// Presolve of pairs of parts (Within in least_cost.h), which bounds their sizes before the search. Let u be the size
/// of the outer part and v the size of the inner part, 0 <= v <= share x u. All allowed sizes are (u, v) = a (1, 0) + b
/// (1, share) with a, b >= 0. A larger a or b never lowers the use of a limit (the combined effect), even if the inner
/// part's effect is negative. So the unused room of a limit bounds both a and b.
namespace poesy {

/// Replaces the processes of the outer part of each pair by processes that describe both parts (SizedProcess::inner).
/// Precondition: some process of the inner part fits in one of the outer part, or the inner part may be left out.
void join_pairs(SizedProblem& problem);

/// Whether a part is in a pair.
bool is_in_pair(const SizedProblem& problem, std::size_t part);

/// In each process in which no limit stops the growth of an outer part, fixes the outer part at its largest size. Adds
/// the outer parts that have no largest size to `unbounded`.
void fix_free_pairs(SizedProblem& problem, std::vector<std::size_t>& unbounded);

/// Removes the processes of a pair that break a limit even if all other parts use as little of the limit as they can.
/// Bounds the sizes of the remaining processes. left: [limits] the unused room of each limit if all parts use as little
/// of it as they can. Returns a limit that every process breaks, or none.
std::optional<std::size_t> tighten_pair(SizedProblem& problem, const Within& pair, std::span<const double> left);

/// Restricts a pair to the sizes that use limit l least. A size that does not affect this limit stays free. Returns
/// true if the cost at the largest of the remaining sizes is finite for at least one process.
bool fix_at_least_use(SizedProblem& problem, const Within& pair, std::size_t l);

}  // namespace poesy
