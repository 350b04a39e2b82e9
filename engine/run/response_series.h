#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/stats/chebyshev_series.h"

namespace poesy {

/// Series of all responses of a model in one error, at one pose. Responses with a sign are smooth functions of the
/// error, so each of them is a series. A response without a sign is the root of a smooth function:
///
/// - of the sum of the squares of its components, if these are signed responses and it is their norm;
/// - otherwise of its own square, divided by the square of the error if the response is 0 without the error.
class ResponseSeries {
 public:
  static constexpr std::size_t kNodes = ChebyshevSeries::kNodes;  ///< solves from which the series are formed
  static constexpr std::size_t kChecks = 8;                       ///< further solves that certify the series
  static constexpr std::size_t kSolves = kNodes + kChecks;        ///< all solves for one pose and error

  /// Copies what it needs of the model.
  explicit ResponseSeries(const Model& model);

  /// The errors at which the model must be solved: the nodes over +-range, then the checks. The first check is 0, and
  /// the others are multiples of the golden ratio, which lie evenly between the nodes.
  static std::array<double, kSolves> errors(double range);

  /// Forms the series from the responses [R x kSolves] at errors(range). Returns false if a series has not converged,
  /// or differs from a response at a check by more than 1e-14 of its largest magnitude at the nodes and more than its
  /// rounding (Model::rounding()). The series must not be evaluated then.
  bool form(double range, std::span<const double> solved);

  /// Computes the responses [R x B] at these errors [B]. Adds to `left` the indices of errors that must be solved
  /// instead: those beyond the range, and those at which the root of a series is not precise.
  void evaluate(std::span<const double> errors, std::span<double> responses, std::vector<std::size_t>& left);

 private:
  enum class Form { itself, norm, root, root_over_error };

  struct Row {
    Form form = Form::itself;
    ChebyshevSeries series = {};
    double precise = 0.0;   ///< permitted error of the response
    double rounding = 0.0;  ///< error of the series by rounding, if its root is the response
  };

  bool form_row(std::size_t r, std::span<const double> solved);
  bool is_norm(std::size_t r, std::span<const double> solved) const;
  bool is_certified(std::span<const double> solved);
  void take_norm(std::size_t r, std::span<double> responses) const;
  void take_root(const Row& row, std::span<double> values);

  std::vector<Response> responses_;
  std::vector<double> least_;  ///< [R] rounding of each response
  double range_ = 0.0;
  std::vector<Row> rows_;              ///< [R] series of each response
  std::vector<double> x_;              ///< [B] errors over the range
  std::vector<std::uint8_t> is_left_;  ///< [B] 1 where a root is not precise, or the error is beyond the range
};

}  // namespace poesy
