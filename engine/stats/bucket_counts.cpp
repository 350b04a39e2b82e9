#include "engine/stats/bucket_counts.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/base/contract.h"

namespace poesy {
namespace {

constexpr std::size_t kAbove = 0;
constexpr std::size_t kBelow = 1;

}  // namespace

void BucketCounts::reach(const Extremes& extremes) {
  for (const std::size_t s : {kAbove, kBelow}) {
    Side& side = sides_[s];
    const PageRange range = pages_spanned(extremes, scale_, s == kBelow);
    if (range.count == side.places.size()) continue;
    std::vector<std::uint16_t> places(range.count, kNowhere);
    if (!side.places.empty()) {
      std::ranges::copy(side.places, places.begin() + static_cast<std::ptrdiff_t>(side.first - range.first));
    }
    side = {range.first, std::move(places)};
  }
}

std::size_t BucketCounts::place(Side& side, std::uint64_t page) {
  std::uint16_t& place = side.places[page - side.first];
  if (place == kNowhere) place = new_page();
  return std::size_t{place} * kPageBuckets;
}

std::uint16_t BucketCounts::new_page() {
  const auto place = static_cast<std::uint16_t>(pages());
  counts_.resize(counts_.size() + kPageBuckets);
  if (!wraps_.empty()) wraps_.resize(counts_.size());
  return place;
}

void BucketCounts::wrap(std::size_t at, std::uint64_t times) {
  if (wraps_.empty()) wraps_.resize(counts_.size());
  wraps_[at] += times;
}

void BucketCounts::add_at(std::size_t at, std::uint64_t count) {
  const std::uint64_t sum = counts_[at] + count;
  counts_[at] = static_cast<std::uint16_t>(sum);
  if (sum > std::numeric_limits<std::uint16_t>::max()) wrap(at, sum >> 16U);
}

void BucketCounts::add(std::span<const double> values) {
  constexpr std::size_t kPiece = 256;
  std::array<std::uint64_t, kPiece> keys;
  for (std::size_t first = 0; first < values.size(); first += kPiece) {
    const std::span piece = std::span(keys).first(std::min(kPiece, values.size() - first));
    scale_.keys(values.subspan(first, piece.size()), piece);
    // The loop over keys finds the indices of up to kPiece counts, and the loop after it changes these counts. Counts
    // are seldom in the cache; in this way the processor fetches several of them at the same time.
    std::size_t counted = 0;
    for (const std::uint64_t key : piece) {
      const std::uint64_t bucket = key & ~BucketScale::kSign;
      // The sign of a value is as good as random, so a branch on the sign would be slow. The index below is computed
      // without this branch.
      const bool zero = bucket < BucketScale::kFirstNormal;
      zeros_ += zero ? 1 : 0;
      if (zero) continue;
      piece[counted++] = place(sides_[key >> 63U], bucket / kPageBuckets) + bucket % kPageBuckets;
    }
    std::uint16_t* counts = counts_.data();
    for (const std::uint64_t at : piece.first(counted)) {
      if (++counts[at] == 0) wrap(at, 1);
    }
  }
}

void BucketCounts::merge_side(Side& side, const BucketCounts& other, const Side& others) {
  for (std::size_t k = 0; k < others.places.size(); ++k) {
    if (others.places[k] == kNowhere) continue;
    const std::size_t from = others.places[k] * kPageBuckets;
    const std::size_t to = place(side, others.first + k);
    for (std::size_t b = 0; b < kPageBuckets; ++b) add_at(to + b, other.count_at(from + b));
  }
}

void BucketCounts::merge(const BucketCounts& other) {
  POESY_EXPECTS(other.scale_ == scale_);
  for (const std::size_t s : {kAbove, kBelow}) merge_side(sides_[s], other, other.sides_[s]);
  zeros_ += other.zeros_;
}

void BucketCounts::coarsen() {
  POESY_EXPECTS(!scale_.is_coarsest());
  const std::uint64_t even = scale_.first_even() / kPageBuckets;
  BucketCounts coarse(scale_.coarser());
  coarse.zeros_ = zeros_;
  for (const std::size_t s : {kAbove, kBelow}) {
    const Side& side = sides_[s];
    if (side.places.empty()) continue;
    Side& to = coarse.sides_[s];
    to.first = scale_.page_of_coarser(side.first);
    to.places.resize(scale_.page_of_coarser(side.first + side.places.size() - 1) - to.first + 1, kNowhere);
    for (std::size_t k = 0; k < side.places.size(); ++k) {
      if (side.places[k] == kNowhere) continue;
      const std::uint64_t page = side.first + k;
      const std::size_t from = side.places[k] * kPageBuckets;
      const std::size_t begin = coarse.place(to, scale_.page_of_coarser(page));
      const bool halved = page >= even;
      const std::size_t half = halved ? (page - even) % 2 * (kPageBuckets / 2) : 0;
      for (std::size_t b = 0; b < kPageBuckets; ++b) {
        coarse.add_at(begin + (halved ? half + b / 2 : b), count_at(from + b));
      }
    }
  }
  *this = std::move(coarse);
}

BucketCounts BucketCounts::folded(const Extremes& extremes) const {
  BucketCounts magnitudes(scale_);
  magnitudes.reach(extremes);
  for (const Side& side : sides_) magnitudes.merge_side(magnitudes.sides_[kAbove], *this, side);
  magnitudes.zeros_ = zeros_;
  return magnitudes;
}

std::vector<BucketCounts::Filled> BucketCounts::filled(std::size_t sign) const {
  const Side& side = sides_[sign];
  std::vector<Filled> filled;
  for (std::size_t k = 0; k < side.places.size(); ++k) {
    if (side.places[k] == kNowhere) continue;
    const std::size_t from = side.places[k] * kPageBuckets;
    for (std::size_t b = 0; b < kPageBuckets; ++b) {
      if (const std::uint64_t count = count_at(from + b))
        filled.push_back({(side.first + k) * kPageBuckets + b, count});
    }
  }
  return filled;
}

std::vector<BucketCounts::Filled> BucketCounts::above() const { return filled(kAbove); }

std::vector<BucketCounts::Filled> BucketCounts::below() const {
  std::vector<Filled> found = filled(kBelow);
  std::ranges::reverse(found);
  return found;
}

void BucketCounts::write_page(std::size_t begin, ByteWriter& to) const {
  constexpr std::uint64_t kOneByte = 0x7f;  // ByteWriter::number() writes numbers up to this in one byte
  std::array<std::byte, kPageBuckets> bytes;
  std::uint64_t bits = 0;
  for (std::size_t b = 0; b < kPageBuckets; ++b) {
    const std::uint64_t count = count_at(begin + b);
    bits |= count;
    bytes[b] = static_cast<std::byte>(count & kOneByte);
  }
  if (bits <= kOneByte) {
    to.raw(bytes);
    return;
  }
  for (std::size_t b = 0; b < kPageBuckets; ++b) to.number(count_at(begin + b));
}

void BucketCounts::write(ByteWriter& to) const {
  to.number(scale_.octave());
  to.number(zeros_);
  for (const Side& side : sides_) {
    to.number(side.places.size() - static_cast<std::size_t>(std::ranges::count(side.places, kNowhere)));
    std::size_t next = 0;
    for (std::size_t k = 0; k < side.places.size(); ++k) {
      if (side.places[k] == kNowhere) continue;
      to.number(k - std::exchange(next, k + 1));
      write_page(side.places[k] * kPageBuckets, to);
    }
  }
}

BucketCounts BucketCounts::read(ByteReader& from, const Extremes& extremes) {
  const auto octave = static_cast<unsigned>(from.number_up_to(BucketScale::kCoarsest));
  if (octave < finest_fitting(extremes).octave()) throw BytesError("a histogram has too many buckets");
  BucketCounts read{BucketScale(octave)};
  read.zeros_ = from.number_up_to(extremes.count);
  read.reach(extremes);
  std::uint64_t left = extremes.count - read.zeros_;
  for (Side& side : read.sides_) {
    std::size_t page = 0;
    for (std::size_t pages = from.count(1 + kPageBuckets); pages > 0; --pages, ++page) {
      if (page >= side.places.size()) throw BytesError("a histogram has buckets beyond its range");
      page += static_cast<std::size_t>(from.number_up_to(side.places.size() - 1 - page));
      const std::size_t begin = read.place(side, side.first + page);
      for (std::size_t b = 0; b < kPageBuckets; ++b) {
        const std::uint64_t count = from.number_up_to(left);
        read.add_at(begin + b, count);
        left -= count;
      }
    }
  }
  if (left != 0) throw BytesError("a histogram counts too little");
  return read;
}

}  // namespace poesy
