#include "engine/kinds/what_if/tried.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/linalg/decompositions.h"

namespace poesy {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

double largest_magnitude(const TriedMachines& tried, const LimitedVector& vector) {
  double largest = 0.0;
  for (const auto& rows : tried.rows) {
    for (std::size_t k = vector.first_row; k < vector.first_row + vector.rows; ++k) {
      for (const double value : rows.row(k)) largest = std::max(largest, std::isnan(value) ? 0.0 : std::abs(value));
    }
  }
  return largest;
}

/// The limit on a vector as a ScaledLimit. The scale is half the distance between the two ends of the limit, or the
/// magnitude of its only end. If that is 0, the scale is the largest magnitude of a component, or 1.
ScaledLimit scaled_limit(const TriedMachines& tried, const LimitedVector& vector) {
  const double from = vector.limit.from();
  const double to = vector.limit.to();
  double scale = std::isinf(from) ? std::abs(to) : std::isinf(to) ? std::abs(from) : 0.5 * (to - from);
  if (!(scale > 0.0)) scale = largest_magnitude(tried, vector);
  if (!(scale > 0.0)) scale = 1.0;
  return {vector.first_row, vector.rows, scale, from / scale, to / scale};
}

/// The rows of one limited vector, as a matrix. rows: the rows of all limited vectors.
template <class Rows>
Eigen::Map<const RowMajor> part_of(const Rows& rows, const ScaledLimit& limit) {
  const auto columns = static_cast<Eigen::Index>(rows.row(limit.first).size());
  return {rows.row(limit.first).data(), static_cast<Eigen::Index>(limit.rows), columns};
}

/// The directions, in the space of a limited vector, in which errors change this vector at one pose.
struct Directions {
  linalg::Matrix axes;  ///< [rows x rows] orthonormal columns; the direction with the largest effect is the last
  std::size_t count;    ///< number of directions with an effect of more than a millionth of the largest
};

Directions directions(const WhatIfMachines::Slopes& slopes, const ScaledLimit& limit, const Plan& plan) {
  // Directions::count includes a direction if its squared effect is more than this share of the largest squared effect.
  constexpr double kLeast = 1e-12;
  linalg::Matrix effects = part_of(slopes, limit);
  for (std::size_t p = 0; p < plan.factors().size(); ++p) {
    effects.col(static_cast<Eigen::Index>(p)) *= plan.distributions()[p].standard_deviation();
  }
  effects = effects.unaryExpr([](double effect) { return std::isnan(effect) ? 0.0 : effect; });
  auto [squares, axes] = linalg::eigen_decomposition(effects * effects.transpose());
  const double largest = squares[squares.size() - 1];
  const auto count = std::ranges::count_if(squares, [&](double square) { return square > kLeast * largest; });
  return {std::move(axes), static_cast<std::size_t>(count)};
}

/// Replaces limited vectors by vectors with fewer components and the same norms. The first new components are along the
/// directions in which errors change the vector. The last one is the length of the remaining part, which errors do not
/// change to first order.
struct FewerRows {
  std::vector<std::vector<Directions>> at;  ///< [limits][poses] directions at each pose
  std::vector<std::size_t> counts;  ///< [limits] largest number of directions at a pose; 0 if all components are kept

  FewerRows(const TriedMachines& tried, const Plan& plan) {
    for (const ScaledLimit& limit : tried.solved_limits) {
      std::vector<Directions>& each = at.emplace_back();
      std::size_t most = 0;
      for (const auto& slopes : tried.slopes) {
        each.push_back(directions(slopes, limit, plan));
        most = std::max(most, each.back().count);
      }
      counts.push_back(most + 1 < limit.rows ? most : 0);
    }
  }

  /// The limits on the vectors with fewer components.
  std::vector<ScaledLimit> limits(std::span<const ScaledLimit> old) const {
    std::vector<ScaledLimit> list(old.begin(), old.end());
    std::size_t first = 0;
    for (std::size_t l = 0; l < list.size(); ++l) {
      list[l].first = first;
      if (counts[l] > 0) list[l].rows = counts[l] + 1;
      first += list[l].rows;
    }
    return list;
  }

