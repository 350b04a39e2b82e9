#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/files/result_file.h"
#include "engine/model/catalog.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/report/solves.h"
#include "engine/report/table.h"

namespace poesy {

/// What was run and how long it took, a few lines, broken at `width` as by prose_of.
std::string summary_text(const StoredResult& result, std::size_t width);

/// The response a result is ranked by unless asked otherwise: the first length of the headline, else its first.
std::string default_ranking(const StoredResult& result);

/// How tables show a result.
struct TableOptions {
  std::string ranked_by = {};         ///< a response of the result; the errors of a sensitivity result go by it
  RowOrder order = RowOrder::effect;  ///< of the errors of a sensitivity result
};

/// The tables that suit the result's kind.
std::vector<Table> result_tables(const StoredResult& result, std::string_view ranked_by,
                                 RowOrder order = RowOrder::effect);

/// Leaves the first rows of the tables that are ranked; where that takes some away, a note says how many there are.
void keep_first(std::size_t most, std::span<Table> tables);

/// How many quantities reached the interval that the study asks for, with how many samples, and which did not; none
/// for a fixed number of samples.
std::optional<Table> convergence_table(const StoredResult& result);

/// How many quantities did not reach it, in a sentence; empty where all did, and for a fixed number of samples.
std::string not_settled_text(const StoredResult& result);

/// What became of the study's limits; none where it states none.
const std::optional<LimitVerdicts>& verdicts_of(const StoredResult& result);

/// The verdict on a response; null where the study does not limit it.
const LimitVerdict* verdict_on(const StoredResult& result, std::size_t response);

/// PASS or FAIL for each limit, with the value that was found and the limit; none where the study states none.
std::optional<Table> limits_table(const StoredResult& result);

/// Of a sensitivity result, with the errors in the order asked for:
/// - ranked: the errors with the effect on the response that ranks (global index x sigma), its index and interval,
///   those of the headline's other responses, the share of samples not converged, and the published index where that
///   is not the one shown, in mm and deg;
/// - separation: what calibration can remove of each error's effect, where the result says it;
/// - fidelity: the largest discrepancy of two fidelities and the verdict, where the study compares two;
/// - convergence.
std::vector<Table> sensitivity_tables(const StoredResult& result, const TableOptions& options);

/// Of a Monte Carlo result: its limits; per response mean, spread, extremes and quantiles over the samples of all poses
/// together; then the mean of the poses' means, and the largest mean and highest quantile with the pose where it is;
/// convergence.
std::vector<Table> monte_carlo_tables(const StoredResult& result, const TableOptions& options = {});

/// Of an identification: the errors that deform, limb by limb as far as their order goes, with the counts of poses
/// behind the verdicts; then the couplings, where there are any.
std::vector<Table> identification_tables(const StoredResult& result, const TableOptions& options = {});

/// Of a coupling result, for each size and each response that a summary shows: a table with a row for each subset of
/// the sources. Columns: the largest |effect| over the poses and the pose where it is, by number and coordinates, the
/// largest root sum square, worst case and |interaction|, and where sources oppose each other: at which share of the
/// poses, and the pose where they cancel most, with the cancellation there. What the words mean is below the last
/// one.
std::vector<Table> coupling_tables(const StoredResult& result, const TableOptions& options = {});

/// Per response of an `evaluate` result, the mean and the extremes over all solved samples. Where the rows of errors
/// have labels, notes name the worst.
Table evaluation_table(const StoredResult& result);

/// Of an `evaluate` result: its limits; evaluation_table, or per case mean and maximum of each response over the poses
/// that count; per labelled row of errors, mean and extreme of each response over the poses.
std::vector<Table> evaluation_tables(const StoredResult& result, const TableOptions& options = {});

/// All mechanisms, a line each.
std::string models_text(const Catalog& catalog);

/// One mechanism: geometry, pose coordinates, workspace, factors, factor sets, responses, details.
std::string model_text(const CatalogEntry& entry);

}  // namespace poesy
