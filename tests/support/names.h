// Names of a test's parameters, where these cannot name themselves.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

namespace poesy::test {

/// For INSTANTIATE_TEST_SUITE_P: the names of its values, in their order. Throws std::out_of_range where one has none.
inline auto named(std::vector<std::string> names) {
  return [names](const auto& made) { return names.at(made.index); };
}

}  // namespace poesy::test
