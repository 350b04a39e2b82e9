#include "engine/kinds/coupling/worst_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/run/fold.h"

namespace poesy {
namespace {

constexpr std::uint64_t kKind = 5;  ///< no other state begins with this number

void write_place(const WorstCases::Place& place, ByteWriter& to) {
  to.real(place.value);
  to.number(static_cast<std::uint64_t>(place.pose + 1));
  to.text(place.signs);
}

/// Of so many blocks. Throws BytesError for other signs.
Signs read_signs(ByteReader& from, std::size_t blocks) {
  Signs signs = from.text();
  const auto is_sign = [](char sign) { return sign == '+' || sign == '-'; };
  if (!std::ranges::all_of(signs, is_sign) || (!signs.empty() && signs.size() != blocks)) {
    throw BytesError("has signs of other errors");
  }
  return signs;
}

WorstCases::Place read_place(ByteReader& from, std::size_t poses, std::size_t blocks) {
  WorstCases::Place place;
  place.value = from.real();
  place.pose = static_cast<std::int64_t>(from.number_up_to(poses)) - 1;
  place.signs = read_signs(from, blocks);
  if ((place.pose < 0) != place.signs.empty()) throw BytesError("has a corner without a pose");
  return place;
}

/// All sizes at all poses, pose by pose: the work of fold().
class CornerWork {
 public:
  CornerWork(const StudyRun& run, const CornerTable& table, const Array<double, axis::Response, axis::Size>& rounding,
             const Shard& shard)
      : run_(run),
        table_(table),
        rounding_(rounding),
        poses_(run.poses.size()),
        sizes_(table.size_of_error.size()),
        subsets_(table.subsets.size()),
        responses_(run.model.description().responses.size()),
        cells_(shard.of(poses_ * sizes_)) {
    clear();
  }

  std::size_t begin_round() {
    begun_ = next_;
    return cells_.end - next_;
  }
  CornerSearch worker() const { return {run_.model, run_.study.solver, run_.poses, table_, rounding_}; }
  CornersAtPose solve(CornerSearch& search, std::size_t n) const {
    return search((begun_ + n) / sizes_, (begun_ + n) % sizes_);
  }
  SolveCounts merge(std::size_t, CornersAtPose&& found) {
    const std::size_t m = next_ / sizes_;
    const std::size_t z = next_ % sizes_;
    found_.solves(z, m) = found.solves;
    for (std::size_t k = 0; k < subsets_; ++k) add(m, z, k, std::move(found.subsets[k]));
    ++next_;
    return found.solves;
  }
  static void write(std::size_t, const CornersAtPose& found, ByteWriter& to) {
    found.solves.write(to);
    for (const WorstCorners& corners : found.subsets) {
      to.reals(corners.value);
      for (const Signs& signs : corners.signs) to.text(signs);
      to.number(corners.tried);
      to.number(corners.unsolved);
      to.text(corners.first_unsolved);
    }
  }
  CornersAtPose read(std::size_t, ByteReader& from) const {
    CornersAtPose found;
    found.solves = SolveCounts::read(from);
    for (const std::vector<std::size_t>& blocks : table_.subsets) {
      WorstCorners& corners = found.subsets.emplace_back();
      corners.value = from.reals(responses_);
      for (std::size_t r = 0; r < responses_; ++r) corners.signs.push_back(read_signs(from, blocks.size()));
      corners.tried = from.number();
      corners.unsolved = from.number_up_to(corners.tried);
      corners.first_unsolved = read_signs(from, blocks.size());
    }
    return found;
  }
  SolveCounts solved() const { return total_of(found_.solves.all()); }
  std::uint64_t left() const {
    const std::size_t done = next_ - cells_.first;
    const double each = done == 0 ? expected_corners(table_, responses_)
                                  : static_cast<double>(solved().total()) / static_cast<double>(done);
    return static_cast<std::uint64_t>(each * static_cast<double>(cells_.end - next_));
  }
  void write_state(ByteWriter& to) const {
    for (const std::uint64_t number : sizes()) to.number(number);
    to.number(cells_.first);
    to.number(next_);
    for (std::size_t cell = cells_.first; cell < next_; ++cell) write_cell(cell, to);
    for (const WorstCases::Place& place : found_.worst) write_place(place, to);
    for (const WorstCases::Place& place : found_.first_unsolved) write_place(place, to);
  }
  void restore(std::span<const std::byte> state) {
    clear();
    ByteReader from(state);
    while (from.left() > 0) restore_one(from);
  }
  static bool next_round() { return false; }

  WorstCases result() && { return std::move(found_); }

 private:
  /// Forgets all that was merged.
  void clear() {
    next_ = cells_.first;
    found_.value = decltype(found_.value)({responses_, sizes_, subsets_, poses_}, kNaN);
    make_room({sizes_, subsets_, poses_}, found_.tried, found_.unsolved);
    make_room({sizes_, poses_}, found_.solves);
    make_room({responses_, sizes_, subsets_}, found_.worst);
    make_room({sizes_, subsets_}, found_.first_unsolved);
  }
  std::array<std::uint64_t, 6> sizes() const {
    return {kKind, poses_, sizes_, subsets_, responses_, table_.blocks.size()};
  }
  void add(std::size_t m, std::size_t z, std::size_t k, WorstCorners&& corners) {
    found_.tried(z, k, m) = corners.tried;
    found_.unsolved(z, k, m) = corners.unsolved;
    for (std::size_t r = 0; r < responses_; ++r) {
      found_.value(r, z, k, m) = corners.value[r];
      take_worse(found_.worst(r, z, k), {corners.value[r], static_cast<std::int64_t>(m), corners.signs[r]});
    }
    take_first(found_.first_unsolved(z, k), {0.0, static_cast<std::int64_t>(m), corners.first_unsolved});
  }
  /// Of an earlier pose and a later one.
  static void take_worse(WorstCases::Place& worst, WorstCases::Place other) {
    if (other.signs.empty() || (worst.pose >= 0 && !(other.value > worst.value))) return;
    worst = std::move(other);
  }
  static void take_first(WorstCases::Place& first, WorstCases::Place other) {
    if (first.pose < 0 && !other.signs.empty()) first = std::move(other);
  }

