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

using Bytes = std::vector<std::byte>;  ///< The bytes of a state, message or file.

/// Bytes do not have the right form. what() is a clause without a place.
class BytesError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes values one after the other, with the same bytes on every machine.
///
///     number    LEB128: seven bits a byte, the lowest first, the highest bit set in all bytes but the last
///     real      64 bits (IEEE 754), little-endian; every bit is kept
///     block     number of bytes, the bytes
///     text      as a block, UTF-8
class ByteWriter {
 public:
  /// Takes bytes that were written.
  using Sink = std::function<void(std::span<const std::byte>)>;
  /// The number of bytes that a sink gets at a time.
  static constexpr std::size_t kPiece = std::size_t{64} << 10U;

  /// Keeps what is written until take().
  ByteWriter() = default;
  /// Passes what is written to a sink, and keeps at most two pieces. Every piece but the last has kPiece bytes, however
  /// they were written. An exception of the sink leaves the function that filled the piece.
  explicit ByteWriter(Sink sink) : sink_(std::move(sink)) { bytes_.reserve(2 * kPiece); }

  /// Reserves memory for this many bytes in all, so that a long state is not copied while it grows.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  void number(std::uint64_t value);                         ///< Writes LEB128.
  void real(double value) { reals(std::span(&value, 1)); }  ///< Writes a double, bit by bit.
  void reals(std::span<const double> values);               ///< Writes doubles without their number.
  void block(std::span<const std::byte> bytes);             ///< Writes the number of bytes, then the bytes.
  /// Writes a text as a block.
  void text(std::string_view value) { block(std::as_bytes(std::span(value))); }
  void raw(std::span<const std::byte> bytes);  ///< Writes the bytes without their number.

  /// Returns what was written, and empties the writer. Precondition: there is no sink.
  Bytes take() { return std::exchange(bytes_, {}); }
  /// Passes the last piece to the sink, if it is not empty. Precondition: there is a sink.
  void flush();

 private:
  std::size_t most_at_once() const;
  void hand_on();

  Bytes bytes_;
  Sink sink_;
};

/// Writes data of any length. Each call writes the same bytes, until the data change.
using ByteSource = std::function<void(ByteWriter&)>;

std::size_t size_of(const ByteSource& source);  ///< The number of bytes that it writes, without storing them.
Bytes bytes_of(const ByteSource& source);       ///< All bytes that it writes, without spare memory.

/// Reads what ByteWriter wrote. The bytes may come from any source: every member throws BytesError for bytes that
/// cannot have been written, and allocates no more memory than the remaining bytes can fill.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : left_(bytes) {}  ///< A reader of these bytes. Refers to them.

  std::uint64_t number();                          ///< Reads LEB128.
  std::uint64_t number_up_to(std::uint64_t most);  ///< Reads LEB128; also throws if the number is above `most`.
  /// Reads the number of items that follow, each of at least this many bytes. Precondition: least_bytes > 0.
  std::size_t count(std::size_t least_bytes);
  double real();                                 ///< Reads a double.
  void reals(std::span<double> values);          ///< Fills `values`.
  std::vector<double> reals(std::size_t count);  ///< Reads this many doubles.
  std::span<const std::byte> block();            ///< Reads a block; a view of the bytes.
  std::string text();                            ///< Reads a block as text.
  /// Reads this many bytes; a view of them.
  std::span<const std::byte> raw(std::size_t count);

  std::size_t left() const { return left_.size(); }  ///< The number of bytes that are left.
  void expect_end() const;                           ///< Throws if there are bytes left.

 private:
  std::span<const std::byte> left_;
};

}  // namespace poesy
