#pragma once

/// The cost of a part as a function of its tolerance. The laws are those of the literature on tolerance allocation
/// (Chase, Greenwood, Loosli and Hauglund 1990, Manuf. Rev. 3, 49-59).
namespace poesy {

/// How the effects of tolerances on a response add up under a limit L. Each tolerance T has an effect a T, with a
/// factor a of its own.
enum class Stacking {
  root_sum_square,  ///< sum of a^2 T^2 <= L^2: the limit is linear in T^2
  worst_case        ///< sum of |a| T <= L: the limit is linear in T
};

/// The size of a tolerance T: T^2 for Stacking::root_sum_square, T for Stacking::worst_case. Limits are linear in
/// sizes. Precondition: T >= 0.
double size_of(double tolerance, Stacking stacking);
/// The tolerance with this size, the inverse of size_of(). Precondition: size >= 0.
double tolerance_of(double size, Stacking stacking);

/// A cost and its derivatives with respect to the size (T^2 or T, see size_of()).
struct CostCurve {
  double value;      ///< cost, in the unit of the user's costs
  double slope;      ///< first derivative with respect to the size, <= 0
  double curvature;  ///< second derivative with respect to the size, >= 0
};

/// The cost of a part as a function of its tolerance T. Each law is convex and non-increasing in T and in T^2, so
/// finding the least cost under limits is a convex optimisation problem. Laws whose coefficient b is 0 are constant.
class CostLaw {
 public:
  /// The law with the same cost for every tolerance.
  static CostLaw constant(double cost);
  /// The law fixed + b / T. Precondition: b >= 0.
  static CostLaw reciprocal(double fixed, double b);
  /// The law fixed + b / T^power. Preconditions: b >= 0, power > 0.
  static CostLaw reciprocal_power(double fixed, double b, double power);
  /// The law fixed + b exp(-T / decay). decay: in the unit of T. Preconditions: b >= 0, decay > 0.
  static CostLaw exponential(double fixed, double b, double decay);

  /// The cost of a tolerance T >= 0; infinite for T = 0 if the law divides by T.
  double at(double tolerance) const;
  /// The cost of the tolerance with this size, and its derivatives with respect to the size. Precondition: size > 0.
  CostCurve curve(double size, Stacking stacking) const;
  /// The size >= 0 at which cost + price x size is least; infinite for price 0. Preconditions: price >= 0, the law is
  /// not constant.
  double cheapest_size(double price, Stacking stacking) const;
  /// The term `fixed` of the law, which does not depend on the tolerance.
  double fixed() const { return fixed_; }
  bool is_constant() const { return form_ == Form::constant; }  ///< Whether all tolerances cost the same.

 private:
  enum class Form { constant, power, exponential };
  CostLaw(Form form, double fixed, double b, double shape);
  /// The exponent q with which the cost falls as 1 / size^q, for a law of the form `power`.
  double exponent(Stacking stacking) const;

  Form form_;
  double fixed_;
  double b_;
  double shape_;  ///< `power` of reciprocal_power(), or `decay` of exponential()
};

}  // namespace poesy
