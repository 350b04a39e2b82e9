#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/value_limit.h"

namespace poesy {

/// The distribution of an error of any shape, from its quantile function.
class ErrorRange {
 public:
  /// The number of cells of equal probability into which the quantiles divide the distribution.
  static constexpr std::size_t kCells = 1024;

  /// [kCells + 1] The uniforms, ascending, at which the constructor needs the error's quantile function.
  static std::vector<double> grid();

  /// quantiles: [kCells + 1] ascending. centre: the mean, about which the error grows.
  ErrorRange(std::vector<double> quantiles, double centre);

  /// The share of the errors below e. Linear within a cell.
  double below(double e) const;
  /// The same for an error that is `growth` times as large about its centre.
  double below(double e, double growth) const { return below(centre_ + (e - centre_) / growth); }
  double length() const {
    return quantiles_.back() - quantiles_.front();
  }  ///< The difference of the largest and the smallest value.

 private:
  std::vector<double> quantiles_;
  double centre_;
};

/// A limit on the norm of a vector at one pose, |offset + slope e|, or on the value of a vector with one component.
struct LinearLimit {
  std::size_t rows;            ///< components of the vector
  ValueLimit limit;            ///< of the norm; if it is not on the magnitude, of the one component
  std::vector<double> offset;  ///< [rows]
  std::vector<double> slope;   ///< [rows x P] derivatives by the errors, SI
};

/// The same limit with as few rows as give the same norm, to a millionth of the largest.
LinearLimit with_fewest_rows(const LinearLimit& limit);

/// Judges machines by limits that are linear in the errors. For each error it also finds the range in which the machine
/// is good while its other errors stay as they are. The range is an interval, because each limit is a convex set of
/// errors.
class LinearLimits {
 public:
  /// For P errors; `limits` has the limits at all poses.
  LinearLimits(std::size_t errors, std::vector<LinearLimit> limits);

  /// The results of B machines.
  struct Machines {
    std::vector<std::uint8_t> rejected;  ///< [B] 1 if a limit is broken
    std::vector<double>
        low;  ///< [P x B] lower end of the range in which the machine is good; above `high` if there is none
    std::vector<double> high;  ///< [P x B] upper end of the range
  };

  /// errors: [P x B] SI, row-major. reach: [P] the largest change of an error: its range is computed only within this
  /// distance of the error's value, and not at all if it is 0.
  Machines machines(std::span<const double> errors, std::span<const double> reach) const;

 private:
  /// [rows x B] The vector of each machine.
  std::vector<double> values_of(const LinearLimit& limit, std::span<const double> errors) const;
  void add_limit(const LinearLimit& limit, std::span<const double> errors, std::span<const double> reach,
                 Machines& found) const;
  void add_ends(const LinearLimit& limit, std::span<const double> errors, std::span<const double> reach,
                Machines& found) const;

  std::size_t errors_;
  std::vector<LinearLimit> limits_;
};

}  // namespace poesy
