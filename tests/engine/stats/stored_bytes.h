#pragma once

#include <gtest/gtest.h>

#include "engine/base/archive.h"

namespace poesy::test {

template <class Stats>
Bytes written(const Stats& stats) {
  ByteWriter to;
  write_state(stats, to);
  return to.take();
}

/// The object that read(ByteReader&) reads from the bytes. Expects that it reads all of them.
template <class Read>
auto read_all(const Bytes& bytes, const Read& read) {
  ByteReader from(bytes);
  auto stats = read(from);
  from.expect_end();
  return stats;
}

/// Expects that bytes which end too early are refused, and that bytes with one changed byte are refused or read without
/// harm.
template <class Read>
void expect_no_harm(const Bytes& sound, const Read& read) {
  for (std::size_t length = 0; length < sound.size(); length += 1 + sound.size() / 200) {
    const Bytes cut(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_THROW(read_all(cut, read), BytesError) << length;
  }
  for (std::size_t at = 0; at < sound.size(); at += 1 + sound.size() / 200) {
    for (const auto flip : {std::byte{1}, std::byte{0x80}, std::byte{0xff}}) {
      Bytes changed = sound;
      changed[at] ^= flip;
      try {
        read_all(changed, read);
      } catch (const BytesError&) {
        continue;
      }
    }
  }
}

}  // namespace poesy::test
