#pragma once

#include <cstdint>

#include "engine/io/result_file.h"

namespace poesy {

/// max_not_converged of the study behind a result; 1 where its text does not say.
double max_not_converged(const StoredResult& result);

/// Whether so many solves of a result did not converge that a reader is warned (failure_share.h).
bool many_not_converged(const StoredResult& result, std::uint64_t failed, std::uint64_t solves);

}  // namespace poesy
