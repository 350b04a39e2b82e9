#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/report/table.h"
#include "engine/result/result_file.h"

namespace poesy {

/// The table of the drawing's features, ordered by their effect on a response, with their shares in the response's
/// worst case. response: index of the response. None if the result has no features, or if their effects on the response
/// are not known: if the response is neither signed nor the norm of signed responses, or if a pose was not solved.
std::optional<Table> drawing_table(const StoredResult& result, std::size_t response);

/// Returns true if errors of a feature are drawn together, because the study's errors.zones has a distribution other
/// than normal. Such errors have no first-order index of their own.
bool has_zone_shape(const StoredResult& result);

/// For each error, the name of the feature to which it belongs, or its own name if it belongs to none.
std::vector<std::string> feature_of_each_error(const StoredResult& result);

}  // namespace poesy
