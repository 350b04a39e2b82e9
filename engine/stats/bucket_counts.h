#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/stats/bucket_scale.h"

namespace poesy {

/// How many numbers lie in each bucket of a scale, for both signs, and how many are zero. Takes 16 kB for
/// kMostPages, 128 bytes for each page beyond in which a number lies, two bytes for each page that is spanned, and 512
/// more for each page once a bucket holds 65 536 numbers.
class BucketCounts {
 public:
  /// A bucket in which numbers lie.
  struct Filled {
    std::uint64_t bucket;  ///< of their magnitudes
    std::uint64_t count;   ///< numbers in it
  };

  BucketCounts() = default;
  /// Without numbers, with room for kMostPages: a study may have thousands of these, which leave no gaps between them.
  explicit BucketCounts(const BucketScale& scale) : scale_(scale) { counts_.reserve(kMostPages * kPageBuckets); }

  /// Pages that it has room for from the beginning.
  static constexpr std::size_t kMostPages = 128;

  const BucketScale& scale() const { return scale_; }                  ///< Whose buckets are counted.
  std::size_t pages() const { return counts_.size() / kPageBuckets; }  ///< In which numbers lie.
  std::uint64_t zeros() const { return zeros_; }                       ///< Numbers that are taken for zero.

  /// Makes room between these extremes. Precondition: what is counted lies between them.
  void reach(const Extremes& extremes);
  /// Precondition: reach() made room for them.
  void add(std::span<const double> values);
  /// Exact. Preconditions: the same scale; reach() made room.
  void merge(const BucketCounts& other);
  /// Takes the next coarser scale. Exact: what was counted there from the beginning. Precondition: there is one.
  void coarsen();
  /// The magnitudes of what is counted. extremes: theirs, which take memory for each page that they span.
  BucketCounts folded(const Extremes& extremes) const;

  std::vector<Filled> below() const;  ///< What lies below zero, from the largest magnitude on.
  std::vector<Filled> above() const;  ///< What lies above zero, from the smallest on.

  /// Every count, and back.
  void write(ByteWriter& to) const;
  /// Throws BytesError for what no numbers with these extremes give.
  static BucketCounts read(ByteReader& from, const Extremes& extremes);

 private:
  /// Where the pages of a sign are.
  struct Side {
    std::uint64_t first = 0;              ///< page
    std::vector<std::uint16_t> places{};  ///< of the pages first, first + 1, ... in counts_; kNowhere without counts
  };
  static constexpr std::uint16_t kNowhere = 0xffff;

  std::uint64_t count_at(std::size_t at) const { return counts_[at] + (wraps_.empty() ? 0 : wraps_[at] << 16U); }
  /// Where the counts of a page begin; it gets some if it has none.
  std::size_t place(Side& side, std::uint64_t page);
  std::uint16_t new_page();  ///< Its place, without numbers.
  void add_at(std::size_t at, std::uint64_t count);
  /// The 16 bits of a count went over, so often.
  void wrap(std::size_t at, std::uint64_t times);
  void merge_side(Side& side, const BucketCounts& other, const Side& others);
  std::vector<Filled> filled(std::size_t sign) const;
  void write_page(std::size_t begin, ByteWriter& to) const;  ///< The counts of a page.

  BucketScale scale_;
  std::array<Side, 2> sides_;          ///< above zero, below
  std::vector<std::uint16_t> counts_;  ///< [pages x kPageBuckets] modulo 2^16: a study may have thousands of sketches
  std::vector<std::uint64_t> wraps_;   ///< how often each went over; empty as long as none did
  std::uint64_t zeros_ = 0;
};

}  // namespace poesy
