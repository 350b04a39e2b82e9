#pragma once

#include <span>
#include <vector>

#include "engine/base/bytes.h"

namespace poesy::test {

/// The bytes that each source writes.
inline std::vector<Bytes> bytes_of_each(std::span<const ByteSource> sources) {
  std::vector<Bytes> all;
  for (const ByteSource& source : sources) all.push_back(bytes_of(source));
  return all;
}

/// Sources that write these states. The sources refer to the states, which must outlive them.
inline std::vector<ByteSource> sources_of(std::span<const Bytes> states) {
  std::vector<ByteSource> all;
  for (const Bytes& state : states) all.emplace_back([&state](ByteWriter& to) { to.raw(state); });
  return all;
}

}  // namespace poesy::test
