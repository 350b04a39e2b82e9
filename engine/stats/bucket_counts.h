#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/stats/bucket_scale.h"

namespace poesy {

/// The number of values in each bucket of a scale, for both signs, and the number of zeros. It takes 16 kB for
/// kMostPages, 128 bytes for each further page with values, two bytes for each page that is spanned, and 512 more for
/// each page once a bucket has 65 536 values.
class BucketCounts {
 public:
  /// A bucket with values.
  struct Filled {
    std::uint64_t bucket;  ///< bucket of the magnitudes
    std::uint64_t count;   ///< values in it
  };

  BucketCounts() = default;
  /// Empty counts with room for kMostPages. Equal sizes leave no gaps in memory between the thousands that a study may
  /// have.
  explicit BucketCounts(const BucketScale& scale) : scale_(scale) { counts_.reserve(kMostPages * kPageBuckets); }

  /// The number of pages for which there is room from the beginning.
  static constexpr std::size_t kMostPages = 128;

  const BucketScale& scale() const { return scale_; }                  ///< The scale of the buckets.
  std::size_t pages() const { return counts_.size() / kPageBuckets; }  ///< The number of pages with values.
  std::uint64_t zeros() const { return zeros_; }                       ///< The number of values that count as zero.

  /// Makes room for values between these extremes. Precondition: they include the values that are already counted.
  void reach(const Extremes& extremes);
  /// Counts these values. Precondition: reach() made room for them.
  void add(std::span<const double> values);
  /// Adds the counts of another object, exactly. Preconditions: the same scale; reach() made room.
  void merge(const BucketCounts& other);
  /// Changes to the next coarser scale, with the counts that it would have had from the beginning. Precondition: there
  /// is one.
  void coarsen();
  /// The counts of the magnitudes. extremes: those of the magnitudes; memory is taken for each page that they span.
  BucketCounts folded(const Extremes& extremes) const;

  std::vector<Filled> below() const;  ///< Buckets below zero, from the largest magnitude to the smallest.
  std::vector<Filled> above() const;  ///< Buckets above zero, from the smallest to the largest.

  /// Writes every count.
  void write(ByteWriter& to) const;
  /// Reads counts. Throws BytesError if values with these extremes cannot have them.
  static BucketCounts read(ByteReader& from, const Extremes& extremes);

 private:
  /// The places of the pages of one sign.
  struct Side {
    std::uint64_t first = 0;  ///< first page
    std::vector<std::uint16_t>
        places{};  ///< places of the pages first, first + 1, ... in counts_; kNowhere for pages without counts
  };
  static constexpr std::uint16_t kNowhere = 0xffff;

  std::uint64_t count_at(std::size_t at) const { return counts_[at] + (wraps_.empty() ? 0 : wraps_[at] << 16U); }
  /// The place of a page's counts, which are made if it has none.
  std::size_t place(Side& side, std::uint64_t page);
  std::uint16_t new_page();  ///< Makes an empty page and returns its place.
  void add_at(std::size_t at, std::uint64_t count);
  /// Records that a count of 16 bits has overflowed this many times.
  void wrap(std::size_t at, std::uint64_t times);
  void merge_side(Side& side, const BucketCounts& other, const Side& others);
  std::vector<Filled> filled(std::size_t sign) const;
  void write_page(std::size_t begin, ByteWriter& to) const;  ///< Writes the counts of a page.

  BucketScale scale_;
  std::array<Side, 2> sides_;          ///< sides above and below zero
  std::vector<std::uint16_t> counts_;  ///< [pages x kPageBuckets] modulo 2^16, to save memory
  std::vector<std::uint64_t> wraps_;   ///< overflows of each count; empty if there were none
  std::uint64_t zeros_ = 0;
};

}  // namespace poesy
