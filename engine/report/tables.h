#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/io/result_file.h"
#include "engine/model/catalog.h"

namespace poesy {

/// What was run, how long it took and how many solves did not converge, a few lines.
std::string summary_text(const StoredResult& result);

/// How many samples of a result failed, the first one's address, and how to replay it; empty where none is listed.
/// path: of the result.
std::string failures_text(const StoredResult& result, std::string_view path);

/// The factors of a sensitivity result, ranked by the spread that each gives one response at the size the study sets
/// (global index x sigma), with the indices and intervals of the headline's responses, in mm and deg.
/// ranked_by is a response of the result.
std::string ranked_table(const StoredResult& result, std::string_view ranked_by);

/// What calibration can remove of each error's effect, in the order of ranked_table; empty where the result does not
/// say.
std::string separation_table(const StoredResult& result, std::string_view ranked_by);

/// Per error the largest discrepancy of two fidelities and the verdict, in the order of ranked_table; empty where the
/// study compares none.
std::string fidelity_table(const StoredResult& result, std::string_view ranked_by);

/// How many quantities reached the interval that the study asks for, with how many samples, and which did not; empty
/// for a fixed number of samples.
std::string convergence_table(const StoredResult& result);

/// The response a result is ranked by unless asked otherwise: the first length of the headline, else its first.
std::string default_ranking(const StoredResult& result);

/// Per response of an `evaluate` result, the mean and the extremes over all solved samples, and where they are.
std::string evaluation_table(const StoredResult& result);

/// Per case of an `evaluate` study, mean and maximum of each response over the poses that count.
std::string cases_table(const StoredResult& result);

/// The errors that deform, limb by limb as far as their order goes, with the counts of poses behind the verdicts, and
/// the couplings.
std::string identification_table(const StoredResult& result);

/// Per response of a Monte Carlo result, mean, spread, extremes and quantiles over the samples of all poses together;
/// then the mean of the poses' means, and the largest mean and highest quantile with the pose where it is.
std::string monte_carlo_table(const StoredResult& result);

/// The tables that suit the result's kind. ranked_by is a response of the result.
std::string result_tables(const StoredResult& result, std::string_view ranked_by);

/// All mechanisms, a line each.
std::string models_text(const Catalog& catalog);

/// One mechanism: geometry, pose coordinates, workspace, factors, factor sets, responses, details.
std::string model_text(const ModelDescription& model);

}  // namespace poesy
