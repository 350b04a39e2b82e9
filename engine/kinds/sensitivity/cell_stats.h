#pragma once

#include <cstddef>
#include <vector>

#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/stats/moments.h"

namespace poesy {

/// What the samples of consecutive cells came to, of R responses. Each response has a list of its own, so that whoever
/// is done with a response can give its memory back.
struct CellStats {
  std::vector<std::vector<Moments>> responses;  ///< [R][cells] over the samples that count
  std::vector<SolveCounts> solves;              ///< [cells]
  std::vector<FailedSamples> failed;            ///< [cells]

  /// No cells.
  CellStats() = default;
  /// Cells without samples.
  CellStats(std::size_t response_count, std::size_t cells)
      : responses(response_count, std::vector<Moments>(cells)), solves(cells), failed(cells) {}

  std::size_t size() const { return solves.size(); }  ///< Cells.
  UnitStats at(std::size_t cell) const;               ///< One cell.
  /// One cell, of samples from `first` on.
  void state(Archive& archive, std::size_t cell, std::uint64_t first);
  CellStats part(const NumberRange& cells) const;       ///< Some of them.
  void merge(std::size_t cell, const UnitStats& unit);  ///< Precondition: as for UnitStats::merge.
  /// The same cells: the samples of `later` come after those of this. Gives the memory of `later` back as it goes.
  void merge(CellStats later);
};

}  // namespace poesy
