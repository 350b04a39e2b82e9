#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/kinds/sensitivity/result.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"
#include "engine/stats/indices.h"

namespace poesy::sensitivity {

/// The errors of a sensitivity result, ordered for one response. Errors with equal values keep the order of the study,
/// and errors with an unknown value come last.
struct RankedErrors {
  std::size_t response;            ///< position of the response
  std::vector<std::size_t> rows;   ///< positions of the errors in the chosen order
  std::vector<std::size_t> ranks;  ///< [errors] rank of each error by its effect, from 1
};

/// Orders the errors of a result for a response. Precondition: the result has the response.
RankedErrors ranked_errors(const StoredResult& result, std::string_view response, RowOrder order = RowOrder::effect);

/// Global indices by one estimator, with their intervals. Keeps a reference to the result.
struct GlobalIndices {
  const Result::Indices& value;  ///< indices, SI
  const Result::Indices& low;    ///< lower ends of the intervals
  const Result::Indices& high;   ///< upper ends of the intervals
};

/// The indices that are shown and by which errors are ranked: the corrected ones.
GlobalIndices shown_indices(const StoredResult& result);

/// The distance of the farther end of an index's interval from the index, divided by the index.
double relative_reach(const GlobalIndices& indices, std::size_t response, std::size_t factor);

// These functions take only numbers; functions below with the same names would hide them.
using poesy::has_effect;
using poesy::index_rounding;

/// The magnitude below which a global or local index of this response and error is rounding.
double index_rounding(const StoredResult& result, std::size_t response, std::size_t factor);

/// An index, or an end of its interval, SI, with rounding removed: 0 if the error has no effect, NaN if the error is
/// too small to decide whether it has one.
double without_rounding(const StoredResult& result, double index, std::size_t response, std::size_t factor);

/// Whether the index that is shown is larger than rounding.
bool has_effect(const StoredResult& result, std::size_t response, std::size_t factor);

/// Positions of the responses on which no error has an effect. A response is listed only if some index on it is known.
std::vector<std::size_t> responses_without_effect(const StoredResult& result);

/// The effect of an error: its global index times its standard deviation, SI. Indices themselves cannot be compared,
/// because some are per m and some per rad.
double effect(const StoredResult& result, std::size_t response, std::size_t factor);

/// A column with global indices, or with ends of their intervals, in display units: response per unit of the error.
/// values: the numbers of the column, SI. Keeps references to the result and the values.
FilledColumn index_column(const StoredResult& result, const Result::Indices& values, std::size_t response,
                          std::string name, std::string heading, int dispensable = 0);

/// A column with the rank of each error; empty if the response does not vary. Keeps references to both arguments.
FilledColumn rank_column(const StoredResult& result, const RankedErrors& ranked, int dispensable);

/// Tables with the errors in the chosen order:
/// - ranked: for each error, its effect on the response by which errors are ranked (global index x sigma), the index
///   and its interval, the sigma of the error, the indices for the other responses that a summary shows, the change of
///   the index at a tenth of the size, the share of samples that did not converge, and the published index; in mm and
///   deg;
/// - separation and fidelity, if the result has them.
std::vector<Table> sensitivity_tables(const StoredResult& result, const TableOptions& options);

/// The share of the samples of an error, at all poses, that were not solved.
double share_not_converged(const Result& result, std::size_t factor);

/// Compares the rankings of two results for the errors that both have. Errors without an effect share the last rank.
/// Errors whose effect cannot be distinguished from rounding have no rank and are left out of Kendall's tau. Throws
/// InputError if the results are of two kinds, or have no error in common. Precondition: both are sensitivity results.
TwoRankings two_rankings(const RankedResult& a, const RankedResult& b, RowOrder order = RowOrder::effect);

}  // namespace poesy::sensitivity