  void write_cell(std::size_t cell, ByteWriter& to) const {
    const std::size_t m = cell / sizes_;
    const std::size_t z = cell % sizes_;
    found_.solves(z, m).write(to);
    for (std::size_t k = 0; k < subsets_; ++k) {
      to.number(found_.tried(z, k, m));
      to.number(found_.unsolved(z, k, m));
      for (std::size_t r = 0; r < responses_; ++r) to.real(found_.value(r, z, k, m));
    }
  }
  void read_cell(std::size_t cell, ByteReader& from) {
    const std::size_t m = cell / sizes_;
    const std::size_t z = cell % sizes_;
    found_.solves(z, m) = SolveCounts::read(from);
    for (std::size_t k = 0; k < subsets_; ++k) {
      found_.tried(z, k, m) = from.number();
      found_.unsolved(z, k, m) = from.number_up_to(found_.tried(z, k, m));
      for (std::size_t r = 0; r < responses_; ++r) found_.value(r, z, k, m) = from.real();
    }
  }
  WorstCases::Place read_place(ByteReader& from, std::size_t subset) const {
    return poesy::read_place(from, poses_, table_.subsets[subset].size());
  }
  void restore_one(ByteReader& from) {
    const auto expect = [&](std::uint64_t number) {
      if (from.number() != number) throw BytesError("is the state of another kind, size or part of a study");
    };
    std::ranges::for_each(sizes(), expect);
    expect(next_);
    const auto end = static_cast<std::size_t>(from.number_up_to(cells_.end));
    if (end < next_) throw BytesError("has poses that end before they begin");
    for (; next_ < end; ++next_) read_cell(next_, from);
    for (std::size_t r = 0; r < responses_; ++r) {
      for (std::size_t z = 0; z < sizes_; ++z) {
        for (std::size_t k = 0; k < subsets_; ++k) take_worse(found_.worst(r, z, k), read_place(from, k));
      }
    }
    for (std::size_t z = 0; z < sizes_; ++z) {
      for (std::size_t k = 0; k < subsets_; ++k) take_first(found_.first_unsolved(z, k), read_place(from, k));
    }
  }

  const StudyRun& run_;
  const CornerTable& table_;
  const Array<double, axis::Response, axis::Size>& rounding_;
  std::size_t poses_;
  std::size_t sizes_;
  std::size_t subsets_;
  std::size_t responses_;
  NumberRange cells_;      ///< the shard's: pose by pose, size by size
  std::size_t next_ = 0;   ///< cell to be merged
  std::size_t begun_ = 0;  ///< with which the round began
  WorstCases found_;
};

/// Fills in the signs of the errors at this place.
void fill_signs(const WorstCases::Place& place, std::size_t subset, const CornerTable& table,
                std::span<std::int64_t> signs) {
  std::ranges::transform(table.signs_of_errors(subset, place.signs), signs.begin(),
                         [](double sign) { return static_cast<std::int64_t>(sign); });
}

}  // namespace

std::optional<WorstCases> run_worst_cases(const StudyRun& run, const CornerTable& table,
                                          const Array<double, axis::Response, axis::Size>& rounding,
                                          const RunOptions& options) {
  CornerWork work(run, table, rounding, options.shard.value_or(Shard()));
  if (!fold(work, options) || options.shard) return std::nullopt;
  return std::move(work).result();
}

void add_worst_cases(WorstCases found, const CornerTable& table, CouplingResult& result) {
  POESY_EXPECTS(found.value.lengths() == result.first_order_sum.lengths());
  const auto [responses, sizes, subsets] = found.worst.lengths();
  const std::size_t errors = table.factors.size();
  result.worst_case = std::move(found.value);
  result.corners = std::move(found.tried);
  result.unsolved_corners = std::move(found.unsolved);
  make_room(found.worst.lengths(), result.worst_case_max, result.worst_case_max_pose);
  make_room({responses, sizes, subsets, errors}, result.worst_case_signs);
  make_room({sizes, subsets}, result.unsolved_pose);
  make_room({sizes, subsets, errors}, result.unsolved_signs);
  for (std::size_t z = 0; z < sizes; ++z) {
    for (std::size_t k = 0; k < subsets; ++k) {
      for (std::size_t r = 0; r < responses; ++r) {
        const WorstCases::Place& worst = found.worst(r, z, k);
        result.worst_case_max(r, z, k) = worst.pose < 0 ? kNaN : worst.value;
        result.worst_case_max_pose(r, z, k) = worst.pose;
        fill_signs(worst, k, table, result.worst_case_signs.row(r, z, k));
      }
      const WorstCases::Place& unsolved = found.first_unsolved(z, k);
      result.unsolved_pose(z, k) = unsolved.pose;
      fill_signs(unsolved, k, table, result.unsolved_signs.row(z, k));
    }
    for (std::size_t m = 0; m < found.solves.length<axis::Pose>(); ++m) {
      result.solves(z, m).merge(found.solves(z, m));
    }
  }
}

}  // namespace poesy
