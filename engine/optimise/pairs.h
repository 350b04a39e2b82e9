#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/optimise/sized_problem.h"

/// Presolve of pairs of parts (Within). All sizes (u, v) of a pair, 0 <= v <= share x u, are sums of growth of the
/// outer part alone, (1, 0), and of both, (1, share). Neither lowers the use of a limit, also where the inner part's
/// effect is negative; so what a limit leaves bounds both.
namespace poesy {

/// Joins the processes of the parts of each pair. Precondition: some process of the inner part fits in one of the outer
/// part, or may be left out.
void join_pairs(SizedProblem& problem);

/// Whether a part is in a pair.
bool is_in_pair(const SizedProblem& problem, std::size_t part);

/// Fixes outer parts at their largest sizes in processes in which no limit ends their growth. Adds the parts that have
/// no largest size to `unbounded`.
void fix_free_pairs(SizedProblem& problem, std::vector<std::size_t>& unbounded);

/// Erases processes of a pair that break a limit even with all other parts at their least use, and bounds the sizes of
/// the others. left: [L] the room that all parts leave at their least use. Returns a limit that no process keeps; none
/// otherwise.
std::optional<std::size_t> tighten_pair(SizedProblem& problem, const Within& pair, std::span<const double> left);

/// Fixes the sizes of a pair at its least use of a limit, as far as they affect it. Returns whether their cost is
/// finite.
bool fix_at_least_use(SizedProblem& problem, const Within& pair, std::size_t l);

}  // namespace poesy
