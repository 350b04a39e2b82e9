#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "engine/io/result_file.h"

/// What two results have in common, A the first and B the second.
namespace poesy {

/// Positions in both of what A and B have in common, in the order of A.
using Common = std::vector<std::pair<std::size_t, std::size_t>>;

/// Names that both have.
Common common(const std::vector<std::string>& a, const std::vector<std::string>& b);

/// The names that `these` has and `others` has not.
std::vector<std::string> only_in(const std::vector<std::string>& these, const std::vector<std::string>& others);

/// Throws InputError, at the path of B, where the results are of two kinds or mechanisms.
void check_comparable(const StoredResult& a, const std::string& path_a, const StoredResult& b,
                      const std::string& path_b);

}  // namespace poesy
