#include "engine/kinds/coupling/worst_case.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/run/unit_fold.h"

namespace poesy::coupling {
namespace {

/// Reads or writes the signs of a corner: one for each block of errors, or none if there is no corner. blocks: number
/// of blocks.
void signs_state(Archive& archive, Signs& signs, std::size_t blocks) {
  archive.text(signs);
  const auto is_sign = [](char sign) { return sign == '+' || sign == '-'; };
  archive.expect(std::ranges::all_of(signs, is_sign) && (signs.empty() || signs.size() == blocks),
                 "has signs of other errors");
}

void place_state(Archive& archive, WorstCases::Place& place, std::size_t poses, std::size_t blocks) {
  auto number = static_cast<std::uint64_t>(place.pose + 1);
  archive.real(place.value);
  archive.number(number, poses);
  place.pose = static_cast<std::int64_t>(number) - 1;
  signs_state(archive, place.signs, blocks);
  archive.expect((place.pose < 0) == place.signs.empty(), "has a corner without a pose");
}

/// Replaces `worst` by `later` if `later` has a larger value, or if `worst` has no corner. Does nothing if `later` has
/// no corner.
void take_worse(WorstCases::Place& worst, WorstCases::Place later) {
  if (later.signs.empty() || (worst.pose >= 0 && !(later.value > worst.value))) return;
  worst = std::move(later);
}
void take_first(WorstCases::Place& first, WorstCases::Place later) {
  if (first.pose < 0 && !later.signs.empty()) first = std::move(later);
}

/// The indices of the size and the pose of work unit n.
std::pair<std::size_t, std::size_t> size_and_pose(const CornerTable& table, std::size_t n) {
  return {n % table.size_of_error.size(), n / table.size_of_error.size()};
}

/// The result of a unit of work (one size at one pose), as ranks send it to rank 0.
struct CornerUnit : CornersAtPose {
  const CornerTable* table = nullptr;

  void state(Archive& archive) {
    archive.object(solves);
    for (std::size_t k = 0; k < subsets.size(); ++k) {
      WorstCorners& corners = subsets[k];
      const std::size_t blocks = table->subsets[k].size();
      archive.reals(corners.value);
      for (Signs& signs : corners.signs) signs_state(archive, signs, blocks);
      archive.number(corners.tried);
      archive.number(corners.unsolved, corners.tried);
      signs_state(archive, corners.first_unsolved, blocks);
    }
  }
};

/// Accumulator of the worst cases for all responses, sizes of the errors, subsets of sources and poses.
struct CornerSums : WorstCases {
  const CornerTable* table;

  CornerSums(const CornerTable& of, std::size_t responses, std::size_t poses) : table(&of) {
    const std::size_t sizes = of.size_of_error.size();
    const std::size_t subsets = of.subsets.size();
    value = decltype(value)({responses, sizes, subsets, poses}, kNaN);
    tried = decltype(tried)({sizes, subsets, poses});
    unsolved = tried;
    solves = decltype(solves)({sizes, poses});
    worst = decltype(worst)({responses, sizes, subsets});
    first_unsolved = decltype(first_unsolved)({sizes, subsets});
  }

  void add(std::size_t n, CornerUnit&& found) {
    const auto [z, m] = size_and_pose(*table, n);
    solves(z, m) = found.solves;
    for (std::size_t k = 0; k < found.subsets.size(); ++k) {
      WorstCorners& corners = found.subsets[k];
      const auto pose = static_cast<std::int64_t>(m);
      tried(z, k, m) = corners.tried;
      unsolved(z, k, m) = corners.unsolved;
      for (std::size_t r = 0; r < corners.value.size(); ++r) {
        value(r, z, k, m) = corners.value[r];
        take_worse(worst(r, z, k), {corners.value[r], pose, std::move(corners.signs[r])});
      }
      take_first(first_unsolved(z, k), {0.0, pose, std::move(corners.first_unsolved)});
    }
  }

  void state(Archive& archive, const NumberRange& units) {
    for (std::size_t n = units.first; n < units.end; ++n) unit_state(archive, n);
    const auto [responses, sizes, subsets] = worst.lengths();
    for (std::size_t z = 0; z < sizes; ++z) {
      for (std::size_t k = 0; k < subsets; ++k) {
        for (std::size_t r = 0; r < responses; ++r) places_state(archive, k, worst(r, z, k), take_worse);
        places_state(archive, k, first_unsolved(z, k), take_first);
      }
    }
  }

