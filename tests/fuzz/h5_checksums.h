#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace poesy::fuzz {

/// Corrects the checksums of all object headers ("OHDR" and "OCHK" blocks, HDF5 File Format Specification, IV.A.1.b)
/// whose lengths are inside the file. Otherwise HDF5 would refuse a changed header because of its checksum, and nothing
/// more would be tested.
void repair_checksums(std::vector<std::uint8_t>& file);

}  // namespace poesy::fuzz
