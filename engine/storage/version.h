#pragma once

#include <span>
#include <string>
#include <string_view>

namespace poesy {

std::string poesy_version();  ///< "0.2.0"

/// The commit this program was built from, 40 hexadecimal digits, with "-dirty" behind it when files
/// differed from that commit; "unknown" when it was not built in a git checkout.
std::string git_commit();

/// A library that results depend on.
struct LibraryVersion {
  std::string_view name;     ///< "tbb"
  std::string_view version;  ///< as it names itself
};

std::span<const LibraryVersion> build_versions();  ///< The compiler and the libraries this program was built with.

}  // namespace poesy
