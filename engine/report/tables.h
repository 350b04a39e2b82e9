#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/io/result_file.h"
#include "engine/model/catalog.h"
#include "engine/report/ranking.h"
#include "engine/report/table.h"

namespace poesy {

/// How the solves of a result of any kind ended.
SolveCounts solves_of(const StoredResult& result);

/// What was run and how long it took, a few lines, broken at `width` as by prose_of.
std::string summary_text(const StoredResult& result, std::size_t width);

/// How many solves did not converge, at both fidelities where there are two; of a sampled result also the first one's
/// address, and how to replay it. path: of the result. Broken at `width` as by prose_of, but for the command to replay
/// it.
std::string failures_text(const StoredResult& result, const std::string& path, std::size_t width);

/// The response a result is ranked by unless asked otherwise: the first length of the headline, else its first.
std::string default_ranking(const StoredResult& result);

/// The errors of a sensitivity result in their order, with the effect on the response that ranks (global index x
/// sigma), its index and interval, those of the headline's other responses, the share of samples not converged, and the
/// published index where that is not the one shown, in mm and deg.
Table ranked_table(const StoredResult& result, const RankedErrors& ranked);

/// What calibration can remove of each error's effect; none where the result does not say.
std::optional<Table> separation_table(const StoredResult& result, const RankedErrors& ranked);

/// Per error the largest discrepancy of two fidelities and the verdict; none where the study compares none.
std::optional<Table> fidelity_table(const StoredResult& result, const RankedErrors& ranked);

/// How many quantities reached the interval that the study asks for, with how many samples, and which did not; none
/// for a fixed number of samples.
std::optional<Table> convergence_table(const StoredResult& result);

/// Per response of an `evaluate` result, the mean and the extremes over all solved samples. Where the rows of errors
/// have labels, notes name the worst.
Table evaluation_table(const StoredResult& result);

/// Per labelled row of errors of an `evaluate` result, mean and extreme of each response over the poses; none where
/// rows have no labels.
std::optional<Table> parts_table(const StoredResult& result);

/// Per case of an `evaluate` study, mean and maximum of each response over the poses that count.
Table cases_table(const StoredResult& result);

/// The errors that deform, limb by limb as far as their order goes, with the counts of poses behind the verdicts; then
/// the couplings, where there are any.
std::vector<Table> identification_tables(const StoredResult& result);

/// Per response of a Monte Carlo result, mean, spread, extremes and quantiles over the samples of all poses together;
/// then the mean of the poses' means, and the largest mean and highest quantile with the pose where it is.
std::vector<Table> monte_carlo_tables(const StoredResult& result);

/// What became of the study's limits; none where it states none.
const std::optional<LimitVerdicts>& verdicts_of(const StoredResult& result);

/// PASS or FAIL for each limit, with the value that was found and the limit; none where the study states none.
std::optional<Table> limits_table(const StoredResult& result);

/// The tables that suit the result's kind. ranked_by is a response of the result; the errors of a sensitivity result
/// stand in this order.
std::vector<Table> result_tables(const StoredResult& result, std::string_view ranked_by,
                                 RowOrder order = RowOrder::effect);

/// Leaves the first rows of the tables that are ranked; where that takes some away, a note says how many there are.
void keep_first(std::size_t most, std::span<Table> tables);

/// All mechanisms, a line each.
std::string models_text(const Catalog& catalog);

/// One mechanism: geometry, pose coordinates, workspace, factors, factor sets, responses, details.
std::string model_text(const CatalogEntry& entry);

}  // namespace poesy
