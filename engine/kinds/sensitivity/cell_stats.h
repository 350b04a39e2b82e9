#pragma once

#include <cstddef>
#include <vector>

#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/stats/moments.h"

namespace poesy {

/// Statistics of the samples of consecutive cells, for R responses. Each response has a list of its own, so that its
/// memory can be freed separately.
struct CellStats {
  std::vector<std::vector<Moments>> responses;  ///< [R][cells] over the samples that count
  std::vector<SolveCounts> solves;              ///< [cells]
  std::vector<FailedSamples> failed;            ///< [cells]

  /// No cells.
  CellStats() = default;
  /// Cells without samples.
  CellStats(std::size_t response_count, std::size_t cells)
      : responses(response_count, std::vector<Moments>(cells)), solves(cells), failed(cells) {}

  std::size_t size() const { return solves.size(); }  ///< The number of cells.
  UnitStats at(std::size_t cell) const;               ///< The statistics of one cell.
  /// Reads or writes one cell, whose samples begin at `first`.
  void state(Archive& archive, std::size_t cell, std::uint64_t first);
  CellStats part(const NumberRange& cells) const;  ///< The statistics of some of the cells.
  void merge(std::size_t cell,
             const UnitStats& unit);  ///< Adds a unit to a cell. Precondition: see UnitStats::merge().
  /// Adds later samples of the same cells. Frees the memory of `later` step by step. Precondition: the samples of
  /// `later` come after those of this object.
  void merge(CellStats later);
};

}  // namespace poesy
