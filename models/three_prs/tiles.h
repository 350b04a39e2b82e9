#pragma once

#include <algorithm>
#include <vector>

#include "engine/base/contract.h"
#include "engine/model/model.h"
#include "models/three_prs/kernels.h"

namespace poesy::three_prs {

/// Cuts blocks of samples into tiles of at most kTile samples. A tile whose number of samples is not a multiple of
/// kMostLanes is copied to padded rows.
class Tiles {
 public:
  /// Calls work(tile) for each tile of a block. Tile::details is null if the caller does not want the swings of the
  /// rods.
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
  static Tile direct(const SampleBlock& samples, const OutcomeBlock& outcomes, std::size_t first) {
    POESY_EXPECTS(samples.values.size() == samples.varied.size() * samples.count);
    POESY_EXPECTS(outcomes.responses.size() == kResponseRows * samples.count);
    POESY_EXPECTS(outcomes.details.empty() || outcomes.details.size() == kDetailRows * samples.count);
    return {std::min(kTile, samples.count - first),
            samples.values.data() + first,
            samples.count,
            outcomes.responses.data() + first,
            outcomes.details.empty() ? nullptr : outcomes.details.data() + first,
            samples.count,
            outcomes.status.data() + first,
            outcomes.iterations.data() + first};
  }

  /// Copies a tile to padded rows. The unused lanes behind the last sample are copies of this sample, so that these
  /// lanes need no more iterations than the sample does.
  void stage(const SampleBlock& samples, Tile& tile) {
    POESY_EXPECTS(samples.varied.size() <= kFactors);
    for (std::size_t v = 0; v < samples.varied.size(); ++v) {
      const double* from = tile.values + v * tile.values_stride;
      double* to = values_.data() + v * kTile;
      std::copy_n(from, tile.count, to);
      std::fill(to + tile.count, to + (tile.count / kMostLanes + 1) * kMostLanes, from[tile.count - 1]);
    }
    tile.values = values_.data();
    tile.values_stride = kTile;
    tile.responses = outcomes_.data();
    if (tile.details != nullptr) tile.details = outcomes_.data() + kResponseRows * kTile;
    tile.outcomes_stride = kTile;
  }

  static void hand_back(const OutcomeBlock& outcomes, const Tile& tile, std::size_t first, std::size_t count) {
    const auto copy = [&](const double* from, std::size_t rows, std::span<double> to) {
      for (std::size_t r = 0; r < rows; ++r) {
        std::copy_n(from + r * kTile, tile.count, to.data() + r * count + first);
      }
    };
    copy(tile.responses, kResponseRows, outcomes.responses);
    if (tile.details != nullptr) copy(tile.details, kDetailRows, outcomes.details);
  }

  std::vector<double> values_ = std::vector<double>(kFactors * kTile);
  std::vector<double> outcomes_ = std::vector<double>((kResponseRows + kDetailRows) * kTile);
};

}  // namespace poesy::three_prs
