#pragma once

#include <cstddef>
#include <optional>

#include "engine/report/table.h"
#include "engine/result/result_file.h"

namespace poesy {

/// The features of the drawing by their effect on a response, with the worst case; none if there are none, or if the
/// response is neither signed nor the norm of signed ones.
std::optional<Table> drawing_table(const StoredResult& result, std::size_t response);

}  // namespace poesy
