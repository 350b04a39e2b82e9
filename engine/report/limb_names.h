#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Names that differ only in the number of a limb.
namespace poesy {

/// The name of an error without the number of its limb: "rod_left" for "rod_left_3". Names of the same error in
/// different limbs (copies) differ only in this number. A name that does not end with a number is returned as a whole.
std::string_view stem_of(std::string_view name);

/// Replaces names that differ only in the number of a limb by a common name: "seat_*" for "seat_1" and "seat_2".
void join_limbs(std::vector<std::string>& names);

}  // namespace poesy
