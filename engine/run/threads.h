#pragma once

#include <cstddef>

namespace poesy {

/// The size of the stack of a thread that works on a study, in bytes.
inline constexpr std::size_t kThreadStackBytes = std::size_t{4} << 20U;

/// Throws FileError unless this process can have `threads` threads at once, with 256 KiB of memory for each in addition
/// to its stack, and 2 MiB more.
void expect_threads(std::size_t threads);

}  // namespace poesy
