#pragma once

#include <cstddef>
#include <vector>

#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/stats/moments.h"

namespace poesy::sensitivity {

/// Statistics of the samples in consecutive cells. A cell is one error at one pose. Each response has its own list, so
/// that its memory can be freed separately.
struct CellStats {
  /// [responses][cells] Moments of the samples that count in statistics (counts()).
  std::vector<std::vector<Moments>> responses;
  std::vector<SolveCounts> solves;    ///< [cells] how the solves ended
  std::vector<FailedSamples> failed;  ///< [cells] first samples that failed

  /// No cells.
  CellStats() = default;
  /// Cells without samples.
  CellStats(std::size_t response_count, std::size_t cells)
      : responses(response_count, std::vector<Moments>(cells)), solves(cells), failed(cells) {}

  std::size_t size() const { return solves.size(); }  ///< The number of cells.
  UnitStats at(std::size_t cell) const;               ///< The statistics of one cell.
  /// Reads or writes the statistics of one cell. first: number of the cell's first sample.
  void state(Archive& archive, std::size_t cell, std::uint64_t first);
  CellStats part(const NumberRange& cells) const;  ///< The statistics of a range of cells.
  /// Adds the statistics of a unit of work to those of its cell. Precondition: the samples of the unit come after those
  /// of the cell.
  void merge(std::size_t cell, const UnitStats& unit);
  /// Adds later samples of the same cells. Frees the memory of `later` step by step. Precondition: the samples of
  /// `later` come after those of this object.
  void merge(CellStats later);
};

}  // namespace poesy::sensitivity
