#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/archive.h"

namespace poesy {

/// A linear fit of K numbers of each machine to its P errors, by least squares from machines that were solved anyway.
/// Errors are standardised, x = (e - mean) / sigma, so a slope is the effect of one standard deviation.
struct LinearFit {
  std::size_t errors = 0;      ///< P
  std::uint64_t machines = 0;  ///< number of machines
  std::vector<double> offset;  ///< [K] numbers of a machine whose errors have their means
  std::vector<double> slope;   ///< [K x P] effect of one standard deviation of each error
  std::vector<double>
      slope_variance;        ///< [K x P] variance of the estimated slope, if the residuals do not depend on the errors
  std::vector<double> rest;  ///< [K] variance of the residuals
  std::vector<double> products;  ///< [P x P] mean of x_p x_q over the machines

  std::size_t rows() const { return offset.size(); }  ///< The number of fitted numbers, K.
};

/// The rows of fits one after the other, for errors that have other values in each fit. Machines and products are those
/// of the first. Precondition: there is one, and all have the same errors.
LinearFit joined(std::span<const LinearFit> fits);

/// Sums over machines for a LinearFit, in one pass and mergeable.
class LinearFitSums {
 public:
  LinearFitSums(std::size_t errors, std::size_t rows);  ///< Empty sums for P errors and K numbers.

  /// Adds B machines. errors: [P x B] standardised. numbers: [K x B]; they must be finite for machines that count.
  /// counts: [B] 1 if the machine counts; 0 if not, and its numbers are ignored.
  void add(std::span<const double> errors, std::span<const double> numbers, std::span<const std::uint8_t> counts);
  /// Adds the sums of later machines. Merging in the same order gives the same bits. Precondition: the same P and K.
  void merge(const LinearFitSums& later);

  std::uint64_t machines() const { return machines_; }  ///< The number of machines that count.

  /// The fit; none with fewer than twice as many machines as errors plus one, which say too little about residuals.
  std::optional<LinearFit> fit() const;

  void state(Archive& archive);  ///< Reads or writes every bit.

 private:
  void add_machine(std::span<const double> x, std::span<const double> numbers);
  void move_shift(std::size_t row, double shift);

  std::size_t errors_;
  std::uint64_t machines_ = 0;
  std::vector<double> x_;   ///< [P] sums of x
  std::vector<double> xx_;  ///< [P x P] sums of x_p x_q, q <= p
  /// [K] The numbers of the first machine. They are near enough to all others that sums of differences do not cancel.
  std::vector<double> shift_;
  std::vector<double> y_;   ///< [K] sums of y - shift
  std::vector<double> yy_;  ///< [K] sums of (y - shift)^2
  std::vector<double> xy_;  ///< [K x P] sums of x (y - shift)
};

}  // namespace poesy
