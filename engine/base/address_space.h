#pragma once

#include <cstddef>
#include <cstdint>

namespace poesy {

std::uintmax_t address_space();       ///< Bytes of address space that this process uses; 0 if the system does not tell.
std::uintmax_t most_address_space();  ///< Bytes of address space that it may use: RLIMIT_AS.

/// Whether this process may use this many more bytes now. Some libraries crash without memory, so check before calling
/// them.
bool has_address_space(std::size_t bytes);

/// Reduces the address space of threads if it is limited. By default glibc reserves 64 MiB for the allocations of each
/// thread, and further threads find no room for their stacks. Call it before any thread is started.
void save_address_space();

/// Returns the memory of lists of 4 MiB or more to the system when they are freed. By default glibc raises this bound
/// to the size of the first list that is freed, up to 32 MiB, and keeps later lists in memory beside the result.
void return_large_lists();

}  // namespace poesy
