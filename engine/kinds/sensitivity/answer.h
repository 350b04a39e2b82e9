#pragma once

#include <string>

#include "engine/report/html/page.h"
#include "engine/result/result_file.h"

namespace poesy {

/// The errors that make most of the mean square, and those that together make next to none, in two sentences; empty
/// where not all of their effects are known, or none has one.
std::string few_matter_text(const StoredResult& result);

/// Where the most important error has its largest effect; empty where poses hardly differ.
std::string worst_place_text(const StoredResult& result);

/// What the report of a sensitivity result says first.
Answer sensitivity_answer(const StoredResult& result);

}  // namespace poesy
