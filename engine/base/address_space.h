#pragma once

#include <cstddef>
#include <cstdint>

namespace poesy {

std::uintmax_t address_space();       ///< Bytes of it that this process has; 0 where the system does not tell.
std::uintmax_t most_address_space();  ///< Bytes that it may have: RLIMIT_AS.

/// Whether this process may take so many more bytes now. Some libraries crash without memory: ask before they are
/// called.
bool has_address_space(std::size_t bytes);

/// Where address space is limited, threads do not reserve 64 MiB each for what they allocate, as glibc has it: others
/// would not find room for their stacks. To be called before any thread is started.
void save_address_space();

/// A list of 4 MiB or more returns its memory to the system when it goes. By itself glibc raises that
/// bound, up to 32 MiB, to the size of the first list that goes, so that a run would have later ones beside its result.
void return_large_lists();

}  // namespace poesy
