#include "tests/fuzz/h5_checksums.h"

#include <algorithm>
#include <array>
#include <span>

// HDF5's checksum (Jenkins' lookup3). The library has it, but no public header declares it.
extern "C" std::uint32_t H5_checksum_metadata(const void* data, std::size_t length, std::uint32_t start);

namespace poesy::fuzz {
namespace {

using Bytes = std::span<std::uint8_t>;

constexpr std::size_t kSignature = 4;
constexpr std::size_t kChecksum = 4;

/// The little-endian number of `width` bytes at `at`. Precondition: it is inside `bytes`.
std::uint64_t number(Bytes bytes, std::size_t at, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t k = width; k-- > 0;) value = value << 8U | bytes[at + k];
  return value;
}

/// Writes the checksum of the first `length` bytes of a block after these bytes.
void seal(Bytes block, std::size_t length) {
  const std::uint32_t sum = H5_checksum_metadata(block.data(), length, 0);
  for (std::size_t k = 0; k < kChecksum; ++k) block[length + k] = static_cast<std::uint8_t>(sum >> (8U * k));
}

/// Writes the checksums of the continuation blocks to which the messages of a header point.
void seal_continuations(Bytes file, Bytes messages, bool ordered) {
  constexpr std::uint8_t kContinuation = 0x10;
  const std::size_t prefix = ordered ? 6 : 4;
  while (messages.size() >= prefix) {
    const std::size_t length = number(messages, 1, 2);
    if (length > messages.size() - prefix) return;
    if (messages[0] == kContinuation && length == 16) {
      const std::uint64_t at = number(messages, prefix, 8);
      const std::uint64_t bytes = number(messages, prefix + 8, 8);
      if (bytes >= kSignature + kChecksum && at <= file.size() && bytes <= file.size() - at) {
        seal(file.subspan(at, bytes), bytes - kChecksum);
      }
    }
    messages = messages.subspan(prefix + length);
  }
}

/// Writes the checksums of the object header that begins at byte `at` of the file.
void seal_header(Bytes file, std::size_t at) {
  const Bytes header = file.subspan(at);
  constexpr std::size_t kFixed = kSignature + 2;
  if (header.size() < kFixed + 16 + 4 + 8) return;
  const std::uint8_t flags = header[5];
  const std::size_t before = kFixed + ((flags & 0x20U) != 0 ? 16 : 0) + ((flags & 0x10U) != 0 ? 4 : 0);
  const std::size_t width = std::size_t{1} << (flags & 3U);
  const std::uint64_t length = number(header, before, width);
  const std::size_t start = before + width;
  if (length > header.size() - start || header.size() - start - length < kChecksum) return;
  seal(header, start + length);
  seal_continuations(file, header.subspan(start, length), (flags & 4U) != 0);
}

}  // namespace

void repair_checksums(std::vector<std::uint8_t>& file) {
  constexpr std::array<std::uint8_t, 5> kStart{'O', 'H', 'D', 'R', 2};
  for (auto rest = file.begin();;) {
    const auto start = std::search(rest, file.end(), kStart.begin(), kStart.end());
    if (start == file.end()) return;
    seal_header(file, static_cast<std::size_t>(start - file.begin()));
    rest = start + kSignature;
  }
}

}  // namespace poesy::fuzz
