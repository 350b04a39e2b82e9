#pragma once

// This header belongs to kernels.cpp alone, which is compiled once for each instruction set.

#include <algorithm>
#include <utility>

#include "models/assembly/kernel_report.h"

namespace poesy::assembly {

/// Computes the first-order outcomes of batches of samples. The coordinates are those of KernelMap: twists of bodies,
/// stresses and joint displacements.
template <class T>
class KernelMapper {
 public:
  /// Value of `rows` that means that all coordinates are wanted.
  static constexpr std::size_t kAllRows = static_cast<std::size_t>(-1);

  /// Both arguments must outlive this object. rows: number of coordinates to compute, beginning with the first.
  KernelMapper(const KernelProblem& problem, const KernelBlock& block, std::size_t rows)
      : problem_(problem),
        map_(problem.map),
        block_(block),
        coordinates_(std::min(rows, first_joint() + problem.joints)) {}

  /// The coordinates of the samples from `at` on, one sample in each lane. They are valid until the next call.
  const T* coordinates(std::size_t at) {
    for (std::size_t row = 0; row < coordinates_.size(); row += kRows) {
      multiply_some(row, at, std::make_index_sequence<kRows>());
    }
    return coordinates_.data();
  }

  /// Computes the limbs' wrenches [6 x limbs] from coordinates.
  void wrenches(const T* coordinates, T* made) const {
    const T* stress = coordinates + first_stress();
    const double* of = map_.wrenches.data();
    for (std::size_t row = 0; row < map_.by_load.size(); ++row, of += map_.stresses) {
      T sum(map_.by_load[row]);
      for (std::size_t k = 0; k < map_.stresses; ++k) sum = madd(T(of[k]), stress[k], sum);
      made[row] = sum;
    }
  }

  /// Index of the first stress (coordinate of the wrenches by which limbs load each other) among the coordinates of
  /// KernelMap.
  std::size_t first_stress() const { return 6 * (problem_.bodies.size() - 1); }
  /// Index of the first joint displacement among the coordinates of KernelMap.
  std::size_t first_joint() const { return first_stress() + map_.stresses; }

 private:
  static constexpr std::size_t kRows = KernelMap::kRows;

  /// Computes kRows coordinates from index `row` on, or the remaining ones if there are fewer.
  template <std::size_t... n>
  void multiply_some(std::size_t row, std::size_t at, std::index_sequence<n...>) {
    const std::size_t count = std::min(kRows, coordinates_.size() - row);
    ((count == n + 1 ? multiply<n + 1>(row, at) : void()), ...);
  }

  /// Computes several coordinates together, so that each varied value is read only once for all of them.
  template <std::size_t rows>
  void multiply(std::size_t row, std::size_t at) {
    T sum[rows];
    for (std::size_t k = 0; k < rows; ++k) sum[k] = T(map_.offset[row + k]);
    const double* of = map_.matrix.data() + row * map_.entries;
    const double* value = block_.values + at;
    for (std::size_t v = 0; v < map_.entries; ++v, of += kRows, value += block_.stride) {
      const T x = T(map_.units[v]) * T::load(value);
      for (std::size_t k = 0; k < rows; ++k) sum[k] = madd(T(of[k]), x, sum[k]);
    }
    for (std::size_t k = 0; k < rows; ++k) coordinates_[row + k] = sum[k];
  }

  const KernelProblem& problem_;
  const KernelMap& map_;
  const KernelBlock& block_;
  std::vector<T> coordinates_;
};

/// Computes the displacement of a point by a twist, to first order.
template <class T>
void displace(const T* twist, const double* point, T* moved) {
  const T p[3] = {T(point[0]), T(point[1]), T(point[2])};
  for (int k = 0; k < 3; ++k) moved[k] = twist[3 + k];
  simd::add_cross(twist, p, moved);
}

/// Computes a block of samples to first order, with batches of T.
template <class T>
void map_assemblies(const KernelProblem& problem, const KernelBlock& block) {
  KernelMapper<T> mapper(problem, block, 6 * (problem.bodies.size() - 1) + problem.map.stresses);
  KernelReporter<T> reporter(problem, block, 0.0);
  LaneOutcome<T> outcome(problem);
  for (std::size_t k = 0; k < problem.report.marks; ++k) {
    outcome.marks[k] = in_lanes<T>(problem.report.nominal_marks[k]);
  }
  for (std::size_t at = 0; at < block.count; at += T::kLanes) {
    const T* coordinates = mapper.coordinates(at);
    T sum(0.0);
    for (std::size_t k = 0; k < mapper.first_stress(); ++k) sum = sum + abs(coordinates[k]);
    put_ends(~bits(sum < T(1e300)), 0, T::kLanes, block.ends + at);
    for (std::size_t b = 1; b < problem.bodies.size(); ++b) {
      const T* twist = coordinates + 6 * (b - 1);
      displace(twist, problem.bodies[b].p, outcome.bodies[b].moved);
      for (int k = 0; k < 3; ++k) outcome.bodies[b].theta[k] = twist[k];
    }
    if (problem.report.has_tool) {
      double tool[3];
      for (int k = 0; k < 3; ++k) tool[k] = problem.bodies[1].p[k] + problem.report.arm[k];
      displace(coordinates, tool, outcome.tool);
    }
    mapper.wrenches(coordinates, outcome.wrenches.data());
    reporter.write(outcome, at);
  }
}

}  // namespace poesy::assembly
