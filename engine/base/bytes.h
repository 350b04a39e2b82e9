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

/// The exception for bytes that do not have the expected form. what() is a clause without the name of the file, such as
/// "ends too early".
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
  /// A function that takes the written bytes, piece by piece.
  using Sink = std::function<void(std::span<const std::byte>)>;
  /// The number of bytes that a sink gets at a time.
  static constexpr std::size_t kPiece = std::size_t{64} << 10U;

  /// Keeps the written bytes in memory until take().
  ByteWriter() = default;
  /// Passes the written bytes to a sink, and keeps at most two pieces in memory. Every piece except the last has kPiece
  /// bytes. If the sink throws, the exception leaves the function of the writer that filled the piece.
  explicit ByteWriter(Sink sink) : sink_(std::move(sink)) { bytes_.reserve(2 * kPiece); }

  /// Reserves memory for `bytes` bytes in all, so that a long state is not copied while it grows.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  void number(std::uint64_t value);                         ///< Writes a whole number (LEB128).
  void real(double value) { reals(std::span(&value, 1)); }  ///< Writes a double, bit by bit.
  void reals(std::span<const double> values);               ///< Writes doubles without their number.
  void block(std::span<const std::byte> bytes);             ///< Writes the number of bytes, then the bytes.
  /// Writes a text as a block.
  void text(std::string_view value) { block(std::as_bytes(std::span(value))); }
  void raw(std::span<const std::byte> bytes);  ///< Writes the bytes without their number.

  /// Returns the written bytes, and empties the writer. Precondition: there is no sink.
  Bytes take() { return std::exchange(bytes_, {}); }
  /// Passes the last piece to the sink, if it is not empty. Precondition: there is a sink.
  void flush();

 private:
  std::size_t most_at_once() const;
  void hand_on();

  Bytes bytes_;
  Sink sink_;
};

/// A function that writes data of any length. Each call writes the same bytes, unless the data change.
using ByteSource = std::function<void(ByteWriter&)>;

std::size_t size_of(const ByteSource& source);  ///< The number of bytes that the source writes; they are not stored.
Bytes bytes_of(const ByteSource& source);       ///< All bytes that the source writes, in a list without spare capacity.

/// Reads bytes of a ByteWriter. They may come from any source: every member throws BytesError for bytes that a
/// ByteWriter cannot write, and allocates no more memory than the remaining bytes can fill.
class ByteReader {
 public:
  /// A reader of `bytes`, which must outlive the reader.
  explicit ByteReader(std::span<const std::byte> bytes) : left_(bytes) {}

  std::uint64_t number();                          ///< Reads a whole number (LEB128).
  std::uint64_t number_up_to(std::uint64_t most);  ///< Reads a whole number. Also throws if it is above `most`.
  /// Reads the number of items that follow. Throws if the remaining bytes cannot hold so many items of at least
  /// `least_bytes` bytes each. Precondition: least_bytes > 0.
  std::size_t count(std::size_t least_bytes);
  double real();                                 ///< Reads a double.
  void reals(std::span<double> values);          ///< Fills `values` with doubles.
  std::vector<double> reals(std::size_t count);  ///< Reads `count` doubles.
  std::span<const std::byte> block();            ///< Reads a block, and returns a view of its bytes.
  std::string text();                            ///< Reads a block as text.
  /// Reads `count` bytes, and returns a view of them.
  std::span<const std::byte> raw(std::size_t count);

  std::size_t left() const { return left_.size(); }  ///< The number of bytes that are left.
  void expect_end() const;                           ///< Throws if there are bytes left.

 private:
  std::span<const std::byte> left_;
};

}  // namespace poesy
