#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/archive.h"

namespace poesy {

/// How K numbers of each machine follow its P errors to first order, by least squares from machines that were solved
/// anyway. Errors are standardised, x = (e - mean) / sigma, so a slope is what one standard deviation of the error
/// does.
struct LinearFit {
  std::size_t errors = 0;              ///< P
  std::uint64_t machines = 0;          ///< behind the fit
  std::vector<double> offset;          ///< [K] the number of a machine whose errors have their means
  std::vector<double> slope;           ///< [K x P] by one standard deviation of each error
  std::vector<double> slope_variance;  ///< [K x P] of the slope's estimate, if the rest depends on no error
  std::vector<double> rest;            ///< [K] variance of what is not linear
  std::vector<double> products;        ///< [P x P] mean of x_p x_q over the machines

  std::size_t rows() const { return offset.size(); }  ///< K.
};

/// Sums over machines for a LinearFit, in one pass and mergeable.
class LinearFitSums {
 public:
  LinearFitSums(std::size_t errors, std::size_t rows);  ///< Of no machines. P errors, K numbers.

  /// Adds B machines. errors: [P x B] standardised. numbers: [K x B]. counts: [B] 1 where the machine counts, and 0
  /// where it does not; its numbers are then not looked at. Precondition: those that count are finite.
  void add(std::span<const double> errors, std::span<const double> numbers, std::span<const std::uint8_t> counts);
  /// Adds what the other one added. Merging in the same order gives the same bits. Precondition: the same P and K.
  void merge(const LinearFitSums& later);

  std::uint64_t machines() const { return machines_; }  ///< That count.

  /// None below twice as many machines as errors and the offset: fewer leave too little to tell what is not linear.
  std::optional<LinearFit> fit() const;

  void state(Archive& archive);  ///< Every bit of the sums.

 private:
  void add_machine(std::span<const double> x, std::span<const double> numbers);
  void move_shift(std::size_t row, double shift);

  std::size_t errors_;
  std::uint64_t machines_ = 0;
  std::vector<double> x_;   ///< [P] sums of x
  std::vector<double> xx_;  ///< [P x P] of x_p x_q, q <= p
  /// [K] the first machine's numbers: near enough to all that sums of differences to them do not cancel.
  std::vector<double> shift_;
  std::vector<double> y_;   ///< [K] of y - shift
  std::vector<double> yy_;  ///< [K] of its square
  std::vector<double> xy_;  ///< [K x P] of x (y - shift)
};

}  // namespace poesy
