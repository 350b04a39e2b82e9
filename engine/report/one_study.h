#pragma once

#include <string>

#include "engine/result/result_file.h"

namespace poesy {

/// A sentence that recommends a sweep. It applies to two results of the same mechanism that both have a yield, if their
/// studies differ only in the values of keys that both state: a sweep judges the same machines in both designs, so the
/// interval of the difference is narrower. Empty for other results. letter: the letter of result b.
std::string sweep_text(const StoredResult& a, const StoredResult& b, char letter);

}  // namespace poesy
