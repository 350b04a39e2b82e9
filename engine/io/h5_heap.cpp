#include "engine/io/h5_heap.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace poesy::h5 {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::size_t kCollectionHeader = 16;  // signature, version, length
constexpr std::size_t kObjectHeader = 16;      // number, references, length

/// An unsigned number of `width` bytes, little-endian. Precondition: it lies inside.
std::uint64_t number(Bytes bytes, std::size_t at, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t k = width; k-- > 0;) value = value << 8U | std::to_integer<std::uint64_t>(bytes[at + k]);
  return value;
}

/// Whether the objects of a collection fill it exactly and ascend.
bool is_intact(Bytes collection) {
  constexpr std::uint64_t kPadding = 8;
  std::uint64_t last = 0;
  std::size_t at = kCollectionHeader;
  while (collection.size() - at >= kObjectHeader) {
    const std::uint64_t index = number(collection, at, 2);
    const std::uint64_t length = number(collection, at + 8, 8);
    const std::size_t room = collection.size() - at;
    if (index == 0) return length == room;  // the free space behind the last object, header included
    if (index <= last || length > room - kObjectHeader) return false;
    last = index;
    const std::uint64_t padded = (length + kPadding - 1) / kPadding * kPadding;
    if (padded > room - kObjectHeader) return false;
    at += kObjectHeader + padded;
  }
  return true;
}

}  // namespace

std::optional<std::string> damaged_heap(Bytes file) {
  constexpr std::array<std::byte, 8> kStart{std::byte{'G'}, std::byte{'C'}, std::byte{'O'}, std::byte{'L'},
                                            std::byte{1},   std::byte{0},   std::byte{0},   std::byte{0}};
  for (auto rest = file.begin();;) {
    const auto start = std::search(rest, file.end(), kStart.begin(), kStart.end());
    if (start == file.end()) return std::nullopt;
    const Bytes tail = file.subspan(static_cast<std::size_t>(start - file.begin()));
    const std::uint64_t length = tail.size() < kCollectionHeader ? 0 : number(tail, kStart.size(), 8);
    if (length < kCollectionHeader || length > tail.size() || !is_intact(tail.first(length))) {
      return "the text heap at byte " + std::to_string(start - file.begin()) + " is inconsistent";
    }
    rest = start + static_cast<std::ptrdiff_t>(length);
  }
}

}  // namespace poesy::h5
