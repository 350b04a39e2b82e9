#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/kinds/sensitivity/result.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"

namespace poesy {

/// The errors of a sensitivity result in the order of one response. Equal errors keep the order of the study, and
/// unknown ones come last.
struct RankedErrors {
  std::size_t response;            ///< position among the result's
  std::vector<std::size_t> rows;   ///< positions of the errors in the chosen order
  std::vector<std::size_t> ranks;  ///< rank of each error by its effect, from 1
};

/// Orders the errors. Precondition: the result has the response.
RankedErrors ranked_errors(const StoredResult& result, std::string_view response, RowOrder order = RowOrder::effect);

/// Global indices with their intervals, by one estimator. Refers to the result.
struct GlobalIndices {
  const SensitivityResult::Indices& value;  ///< SI
  const SensitivityResult::Indices& low;    ///< lower end of the interval
  const SensitivityResult::Indices& high;   ///< upper end
};

/// The indices that are shown and that rank: the corrected ones.
GlobalIndices shown_indices(const StoredResult& result);

/// The distance of the farther end of an interval from its index, over the index.
double relative_reach(const GlobalIndices& indices, std::size_t response, std::size_t factor);

/// The magnitude below which a global or local index of the response and the error is rounding.
double index_rounding(const StoredResult& result, std::size_t response, std::size_t factor);

/// An index, global or local, or an end of its interval, SI, with rounding removed: 0 if the error has no effect, NaN
/// if it is too small to tell.
double without_rounding(const StoredResult& result, double index, std::size_t response, std::size_t factor);

/// Whether the index shown is more than rounding.
bool has_effect(const StoredResult& result, std::size_t response, std::size_t factor);

/// Positions of the responses on which no error has an effect; at least one of its indices must be known.
std::vector<std::size_t> responses_without_effect(const StoredResult& result);

/// index x sigma(error), SI. Indices alone cannot be compared, because some are per m and some per rad.
double effect(const StoredResult& result, std::size_t response, std::size_t factor);

/// A column of global indices per unit of the error, or of ends of their intervals. values: SI. Refers to the result
/// and the values.
FilledColumn index_column(const StoredResult& result, const SensitivityResult::Indices& values, std::size_t response,
                          std::string name, std::string heading, int dispensable = 0);

/// The rank of each error; none if the response does not vary. Refers to both arguments.
FilledColumn rank_column(const StoredResult& result, const RankedErrors& ranked, int dispensable);

/// Tables with the errors in the chosen order:
/// - ranked: the errors with the effect on the response that ranks (global index x sigma), its index and interval,
///   those of the headline's other responses, the share of samples not converged, and the published index where that
///   is not the one shown, in mm and deg;
/// - separation and fidelity, if the result has them.
std::vector<Table> sensitivity_tables(const StoredResult& result, const TableOptions& options);

/// Share of an error's samples that were not solved.
double share_not_converged(const SensitivityResult& result, std::size_t factor);

/// Compares the rankings of two results for the errors that both have. Errors without effect share the last rank; those
/// whose effect cannot be distinguished from rounding have no rank and do not count for the tau. Throws InputError if
/// the results are of two kinds, or have no error in common. Precondition: sensitivity results.
TwoRankings two_rankings(const RankedResult& a, const RankedResult& b, RowOrder order = RowOrder::effect);

}  // namespace poesy
