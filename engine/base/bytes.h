#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace poesy {

using Bytes = std::vector<std::byte>;  ///< Bytes of one state, message or file.

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
  /// Takes bytes that were written.
  using Sink = std::function<void(std::span<const std::byte>)>;
  /// Bytes that a sink gets at a time.
  static constexpr std::size_t kPiece = std::size_t{64} << 10U;

  /// Keeps what is written, until it is taken.
  ByteWriter() = default;
  /// Hands on what is written and keeps no more than a piece of it. Every piece but the last has kPiece bytes, however
  /// they were written. What the sink throws comes out of the member that filled the piece.
  explicit ByteWriter(Sink sink) : sink_(std::move(sink)) { bytes_.reserve(2 * kPiece); }

  /// Makes room for so many bytes in all, so that a long state is not copied while it grows.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  void number(std::uint64_t value);                         ///< LEB128.
  void real(double value) { reals(std::span(&value, 1)); }  ///< Every bit is kept.
  void reals(std::span<const double> values);               ///< Without their number.
  void block(std::span<const std::byte> bytes);             ///< Their number, then the bytes.
  /// As a block.
  void text(std::string_view value) { block(std::as_bytes(std::span(value))); }
  void raw(std::span<const std::byte> bytes);  ///< The bytes as they are, without their number.

  /// What was written; leaves nothing. Precondition: there is no sink.
  Bytes take() { return std::exchange(bytes_, {}); }
  /// Hands on the last piece, if anything is left. Precondition: there is a sink.
  void flush();

 private:
  std::size_t most_at_once() const;
  void hand_on();

  Bytes bytes_;
  Sink sink_;
};

/// Writes something of any length: the same bytes each time it is called, until what it refers to changes.
using ByteSource = std::function<void(ByteWriter&)>;

std::size_t size_of(const ByteSource& source);  ///< Bytes that it writes; none of them is kept.
Bytes bytes_of(const ByteSource& source);       ///< All that it writes, in as much memory as that takes.

/// Reads what ByteWriter wrote. The bytes may come from anywhere: every member throws BytesError for what cannot have
/// been written, and no memory is asked for that the bytes left could not fill.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : left_(bytes) {}  ///< Refers to the bytes.

  std::uint64_t number();                          ///< LEB128.
  std::uint64_t number_up_to(std::uint64_t most);  ///< The same; also throws when it is above `most`.
  /// The number of things that follow, of at least so many bytes each. Precondition: least_bytes > 0.
  std::size_t count(std::size_t least_bytes);
  double real();                                 ///< One double.
  void reals(std::span<double> values);          ///< Fills `values`.
  std::vector<double> reals(std::size_t count);  ///< So many doubles, whose number the reader knows.
  std::span<const std::byte> block();            ///< Refers to the bytes that are read.
  std::string text();                            ///< A block as text.
  /// So many bytes as they stand; refers to the bytes that are read.
  std::span<const std::byte> raw(std::size_t count);

  std::size_t left() const { return left_.size(); }  ///< Bytes that were not read yet.
  void expect_end() const;                           ///< Throws when something is left.

 private:
  std::span<const std::byte> left_;
};

}  // namespace poesy
