#pragma once

namespace poesy::fuzz {

/// The file that changed results name in every way that HDF5 knows (mutate_result.cpp), and that no reader may read
/// (fuzz_result.cpp).
inline constexpr const char* kOtherFile = "/dev/shm/poesy-fuzz-other";

}  // namespace poesy::fuzz
