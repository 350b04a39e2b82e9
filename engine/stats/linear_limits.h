#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace poesy {

/// How large an error's values are, from its quantile function, whatever its shape.
class ErrorRange {
 public:
  /// Cells of equal probability between neighbouring values of quantiles().
  static constexpr std::size_t kCells = 1024;

  /// The uniforms at which the constructor wants the error's quantile function: ascending, [kCells + 1].
  static std::vector<double> grid();

  /// quantiles: [kCells + 1] ascending. centre: about which the error grows, its mean.
  ErrorRange(std::vector<double> quantiles, double centre);

  /// The share of errors below e. Linear within a cell.
  double below(double e) const;
  /// The same of the error that is `growth` times as large about its centre.
  double below(double e, double growth) const { return below(centre_ + (e - centre_) / growth); }
  double length() const { return quantiles_.back() - quantiles_.front(); }  ///< From the smallest to the largest.

 private:
  std::vector<double> quantiles_;
  double centre_;
};

/// A limit on the norm of a vector at one pose: |offset + slope e| <= most.
struct LinearLimit {
  std::size_t rows;            ///< components of the vector
  double most;                 ///< of its norm
  std::vector<double> offset;  ///< [rows]
  std::vector<double> slope;   ///< [rows x P] by the errors, SI
};

/// The same with as few rows as make the same norm of offset and slope together, to a millionth of the largest.
LinearLimit with_fewest_rows(const LinearLimit& limit);

/// Which machines are good by limits on what is linear in the errors, and, with all other errors of a machine as they
/// are, in which range one error may be. That range is an interval, because each limit holds in a convex set of errors.
class LinearLimits {
 public:
  /// P errors; limits at all poses.
  LinearLimits(std::size_t errors, std::vector<LinearLimit> limits);

  /// What B machines come to.
  struct Machines {
    std::vector<std::uint8_t> rejected;  ///< [B] 1 where a limit is broken
    std::vector<double> low;             ///< [P x B] of the range in which the machine is good; above high: in none
    std::vector<double> high;            ///< [P x B]
  };

  /// errors: [P x B] SI, row-major. reach: [P] how far one error may move at the most: a range is told as far as it is
  /// within that of the error's own value, and not at all where that is 0.
  Machines machines(std::span<const double> errors, std::span<const double> reach) const;

 private:
  void add_limit(const LinearLimit& limit, std::span<const double> errors, std::span<const double> reach,
                 Machines& found) const;

  std::size_t errors_;
  std::vector<LinearLimit> limits_;
};

}  // namespace poesy
