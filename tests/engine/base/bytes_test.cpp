#include "engine/base/bytes.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

namespace poesy {
namespace {

constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();

Bytes bytes_of(std::initializer_list<int> values) {
  Bytes bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

TEST(Bytes, NumbersAreLeb128) {
  ByteWriter to;
  for (const std::uint64_t number : {std::uint64_t{0}, std::uint64_t{127}, std::uint64_t{128}, std::uint64_t{300}}) {
    to.number(number);
  }
  EXPECT_EQ(to.take(), bytes_of({0, 127, 0x80, 1, 0xac, 2}));
}

TEST(Bytes, NumbersComeBack) {
  ByteWriter to;
  for (unsigned bit = 0; bit < 64; ++bit) to.number(std::uint64_t{1} << bit);
  to.number(kMost);
  const Bytes bytes = to.take();
  ByteReader from(bytes);
  for (unsigned bit = 0; bit < 64; ++bit) EXPECT_EQ(from.number(), std::uint64_t{1} << bit);
  EXPECT_EQ(from.number(), kMost);
  EXPECT_NO_THROW(from.expect_end());
}

TEST(Bytes, RealsAreLittleEndianAndKeepEveryBit) {
  ByteWriter to;
  to.real(1.0);
  EXPECT_EQ(to.take(), bytes_of({0, 0, 0, 0, 0, 0, 0xf0, 0x3f}));
  for (const auto bits :
       std::initializer_list<std::uint64_t>{0x8000000000000000U, 0x7ff8000000000001U, 1U, 0x7ff0000000000000U}) {
    to.real(std::bit_cast<double>(bits));
    const Bytes bytes = to.take();
    ByteReader from(bytes);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(from.real()), bits);
  }
}

TEST(Bytes, TextsAndBlocksComeBack) {
  ByteWriter to;
  to.text("two words");
  to.block(bytes_of({1, 2, 3}));
  to.text("");
  const Bytes bytes = to.take();
  ByteReader from(bytes);
  EXPECT_EQ(from.text(), "two words");
  EXPECT_EQ(from.block().size(), 3U);
  EXPECT_EQ(from.text(), "");
  EXPECT_EQ(from.left(), 0U);
}

/// Writes each kind of value, in all more bytes than several pieces hold.
void write_some(ByteWriter& to) {
  constexpr std::size_t kPiece = ByteWriter::kPiece;
  to.number(kMost);
  to.reals(std::vector<double>(kPiece / 3, 0.1));
  for (std::size_t n = 0; n < kPiece; ++n) to.number(n);
  to.block(Bytes(2 * kPiece + 1, std::byte{9}));
  to.text("end");
}

TEST(Bytes, ASinkGetsTheSameBytesInWholePieces) {
  ByteWriter plain;
  write_some(plain);
  const Bytes expected = plain.take();
  Bytes given;
  std::vector<std::size_t> sizes;
  ByteWriter to([&](std::span<const std::byte> piece) {
    given.insert(given.end(), piece.begin(), piece.end());
    sizes.push_back(piece.size());
  });
  write_some(to);
  EXPECT_EQ(given.size(), expected.size() / ByteWriter::kPiece * ByteWriter::kPiece);
  to.flush();
  to.flush();
  EXPECT_TRUE(given == expected);
  ASSERT_GT(sizes.size(), 5U);
  EXPECT_EQ(sizes.back(), expected.size() % ByteWriter::kPiece);
  sizes.pop_back();
  for (const std::size_t size : sizes) EXPECT_EQ(size, ByteWriter::kPiece);
}

TEST(Bytes, ASourceIsMeasuredAndKeptWhole) {
  ByteWriter plain;
  write_some(plain);
  const Bytes expected = plain.take();
  EXPECT_EQ(size_of(write_some), expected.size());
  const Bytes given = bytes_of(write_some);
  EXPECT_TRUE(given == expected);
  EXPECT_EQ(given.capacity(), given.size());
  EXPECT_EQ(size_of([](ByteWriter&) {}), 0U);
}

TEST(Bytes, WhatCannotHaveBeenWrittenIsRefused) {
  const Bytes endless(11, std::byte{0xff});
  EXPECT_THROW(ByteReader(endless).number(), BytesError);
  const Bytes too_large = bytes_of({0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 2});  // 2^64 and more
  EXPECT_THROW(ByteReader(too_large).number(), BytesError);
  EXPECT_THROW(ByteReader({}).number(), BytesError);
  EXPECT_THROW(ByteReader({}).real(), BytesError);
  const Bytes five = bytes_of({5});
  EXPECT_THROW(ByteReader(five).number_up_to(4), BytesError);
  EXPECT_THROW(ByteReader(five).block(), BytesError);
  EXPECT_THROW(ByteReader(five).expect_end(), BytesError);
}

TEST(Bytes, ALengthIsNotTrusted) {
  ByteWriter to;
  to.number(kMost);
  const Bytes bytes = to.take();
  EXPECT_THROW(ByteReader(bytes).count(1), BytesError);
  EXPECT_THROW(ByteReader(bytes).text(), BytesError);
  EXPECT_THROW(ByteReader(bytes).reals(std::size_t{1} << 60U), BytesError);
}

}  // namespace
}  // namespace poesy
