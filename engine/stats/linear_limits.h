#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/value_limit.h"

namespace poesy {

/// The cumulative distribution of an error, from its quantile function.
class ErrorRange {
 public:
  /// The number of cells of equal probability into which the quantiles divide the distribution.
  static constexpr std::size_t kCells = 1024;

  /// [kCells + 1] The shares in (0, 1), ascending, at which the constructor needs the error's quantile function.
  static std::vector<double> grid();

  /// quantiles: [kCells + 1] the values of the quantile function at grid(), ascending. centre: the mean of the error.
  ErrorRange(std::vector<double> quantiles, double centre);

  /// The share of the errors that are below the value e, interpolated linearly within a cell.
  double below(double e) const;
  /// The share of the errors that are below the value e, if the distances of all errors from the centre grow by the
  /// factor `growth`.
  double below(double e, double growth) const { return below(centre_ + (e - centre_) / growth); }
  /// The distance between the two outermost quantiles, at the ends of grid().
  double length() const { return quantiles_.back() - quantiles_.front(); }

 private:
  std::vector<double> quantiles_;
  double centre_;
};

/// A limit at one pose on a vector offset + slope e, which is linear in the errors e. The limit is on the norm of the
/// vector, or on the component itself if the vector has only one.
struct LinearLimit {
  std::size_t rows;  ///< number of components of the vector
  /// A limit on magnitudes applies to the norm of the vector; any other limit applies to its only component.
  ValueLimit limit;
  std::vector<double> offset;  ///< [components] the vector for zero errors, SI
  std::vector<double> slope;   ///< [components x errors] derivatives by the errors, SI
};

/// An equivalent limit on a vector with as few components as possible: the vector is rotated, and components below a
/// millionth of the largest are dropped.
LinearLimit with_fewest_rows(const LinearLimit& limit);

/// Predicts which machines are good (keep all limits), for limits on vectors that are linear in the errors. For each
/// error of a machine it also finds the range in which the machine is good if its other errors do not change. The range
/// is an interval, because the errors that keep a limit form a convex set.
class LinearLimits {
 public:
  /// errors: the number of errors. limits: the limits at all poses.
  LinearLimits(std::size_t errors, std::vector<LinearLimit> limits);

  /// The results of several machines.
  struct Machines {
    std::vector<std::uint8_t> rejected;  ///< [machines] 1 if a limit is broken
    /// [errors x machines] Lower end of the range in which the machine is good; above `high` if the range is empty.
    std::vector<double> low;
    std::vector<double> high;  ///< [errors x machines] upper end of the range in which the machine is good
  };

  /// Judges machines. errors: [errors x machines] SI, row-major. reach: [errors] the largest change of each error. The
  /// range of an error is needed only within this distance of its value, and is not computed if the distance is 0.
  Machines machines(std::span<const double> errors, std::span<const double> reach) const;

 private:
  /// [rows x machines] The vector of each machine.
  std::vector<double> values_of(const LinearLimit& limit, std::span<const double> errors) const;
  void add_limit(const LinearLimit& limit, std::span<const double> errors, std::span<const double> reach,
                 Machines& found) const;
  void add_ends(const LinearLimit& limit, std::span<const double> errors, std::span<const double> reach,
                Machines& found) const;

  std::size_t errors_;
  std::vector<LinearLimit> limits_;
};

}  // namespace poesy
