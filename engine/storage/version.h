#pragma once

#include <span>
#include <string>
#include <string_view>

namespace poesy {

std::string poesy_version();  ///< The version of the program, such as "0.2.0".

std::string poesy_year();  ///< The year in which this version was released, from CITATION.cff: "2026".

/// The commit from which this program was built, as 40 hexadecimal digits, followed by "-dirty" if files differed from
/// the commit; "unknown" if the program was not built in a git checkout.
std::string git_commit();

/// A library that results depend on.
struct LibraryVersion {
  std::string_view name;     ///< name, such as "tbb"
  std::string_view version;  ///< version, as the library states it
};

/// The compiler and the libraries with which this program was built.
std::span<const LibraryVersion> build_versions();

}  // namespace poesy
