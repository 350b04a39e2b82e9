#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/archive.h"

namespace poesy {

/// A least-squares fit of several numbers of a machine (such as the components of a vector at each pose), each as a
/// linear function of the machine's errors. The fit uses machines that the study solves anyway. Errors are
/// standardised, x = (e - mean) / sigma, so a slope is the effect of one standard deviation.
struct LinearFit {
  std::size_t errors = 0;      ///< number of errors
  std::uint64_t machines = 0;  ///< number of machines in the fit
  std::vector<double> offset;  ///< [numbers] the fitted numbers for errors at their means
  std::vector<double> slope;   ///< [numbers x errors] effect of one standard deviation of each error
  /// [numbers x errors] variance of the estimated slope, if the residuals do not depend on the errors.
  std::vector<double> slope_variance;
  std::vector<double> rest;      ///< [numbers] variance of the residuals
  std::vector<double> products;  ///< [errors x errors] mean of x_p x_q over the machines

  std::size_t rows() const { return offset.size(); }  ///< The number of fitted numbers.
};

/// Joins several fits into one that has the fitted numbers (rows) of all. A study with new draws at each pose has one
/// fit for each pose. The number of machines and the products are those of the first fit. Precondition: there is a fit,
/// and all have the same number of errors.
LinearFit joined(std::span<const LinearFit> fits);

/// Accumulates the sums for a LinearFit over machines, in one pass. Sums of several objects can be merged.
class LinearFitSums {
 public:
  /// Empty sums. errors: number of errors. rows: number of fitted numbers.
  LinearFitSums(std::size_t errors, std::size_t rows);

  /// Adds machines. errors: [errors x machines] standardised. numbers: [numbers x machines]; they must be finite for
  /// machines with counts = 1. counts: [machines] 1 if the machine is added to the sums, 0 if it is ignored.
  void add(std::span<const double> errors, std::span<const double> numbers, std::span<const std::uint8_t> counts);
  /// Adds the sums of machines that come later. Merging in the same order gives the same bits. Precondition: `later`
  /// was made for as many errors and as many fitted numbers (rows) as this object.
  void merge(const LinearFitSums& later);

  std::uint64_t machines() const { return machines_; }  ///< The number of machines in the sums.

  /// The fit. None if there are fewer than 2 (P + 1) machines for P errors, because so few say too little about
  /// residuals; none if the equations are singular.
  std::optional<LinearFit> fit() const;

  void state(Archive& archive);  ///< Reads or writes all sums, bit for bit.

 private:
  void add_machine(std::span<const double> x, std::span<const double> numbers);
  void move_shift(std::size_t row, double shift);

  std::size_t errors_;
  std::uint64_t machines_ = 0;
  std::vector<double> x_;   ///< [errors] sums of x over the machines
  std::vector<double> xx_;  ///< [errors x errors] sums of x_p x_q over the machines, q <= p
  /// [numbers] The numbers of the first machine. The numbers of all other machines are so near to these that no digits
  /// cancel in sums of the differences.
  std::vector<double> shift_;
  std::vector<double> y_;   ///< [numbers] sums of y - shift
  std::vector<double> yy_;  ///< [numbers] sums of (y - shift)^2
  std::vector<double> xy_;  ///< [numbers x errors] sums of x (y - shift)
};

}  // namespace poesy
