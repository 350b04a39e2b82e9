#pragma once

#include "engine/report/rankings.h"
#include "engine/report/tables.h"

namespace poesy {

/// A beside B, of the errors that both have. Errors without effect share the last rank; those whose effect cannot be
/// told from rounding have none and do not count for the tau. Throws InputError where the results are of two kinds or
/// mechanisms, or have no error in common. Precondition: sensitivity results.
TwoRankings two_rankings(const RankedResult& a, const RankedResult& b, RowOrder order = RowOrder::effect);

}  // namespace poesy
