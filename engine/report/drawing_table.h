#pragma once

#include <cstddef>
#include <optional>

#include "engine/report/table.h"
#include "engine/result/result_file.h"

namespace poesy {

/// The table of the drawing's features, ordered by their effect on a response, with their shares in the response's
/// worst case. None if the result has no features, or if the response is neither signed nor the norm of signed
/// responses.
std::optional<Table> drawing_table(const StoredResult& result, std::size_t response);

}  // namespace poesy
