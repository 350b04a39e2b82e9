#pragma once

#include "models/simd/rotation.h"
#include "models/three_prs/kernels.h"

namespace poesy::three_prs {

/// Computes the first `rows` results of the map (components of vectors, then swings) for a batch of samples of a tile,
/// from sample `at` on.
template <class T, std::size_t rows>
inline void map_lanes(const FirstOrderMap& map, const Tile& tile, std::size_t at, T* sum) {
  for (std::size_t r = 0; r < rows; ++r) sum[r] = T(map.constant[r]);
  for (std::size_t v = 0; v < map.varied; ++v) {
    const T value = T::load(tile.values + v * tile.values_stride + at);
    const double* effects = map.effects + v * kMapRows;
    for (std::size_t r = 0; r < rows; ++r) sum[r] = madd(T(effects[r]), value, sum[r]);
  }
}

/// Stores the vectors and their norms. Returns the lanes in which all of them are finite.
template <class T>
inline typename T::MaskType store_responses(const T* vectors, const Tile& tile, std::size_t at) {
  T norms(0.0);
  for (std::size_t r = 0; r < kVectorRows; ++r) vectors[r].store(tile.responses + r * tile.outcomes_stride + at);
  for (std::size_t n = 0; n < 3; ++n) {
    const T norm = sqrt(simd::dot3(vectors + 3 * n, vectors + 3 * n));
    norm.store(tile.responses + (kVectorRows + n) * tile.outcomes_stride + at);
    norms = norms + norm;
  }
  return norms < T(1e300);
}

template <class T>
void map_tile(const FirstOrderMap& map, const Tile& tile) {
  for (std::size_t at = 0; at < tile.count; at += T::kLanes) {
    T sum[kMapRows];
    if (tile.details == nullptr) {
      map_lanes<T, kVectorRows>(map, tile, at, sum);
    } else {
      map_lanes<T, kMapRows>(map, tile, at, sum);
      for (std::size_t r = 0; r < kDetailRows; ++r) {
        sum[kVectorRows + r].store(tile.details + r * tile.outcomes_stride + at);
      }
    }
    const unsigned finite = bits(store_responses(sum, tile, at));
    for (std::size_t lane = 0; lane < T::kLanes && at + lane < tile.count; ++lane) {
      const bool is_finite = (finite >> lane & 1u) != 0;
      tile.status[at + lane] = is_finite ? SolveStatus::converged : SolveStatus::non_finite;
      tile.iterations[at + lane] = 1;
    }
  }
}

}  // namespace poesy::three_prs
