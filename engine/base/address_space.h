#pragma once

#include <cstddef>
#include <cstdint>

namespace poesy {

std::uintmax_t address_space();       ///< Bytes of address space that this process uses; 0 if not known.
std::uintmax_t most_address_space();  ///< Limit on the address space in bytes (RLIMIT_AS), or RLIM_INFINITY.

/// Returns true if this process can now reserve `bytes` more bytes of address space. Call this function before a
/// library function that crashes when memory runs out.
bool has_address_space(std::size_t bytes);

/// If the address space of this process is limited, makes all threads allocate from one arena. By default glibc
/// reserves 64 MiB of address space for an arena of each thread, so that later threads may find no room for their
/// stacks. Call this function before any thread is started.
void save_address_space();

/// Makes glibc return freed blocks of 4 MiB or more to the system. By default glibc raises this threshold, up to 32
/// MiB, to the size of the largest block freed so far, and keeps smaller freed blocks.
void return_large_lists();

}  // namespace poesy
