#include "engine/base/bytes.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace poesy {
namespace {

constexpr unsigned kBitsPerByte = 7;
constexpr std::byte kMore{0x80};
constexpr std::byte kBits{0x7f};

void store(double value, std::byte* at) {
  auto bits = std::bit_cast<std::uint64_t>(value);
  for (std::size_t k = 0; k < sizeof bits; ++k) {
    at[k] = static_cast<std::byte>(bits & 0xffU);
    bits >>= 8U;
  }
}

double load(const std::byte* at) {
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < sizeof bits; ++k) bits |= std::to_integer<std::uint64_t>(at[k]) << (8U * k);
  return std::bit_cast<double>(bits);
}

}  // namespace

void ByteWriter::number(std::uint64_t value) {
  for (; value > std::to_integer<std::uint64_t>(kBits); value >>= kBitsPerByte) {
    bytes_.push_back(static_cast<std::byte>(value & 0xffU) | kMore);
  }
  bytes_.push_back(static_cast<std::byte>(value));
  hand_on();
}

void ByteWriter::reals(std::span<const double> values) {
  while (!values.empty()) {
    const std::span<const double> some = values.first(std::min(values.size(), most_at_once() / sizeof(double)));
    const std::size_t start = bytes_.size();
    bytes_.resize(start + some.size_bytes());
    for (std::size_t k = 0; k < some.size(); ++k) store(some[k], &bytes_[start + k * sizeof(double)]);
    values = values.subspan(some.size());
    hand_on();
  }
}

void ByteWriter::raw(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const std::span<const std::byte> some = bytes.first(std::min(bytes.size(), most_at_once()));
    bytes_.insert(bytes_.end(), some.begin(), some.end());
    bytes = bytes.subspan(some.size());
    hand_on();
  }
}

std::size_t ByteWriter::most_at_once() const { return sink_ ? kPiece : std::numeric_limits<std::size_t>::max(); }

/// Passes a piece to the sink as soon as kPiece bytes are collected.
void ByteWriter::hand_on() {
  if (!sink_ || bytes_.size() < kPiece) return;
  sink_(std::span(bytes_).first(kPiece));
  bytes_.erase(bytes_.begin(), bytes_.begin() + kPiece);
}

void ByteWriter::flush() {
  if (!bytes_.empty()) sink_(bytes_);
  bytes_.clear();
}

void ByteWriter::block(std::span<const std::byte> bytes) {
  number(bytes.size());
  raw(bytes);
}

std::size_t size_of(const ByteSource& source) {
  std::size_t size = 0;
  ByteWriter to([&](std::span<const std::byte> bytes) { size += bytes.size(); });
  source(to);
  to.flush();
  return size;
}

Bytes bytes_of(const ByteSource& source) {
  ByteWriter to;
  to.reserve(size_of(source));
  source(to);
  return to.take();
}

std::uint64_t ByteReader::number() {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += kBitsPerByte) {
    const std::byte byte = raw(1)[0];
    const auto bits = std::to_integer<std::uint64_t>(byte & kBits);
    if ((bits << shift) >> shift != bits) break;
    value |= bits << shift;
    if ((byte & kMore) == std::byte{0}) return value;
  }
  throw BytesError("a number has more than 64 bits");
}

std::uint64_t ByteReader::number_up_to(std::uint64_t most) {
  const std::uint64_t value = number();
  if (value <= most) return value;
  throw BytesError("a number is " + std::to_string(value) + ", but at most " + std::to_string(most) + " makes sense");
}

std::size_t ByteReader::count(std::size_t least_bytes) {
  return static_cast<std::size_t>(number_up_to(left_.size() / least_bytes));
}

double ByteReader::real() {
  double value = 0.0;
  reals(std::span(&value, 1));
  return value;
}

void ByteReader::reals(std::span<double> values) {
  const std::span<const std::byte> bytes = raw(values.size() * sizeof(double));
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = load(&bytes[k * sizeof(double)]);
}

std::vector<double> ByteReader::reals(std::size_t count) {
  if (count > left_.size() / sizeof(double)) throw BytesError("ends too early");
  std::vector<double> values(count);
  reals(std::span(values));
  return values;
}

std::span<const std::byte> ByteReader::block() { return raw(count(1)); }

std::string ByteReader::text() {
  const std::span<const std::byte> bytes = block();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::byte> ByteReader::raw(std::size_t count) {
  if (count > left_.size()) throw BytesError("ends too early");
  const std::span<const std::byte> bytes = left_.first(count);
  left_ = left_.subspan(count);
  return bytes;
}

void ByteReader::expect_end() const {
  if (!left_.empty()) throw BytesError(std::to_string(left_.size()) + " bytes follow its end");
}

}  // namespace poesy
