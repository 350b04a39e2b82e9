#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/stats/bucket_scale.h"

namespace poesy {

/// The number of values in each bucket of a scale, for both signs, and the number of zeros. A page is a block of
/// kPageBuckets consecutive buckets of one sign; it is stored only if it has values. Memory: 16 kB for kMostPages
/// pages, 128 bytes for each further page, and two bytes for each page, stored or not, between the first and the last.
/// Once a bucket has 65 536 values, each stored page takes 512 bytes more.
class BucketCounts {
 public:
  /// A bucket that contains values.
  struct Filled {
    std::uint64_t bucket;  ///< index of the bucket in the scale of magnitudes
    std::uint64_t count;   ///< number of values in the bucket
  };

  BucketCounts() = default;
  /// Empty counts with room for kMostPages pages. A study may have thousands of these objects; because all allocate the
  /// same size, the heap does not fragment.
  explicit BucketCounts(const BucketScale& scale) : scale_(scale) { counts_.reserve(kMostPages * kPageBuckets); }

  /// The number of pages for which the constructor reserves memory.
  static constexpr std::size_t kMostPages = 128;

  const BucketScale& scale() const { return scale_; }                  ///< The scale of the buckets.
  std::size_t pages() const { return counts_.size() / kPageBuckets; }  ///< The number of pages with values.
  std::uint64_t zeros() const { return zeros_; }                       ///< The number of zero and subnormal values.

  /// Extends the lists of pages to all pages that values between these extremes need. Precondition: all counted values
  /// are between these extremes.
  void reach(const Extremes& extremes);
  /// Counts these values. Precondition: they are between the extremes of the last reach().
  void add(std::span<const double> values);
  /// Adds the counts of another object, exactly. Preconditions: the same scale; the values of the other object are
  /// between the extremes of the last reach().
  void merge(const BucketCounts& other);
  /// Replaces the scale by the next coarser one, and the counts by those of the coarser scale. Precondition: there is a
  /// coarser scale.
  void coarsen();
  /// The counts of the magnitudes: the counts of each bucket for both signs are added. extremes: the extremes of the
  /// magnitudes. The result takes memory for each page between these extremes.
  BucketCounts folded(const Extremes& extremes) const;

  std::vector<Filled> below() const;  ///< Filled buckets below zero, from the largest magnitude to the smallest.
  std::vector<Filled> above() const;  ///< Filled buckets above zero, from the smallest to the largest.

  /// Writes every count.
  void write(ByteWriter& to) const;
  /// Reads counts. Throws BytesError if values with these extremes cannot have these counts.
  static BucketCounts read(ByteReader& from, const Extremes& extremes);

 private:
  /// The pages of the values of one sign, with their places in counts_.
  struct Side {
    std::uint64_t first = 0;  ///< index of the first page
    /// Places of the pages first, first + 1, ... in counts_; kNowhere for pages without counts.
    std::vector<std::uint16_t> places{};
  };
  static constexpr std::uint16_t kNowhere = 0xffff;

  std::uint64_t count_at(std::size_t at) const { return counts_[at] + (wraps_.empty() ? 0 : wraps_[at] << 16U); }
  /// The index in counts_ of the first count of this page. Makes an empty page if none is stored yet.
  std::size_t place(Side& side, std::uint64_t page);
  std::uint16_t new_page();  ///< Makes an empty page and returns its index among the stored pages.
  void add_at(std::size_t at, std::uint64_t count);
  /// Records that the 16-bit count at this index has overflowed `times` times.
  void wrap(std::size_t at, std::uint64_t times);
  void merge_side(Side& side, const BucketCounts& other, const Side& others);
  std::vector<Filled> filled(std::size_t sign) const;
  void write_page(std::size_t begin, ByteWriter& to) const;  ///< Writes the counts of a page.

  BucketScale scale_;
  std::array<Side, 2> sides_;          ///< pages of values above and below zero
  std::vector<std::uint16_t> counts_;  ///< [pages x kPageBuckets] counts modulo 2^16, to save memory
  std::vector<std::uint64_t> wraps_;   ///< overflows of each count; empty if there were none
  std::uint64_t zeros_ = 0;
};

}  // namespace poesy
