#pragma once

#include <cstddef>
#include <string>

#include "engine/result/result_file.h"

/// What the report of a Monte Carlo study advises to do next.
namespace poesy::monte_carlo {

/// Advice on what the study needs (limits, a wanted yield, more machines) and on which errors to make smaller. It names
/// features, errors that belong to no feature, correlated errors together, and the mean of a response over the
/// machines. r: position of the response whose errors are named if no limited response has known shares of errors in
/// its scatter. predicted: sentence on the yields that are predicted for single changes, which replaces the shares in
/// the scatter; may be empty.
std::string advice(const StoredResult& result, std::size_t r, const std::string& predicted = {});

}  // namespace poesy::monte_carlo
