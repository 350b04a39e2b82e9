#pragma once

#include <string>

#include "engine/report/html/page.h"
#include "engine/result/result_file.h"

namespace poesy {

/// The errors that make most of the mean square, and those that together make hardly any of it, in two sentences. Empty
/// if not all effects are known, or no error has one.
std::string few_matter_text(const StoredResult& result);

/// The pose where the most important error has its largest effect; empty if poses hardly differ.
std::string worst_place_text(const StoredResult& result);

/// The first lines of the report of a sensitivity result.
Answer sensitivity_answer(const StoredResult& result);

}  // namespace poesy
