#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace poesy::fuzz {

/// Makes every checksum right that HDF5 would ask for in an object's header ("OHDR" and "OCHK" blocks, HDF5 File Format
/// Specification, IV.A.1.b), as far as the headers' own lengths lie inside the file. Else a changed header is refused
/// for its checksum and nothing behind that is tried.
void repair_checksums(std::vector<std::uint8_t>& file);

}  // namespace poesy::fuzz
