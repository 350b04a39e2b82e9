#pragma once

#include <cstddef>
#include <cstdint>

namespace poesy {

std::uintmax_t address_space();       ///< Bytes of address space that this process uses; 0 if not known.
std::uintmax_t most_address_space();  ///< Bytes of address space that this process may use (RLIMIT_AS).

/// Returns true if this process may use this number of additional bytes now. Check it before calling a library that
/// crashes without memory.
bool has_address_space(std::size_t bytes);

/// If the address space of this process is limited, reduces what each thread reserves. By default glibc reserves 64 MiB
/// for the allocations of a thread, and later threads find no room for their stacks. Call it before any thread is
/// started.
void save_address_space();

/// Makes glibc return freed blocks of 4 MiB or more to the system. By default glibc raises this threshold, up to 32
/// MiB, to the size of the largest block freed so far, and then keeps smaller ones in memory.
void return_large_lists();

}  // namespace poesy
