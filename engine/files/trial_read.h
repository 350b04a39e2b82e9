#pragma once

#include <functional>
#include <string>

namespace poesy {

/// What to do about a damaged file.
inline constexpr const char* kDamagedRemedy = "take another copy, or run the study again";

inline constexpr unsigned long kTrialSeconds = 5;         ///< processor time that a child may take to read a file
inline constexpr unsigned long kTrialBytes = 1UL << 28U;  ///< memory that it may take besides what the program has

/// Calls read() in a child process, so that nothing that comes of it reaches this one; returns if it ended well there.
///
/// HDF5 1.10 may crash, loop or ask for all memory over a damaged file before it reports an error, or spoil its own
/// heap and crash later. The child is a copy of this process at this moment, so what ended well there ends well here.
/// It may take kTrialSeconds of processor time and one more for each MiB of the file, and kTrialBytes of memory and 16
/// more for each byte of the file (where /proc tells how much it has already); it says nothing to the terminal.
///
/// Throws FileError as read() did, FileError when the child did not come to an end of read(), or when there can be no
/// child. Precondition: no other thread holds a lock that read() takes (the allocator's own may be held).
void trial_read(const std::string& path, const std::function<void()>& read);

}  // namespace poesy
