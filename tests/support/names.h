// Names for test parameters that have no name themselves.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

namespace poesy::test {

/// A name function for INSTANTIATE_TEST_SUITE_P. names: of the values, in their order. The function throws
/// std::out_of_range for a value without a name.
inline auto named(std::vector<std::string> names) {
  return [names](const auto& made) { return names.at(made.index); };
}

}  // namespace poesy::test