  /// The vectors of an array at pose k, or their derivatives, with fewer components. length: true for vectors, whose
  /// last component is the length of the remaining part; false for derivatives, whose last component is 0.
  template <class Rows>
  Rows turned(const Rows& old, std::size_t k, const TriedMachines& tried, bool length) const {
    const ScaledLimit& end = tried.limits.back();
    Rows rows({end.first + end.rows, old.row(0).size()}, 0.0);
    for (std::size_t l = 0; l < tried.limits.size(); ++l) {
      const Eigen::Map<const RowMajor> from = part_of(old, tried.solved_limits[l]);
      Eigen::Map<RowMajor> to(rows.row(tried.limits[l].first).data(), static_cast<Eigen::Index>(tried.limits[l].rows),
                              from.cols());
      const auto count = static_cast<Eigen::Index>(counts[l]);
      if (count == 0) {
        to = from;
        continue;
      }
      to.topRows(count) = at[l][k].axes.rightCols(count).transpose() * from;
      if (length) to.row(count) = (at[l][k].axes.leftCols(from.rows() - count).transpose() * from).colwise().norm();
    }
    return rows;
  }
};

}  // namespace

std::vector<double> badness(const WhatIfMachines::Rows& rows, std::span<const ScaledLimit> limits) {
  std::vector<double> worst(rows.length<axis::Sample>(), -std::numeric_limits<double>::infinity());
  for (const ScaledLimit& limit : limits) {
    for (std::size_t b = 0; b < worst.size(); ++b) {
      double value = rows(limit.first, b);
      if (limit.rows > 1) {
        double square = 0.0;
        for (std::size_t k = limit.first; k < limit.first + limit.rows; ++k) square += rows(k, b) * rows(k, b);
        value = std::sqrt(square);
      }
      value /= limit.scale;
      const double beyond = std::max(limit.low - value, value - limit.high);
      worst[b] = std::isnan(beyond) ? std::numeric_limits<double>::infinity() : std::max(worst[b], beyond);
    }
  }
  return worst;
}

WhatIfMachines::Rows changed(const TriedMachines& tried, const WhatIfMachines& machines, std::size_t k,
                             std::span<const double> sizes) {
  WhatIfMachines::Rows rows = tried.rows[k];
  for (std::size_t p = 0; p < sizes.size(); ++p) {
    if (sizes[p] == 1.0) continue;
    const std::span<const double> deviation = machines.deviations().row(p);
    for (std::size_t row = 0; row < rows.length<axis::VectorRow>(); ++row) {
      const double change = (sizes[p] - 1.0) * tried.slopes[k](row, p);
      const std::span<double> values = rows.row(row);
      for (std::size_t b = 0; b < values.size(); ++b) values[b] += change * deviation[b];
    }
  }
  return rows;
}

TriedMachines tried_machines(std::vector<std::size_t> poses, const Plan& plan, const LimitedVectors& vectors,
                             WhatIfMachines& machines) {
  TriedMachines tried{std::move(poses), {}, {}, {}, {}};
  const std::vector<double> as_they_are(plan.factors().size(), 1.0);
  for (const std::size_t m : tried.poses) {
    tried.rows.push_back(machines.solve(PoseIndex(m), as_they_are));
    tried.slopes.push_back(machines.slopes(PoseIndex(m)));
  }
  for (const LimitedVector& vector : vectors.each()) tried.solved_limits.push_back(scaled_limit(tried, vector));
  const FewerRows fewer(tried, plan);
  tried.limits = fewer.limits(tried.solved_limits);
  for (std::size_t k = 0; k < tried.poses.size(); ++k) {
    tried.rows[k] = fewer.turned(tried.rows[k], k, tried, true);
    tried.slopes[k] = fewer.turned(tried.slopes[k], k, tried, false);
  }
  return tried;
}

}  // namespace poesy
