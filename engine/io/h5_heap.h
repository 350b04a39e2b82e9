#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace poesy::h5 {

/// Why the text of an HDF5 file cannot be read safely; empty when it can.
///
/// HDF5 keeps text of variable length in "global heap collections" (HDF5 File Format Specification, III.E), which carry
/// no checksum, and HDF5 1.10 follows a damaged one out of bounds. This looks at every collection in the bytes of a
/// whole file: its objects must fill it exactly and their numbers must ascend, as HDF5 leaves them.
std::optional<std::string> damaged_heap(std::span<const std::byte> file);

}  // namespace poesy::h5
