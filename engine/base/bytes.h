#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace poesy {

/// Bytes of one state, message or file.
using Bytes = std::vector<std::byte>;

/// Bytes are not what they should be. what() is a clause without a place.
class BytesError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes values one behind the other, the same bytes on every machine.
///
///     number    LEB128: seven bits a byte, the lowest first, the highest bit set in all bytes but the last
///     real      64 bits (IEEE 754), little-endian; every bit is kept
///     block     number of bytes, the bytes
///     text      as a block, UTF-8
class ByteWriter {
 public:
  /// Makes room for so many bytes in all, so that a long state is not copied while it grows.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  /// LEB128.
  void number(std::uint64_t value);
  /// Every bit is kept.
  void real(double value) { reals(std::span(&value, 1)); }
  /// Without their number.
  void reals(std::span<const double> values);
  /// Their number, then the bytes.
  void block(std::span<const std::byte> bytes);
  /// As a block.
  void text(std::string_view value) { block(std::as_bytes(std::span(value))); }
  /// The bytes as they are, without their number.
  void raw(std::span<const std::byte> bytes);

  /// What was written; leaves nothing.
  Bytes take() { return std::exchange(bytes_, {}); }

 private:
  Bytes bytes_;
};

/// Reads what ByteWriter wrote. The bytes may come from anywhere: every member throws BytesError for what cannot have
/// been written, and no memory is asked for that the bytes left could not fill.
class ByteReader {
 public:
  /// Refers to the bytes.
  explicit ByteReader(std::span<const std::byte> bytes) : left_(bytes) {}

  /// LEB128.
  std::uint64_t number();
  /// The same; also throws when it is above `most`.
  std::uint64_t number_up_to(std::uint64_t most);
  /// The number of things that follow, of at least so many bytes each. Precondition: least_bytes > 0.
  std::size_t count(std::size_t least_bytes);
  /// One double.
  double real();
  /// Fills `values`.
  void reals(std::span<double> values);
  /// So many doubles, whose number the reader knows.
  std::vector<double> reals(std::size_t count);
  /// Refers to the bytes that are read.
  std::span<const std::byte> block();
  /// A block as text.
  std::string text();
  /// So many bytes as they stand; refers to the bytes that are read.
  std::span<const std::byte> raw(std::size_t count);

  /// Bytes that were not read yet.
  std::size_t left() const { return left_.size(); }
  /// Throws when something is left.
  void expect_end() const;

 private:
  std::span<const std::byte> left_;
};

}  // namespace poesy
