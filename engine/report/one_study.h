#pragma once

#include <string>

#include "engine/result/result_file.h"

namespace poesy {

/// A sentence that recommends a sweep instead of two runs: a sweep judges the same machines in both designs, so the
/// interval of the difference of the yields is narrower. Empty unless both results have a yield and the same mechanism,
/// and their studies differ only in values of keys that both studies state and that are not requirements
/// (required_by()). letter: the letter of result b.
std::string sweep_text(const StoredResult& a, const StoredResult& b, char letter);

}  // namespace poesy
