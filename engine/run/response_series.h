#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/stats/chebyshev_series.h"

namespace poesy {

/// Chebyshev series that give all responses of a model as functions of one error, at one pose. A response with a sign
/// is a smooth function of the error, and has a series of its own. A response without a sign is computed from smooth
/// functions:
///
/// - as the norm of its components, if these have a sign and the response is their norm in all solves;
/// - otherwise as the root of its square, which has a series. If the response is 0 without the error, the series gives
///   its square divided by the square of the error.
class ResponseSeries {
 public:
  static constexpr std::size_t kNodes = ChebyshevSeries::kNodes;  ///< solves from which the series are formed
  static constexpr std::size_t kChecks = 8;                       ///< further solves that certify the series
  static constexpr std::size_t kSolves = kNodes + kChecks;        ///< all solves for one pose and error

  /// The model need not outlive this object.
  explicit ResponseSeries(const Model& model);

  /// The errors at which the model must be solved: the nodes over +-range, then the checks. The first check is 0. The
  /// others, from the fractional parts of multiples of the golden ratio, are spread evenly over the range.
  static std::array<double, kSolves> errors(double range);

  /// Forms the series from the responses [responses x kSolves] at errors(range). Returns false if a series has not
  /// converged, or if at a check it differs from its response by more than 1e-14 of the response's largest magnitude at
  /// the nodes and by more than the response's Model::rounding(). Checks at which the root of a series is not precise
  /// do not count. After false, evaluate() must not be called.
  bool form(double range, std::span<const double> solved);

  /// Computes the responses [responses x errors] at these errors (SI). Adds to `left` the indices of the errors that
  /// must be solved instead: those beyond the range, and those at which the root of a series is not precise.
  void evaluate(std::span<const double> errors, std::span<double> responses, std::vector<std::size_t>& left);

 private:
  enum class Form { itself, norm, root, root_over_error };

  struct Row {
    Form form = Form::itself;
    ChebyshevSeries series = {};
    double precise = 0.0;   ///< permitted error of the response, SI
    double rounding = 0.0;  ///< rounding error of the series, if the response is the root of the series
  };

  bool form_row(std::size_t r, std::span<const double> solved);
  bool is_norm(std::size_t r, std::span<const double> solved) const;
  bool is_certified(std::span<const double> solved);
  void take_norm(std::size_t r, std::span<double> responses) const;
  void take_root(const Row& row, std::span<double> values);

  std::vector<Response> responses_;
  std::vector<double> least_;  ///< [responses] Model::rounding() of each response, SI
  double range_ = 0.0;
  std::vector<Row> rows_;              ///< [responses] series of each response
  std::vector<double> x_;              ///< [errors] errors of the last evaluate(), divided by the range
  std::vector<std::uint8_t> is_left_;  ///< [errors] 1 if beyond the range, or if a root is not precise; else 0
};

}  // namespace poesy
