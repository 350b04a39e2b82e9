#include "models/three_prs/tiles.h"

#include "engine/base/contract.h"

namespace poesy::three_prs {

Tile Tiles::direct(const SampleBlock& samples, const OutcomeBlock& outcomes, std::size_t first) {
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

/// Lanes behind the last sample repeat it, so that they end when it does.
void Tiles::stage(const SampleBlock& samples, Tile& tile) {
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

void Tiles::hand_back(const OutcomeBlock& outcomes, const Tile& tile, std::size_t first, std::size_t count) {
  const auto copy = [&](const double* from, std::size_t rows, std::span<double> to) {
    for (std::size_t r = 0; r < rows; ++r) {
      std::copy_n(from + r * kTile, tile.count, to.data() + r * count + first);
    }
  };
  copy(tile.responses, kResponseRows, outcomes.responses);
  if (tile.details != nullptr) copy(tile.details, kDetailRows, outcomes.details);
}

}  // namespace poesy::three_prs
