#pragma once

#include <string>
#include <vector>

/// Names that differ only in the number of a limb.
namespace poesy {

/// Gives names that differ only in the number of a limb one name: "seat_*" for "seat_1" and "seat_2".
void join_limbs(std::vector<std::string>& names);

}  // namespace poesy
