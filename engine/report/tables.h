#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/files/result_file.h"
#include "engine/model/catalog.h"
#include "engine/report/solves.h"
#include "engine/report/table.h"

namespace poesy {

/// What was run and how long it took, a few lines, broken at `width` as by prose_of. tally: of the result.
std::string summary_text(const StoredResult& result, const SolveTally& tally, std::size_t width);

/// The response a result is ranked by unless asked otherwise: the first length of the headline, else its first.
std::string default_ranking(const StoredResult& result);

/// In which order tables show ranked errors; the largest first.
enum class RowOrder {
  effect,        ///< index x sigma: what the error does at the size that the study gives it
  index,         ///< in the units shown
  name,          ///< a to z
  study,         ///< as the study has them
  not_converged  ///< share of the samples
};

/// What users call them, in the order of RowOrder.
inline constexpr std::array<std::string_view, 5> kRowOrders{"effect", "index", "name", "order", "not-converged"};

/// How tables show a result.
struct TableOptions {
  std::string ranked_by = {};         ///< a response of the result; its errors go by it where the kind ranks them
  RowOrder order = RowOrder::effect;  ///< of ranked errors
};

/// Leaves the first rows of the tables that are ranked; where that takes some away, a note says how many there are.
void keep_first(std::size_t most, std::span<Table> tables);

/// The quantities of a sampled result that settle with the number of samples.
struct Settling {
  std::string_view quantities;         ///< what they are: "global indices"
  std::vector<std::string> slots;      ///< [P] names of what has quantities: errors
  std::vector<std::size_t> responses;  ///< those that decide when a study with adaptive samples ends
};

/// How many quantities reached the interval that the study asks for, with how many samples, and which did not; none
/// for a fixed number of samples.
std::optional<Table> convergence_table(const StoredResult& result, const Settling& settling);

/// How many quantities did not reach it, in a sentence; empty where all did, and for a fixed number of samples.
std::string not_settled_text(const StoredResult& result, const Settling& settling);

/// The verdict on a response; null where the study does not limit it.
const LimitVerdict* verdict_on(const StoredResult& result, std::size_t response);

/// PASS or FAIL for each limit, with the value that was found and the limit; none where the study states none.
std::optional<Table> limits_table(const StoredResult& result);

/// All mechanisms, a line each.
std::string models_text(const Catalog& catalog);

/// One mechanism: geometry, pose coordinates, workspace, factors, factor sets, responses, details.
std::string model_text(const CatalogEntry& entry);

}  // namespace poesy
