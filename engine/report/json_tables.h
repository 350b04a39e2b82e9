#pragma once

#include <span>
#include <string>

#include "engine/files/result_file.h"
#include "engine/report/rankings.h"
#include "engine/report/table.h"

namespace poesy {

/// A result's summary and its tables as one JSON object, for programs:
///
/// - kind, model, title, poesy_version, git_commit, content_sha256
/// - metric: name, null where nothing is weighed; metric_points: [[x, y, z]] in m, null where it has none
/// - seed, where the study has one; poses
/// - errors, responses: [{name, unit (SI), description}], the description empty in files of older versions
/// - solves: total, not_converged, by_status: {converged, stagnated, ...}
/// - run: created, threads, wall_seconds
/// - tables: [{name, caption, columns: [{name, heading, unit, kind}], rows, shown, notes}]
///
/// A row of `rows` has the values by the names of the columns: numbers so that they read back as the same double, in
/// the column's unit, null where there is none; text as it is. `shown` has the texts of the same cells, as a list for
/// each row. Text that is not UTF-8 is made so. solves: all of the result.
std::string json_of(const StoredResult& result, const SolveCounts& solves, std::span<const Table> tables);

/// Two rankings beside each other as one JSON object:
///
///     results: [{path, response (that ranks), and of the result all that is above but its tables}, ...], A before B
///     kendall_tau (null where it is not known), remarks: [sentences]
///     tables: [the one table, as above]
std::string json_of(const RankedResult& a, const RankedResult& b, const TwoRankings& rankings);

}  // namespace poesy
