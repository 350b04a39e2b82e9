#pragma once

#include <algorithm>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/kernel_data.h"

namespace poesy::three_prs {

/// Cuts blocks into tiles. A tile whose rows do not end at a multiple of kMostLanes is worked on in rows of its own.
class Tiles {
 public:
  /// Calls work(tile) for each tile of a block. Details are null where the block asks for none.
  template <class Work>
  void for_each(const SampleBlock& samples, const OutcomeBlock& outcomes, Work work) {
    for (std::size_t first = 0; first < samples.count; first += kTile) {
      Tile tile = direct(samples, outcomes, first);
      const bool fits = tile.count % kMostLanes == 0;
      if (!fits) stage(samples, tile);
      work(tile);
      if (!fits) hand_back(outcomes, tile, first, samples.count);
    }
  }

 private:
  static Tile direct(const SampleBlock& samples, const OutcomeBlock& outcomes, std::size_t first);
  void stage(const SampleBlock& samples, Tile& tile);
  static void hand_back(const OutcomeBlock& outcomes, const Tile& tile, std::size_t first, std::size_t count);

  std::vector<double> values_ = std::vector<double>(kFactors * kTile);
  std::vector<double> outcomes_ = std::vector<double>((kResponseRows + kDetailRows) * kTile);
};

}  // namespace poesy::three_prs
