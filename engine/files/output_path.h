#pragma once

#include <span>
#include <string>
#include <string_view>

namespace poesy {

/// A kind of file that the program writes.
struct OutputKind {
  std::string_view name;                             ///< "result"
  bool (*may_be_replaced)(const std::string& path);  ///< whether a file that stands there is of this kind, or empty
};

/// Whether a file is empty, or has this mark in its first kilobyte.
bool is_marked(const std::string& path, std::string_view mark);

/// Throws when no such file can come into being at this path, before anything is computed: InputError when its folder
/// does not exist, when what stands there is one of the inputs or must not be replaced, FileError when the folder
/// cannot be written.
void check_output_path(const std::string& path, const OutputKind& kind, std::span<const std::string> inputs);

}  // namespace poesy
