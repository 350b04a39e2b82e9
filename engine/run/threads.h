#pragma once

#include <cstddef>

namespace poesy {

/// Of the stack of a thread that works on a study.
inline constexpr std::size_t kThreadStackBytes = std::size_t{4} << 20U;

/// Starts the threads of oneTBB, unless they were; throws FileError where this process cannot have so many at once.
/// oneTBB ends the whole program when it cannot start one.
void expect_threads(std::size_t threads);

}  // namespace poesy