 private:
  void unit_state(Archive& archive, std::size_t n) {
    const auto [z, m] = size_and_pose(*table, n);
    archive.object(solves(z, m));
    for (std::size_t k = 0; k < table->subsets.size(); ++k) {
      archive.number(tried(z, k, m));
      archive.number(unsolved(z, k, m), tried(z, k, m));
      for (std::size_t r = 0; r < value.length<axis::Response>(); ++r) archive.real(value(r, z, k, m));
    }
  }
  /// Reads or writes a corner and its pose. When reading, take(place, read) merges the corner that was read, which
  /// belongs to later units, into `place`.
  template <class Take>
  void places_state(Archive& archive, std::size_t subset, Place& place, const Take& take) {
    Place read = archive.reads() ? Place() : place;
    place_state(archive, read, solves.length<axis::Pose>(), table->subsets[subset].size());
    if (archive.reads()) take(place, std::move(read));
  }
};

/// The job of a UnitFold (run/unit_fold.h). A unit is one size at one pose; units are in the order of poses, then
/// sizes.
struct CornerJob {
  const StudyRun& run;
  const CornerTable& table;
  const Array<double, axis::Response, axis::Size>& rounding;

  static constexpr std::string_view kName = "corners";
  std::size_t responses() const { return run.model.description().responses.size(); }
  std::vector<std::uint64_t> sizes() const {
    return {run.poses.size(), table.size_of_error.size(), table.subsets.size(), responses(), table.blocks.size()};
  }
  NumberRange units(const Shard& shard) const { return shard.of(run.poses.size() * table.size_of_error.size()); }
  std::uint64_t expected(std::size_t) const {
    return static_cast<std::uint64_t>(std::llround(expected_corners(table, responses())));
  }
  auto worker() const {
    return [&table = table,
            search = CornerSearch(run.model, run.study.solver, run.poses, table, rounding)](std::size_t n) mutable {
      const auto [size, pose] = size_and_pose(table, n);
      return CornerUnit{search(pose, size), &table};
    };
  }
  CornerUnit unit(std::size_t) const {
    const WorstCorners none{std::vector<double>(responses()), std::vector<Signs>(responses())};
    return {{std::vector(table.subsets.size(), none), {}}, &table};
  }
  static SolveCounts solves(std::size_t, const CornerUnit& found) { return found.solves; }
  CornerSums sums() const { return {table, responses(), run.poses.size()}; }
};

/// Sets the sign of each error at this corner: 1, -1, or 0 for an error outside the subset or if there is no corner.
void fill_signs(const WorstCases::Place& place, std::size_t subset, const CornerTable& table,
                std::span<std::int64_t> signs) {
  std::ranges::transform(table.signs_of_errors(subset, place.signs), signs.begin(),
                         [](double sign) { return static_cast<std::int64_t>(sign); });
}

}  // namespace

std::optional<WorstCases> run_worst_cases(const StudyRun& run, const CornerTable& table,
                                          const Array<double, axis::Response, axis::Size>& rounding,
                                          const RunOptions& options) {
  return fold_units(CornerJob{run, table, rounding}, options);
}

void add_worst_cases(WorstCases found, const CornerTable& table, Result& result) {
  POESY_EXPECTS(found.value.lengths() == result.first_order_sum.lengths());
  const auto [responses, sizes, subsets] = found.worst.lengths();
  const std::size_t errors = table.factors.size();
  result.worst_case = std::move(found.value);
  result.corners = std::move(found.tried);
  result.unsolved_corners = std::move(found.unsolved);
  result.worst_case_max = decltype(result.worst_case_max)(found.worst.lengths());
  result.worst_case_max_pose = decltype(result.worst_case_max_pose)(found.worst.lengths());
  result.worst_case_signs = decltype(result.worst_case_signs)({responses, sizes, subsets, errors});
  result.unsolved_pose = decltype(result.unsolved_pose)({sizes, subsets});
  result.unsolved_signs = decltype(result.unsolved_signs)({sizes, subsets, errors});
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

}  // namespace poesy::coupling
