#include "engine/random/weighted_points.h"

#include <boost/math/quadrature/gauss.hpp>
#include <stdexcept>

namespace poesy {
namespace {

using Gauss = boost::math::quadrature::gauss<double, 10>;
static_assert(kExactDegree == 2 * 10 - 1);

/// Adds to `found` the weighted points of a piece [low, high] of the error's range. share: the part of all errors that
/// is in this piece. slope: how much the density grows over half of the piece, relative to its mean; between -1 and 1.
void add_piece(double low, double high, double share, double slope, WeightedPoints& found) {
  const double middle = 0.5 * (low + high);
  const double half = 0.5 * (high - low);
  const auto add = [&](double place, double weight) {
    found.points.push_back(middle + half * place);
    found.weights.push_back(0.5 * weight * share * (1.0 + slope * place));
  };
  for (std::size_t k = 0; k < Gauss::abscissa().size(); ++k) {  // Boost lists only the positive abscissas
    add(-Gauss::abscissa()[k], Gauss::weights()[k]);
    add(Gauss::abscissa()[k], Gauss::weights()[k]);
  }
}

void add_parts(const SmoothedValues& parts, WeightedPoints& found) {
  for (std::size_t k = 1; k < parts.knots().size(); ++k) {
    const double share = parts.shares()[k] - parts.shares()[k - 1];
    if (share > 0.0) add_piece(parts.knots()[k - 1], parts.knots()[k], share, 0.0, found);
  }
}

}  // namespace

WeightedPoints weighted_points(const Distribution& distribution) {
  using enum Distribution::Shape;
  const double w = distribution.half_width();
  const double c = distribution.centre();
  WeightedPoints found;
  switch (distribution.shape()) {
    case uniform:
      add_piece(c - w, c + w, 1.0, 0.0, found);
      return found;
    case triangular:
      add_piece(c - w, c, 0.5, 1.0, found);
      add_piece(c, c + w, 0.5, -1.0, found);
      return found;
    case measured:
      add_parts(*distribution.parts(), found);
      return found;
    case normal:
    case truncated_normal:
    case given:
      break;
  }
  throw std::logic_error("weighted points of a density that is not linear in pieces");
}

}  // namespace poesy
