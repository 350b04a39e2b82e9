#include "engine/optimise/price_path.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/base/contract.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kShrink = 0.1;         ///< of mu from one maximum to the next
constexpr double kLastGap = 1e-12;      ///< at the end of the path, over what tolerances can change of the cost
constexpr double kLastMu = 1e-16;       ///< over the first: below that mu is rounding
constexpr double kLastMixing = 3e-8;    ///< mu over the same: of mixes, prices cannot be told apart below it
constexpr int kNewtonSteps = 60;        ///< for one maximum
constexpr int kSearchSteps = 60;        ///< along one direction
constexpr int kRounds = 400;            ///< of maxima and limits that join
constexpr std::size_t kJoinAtOnce = 4;  ///< limits
constexpr double kWeightless = 40.0;    ///< temperatures above the best process a process has no weight

double give_of(const SizedProcess& process, double size, Stacking stacking) {
  return size > process.lo && size < process.hi ? 1.0 / process.cost.curve(size, stacking).curvature : 0.0;
}

/// What tolerances can change of the cost of a mix, as a scale.
double changeable(std::span<const SizedProcess> menu, MenuRange allowed, const PartAnswer& part) {
  double least = kInfinity;
  for (std::size_t p = allowed.first; p < allowed.last; ++p) least = std::fmin(least, menu[p].cost.fixed());
  return std::fmax(0.0, part.cost - least);
}

/// A scale for prices: what the use of a limit would be worth if all parts had an equal share of the one they matter
/// most for.
double price_scale(const SizedProblem& problem, std::span<const MenuRange> allowed) {
  const auto parts = static_cast<double>(problem.parts());
  double sum = 0.0;
  double costs = 0.0;
  for (std::size_t i = 0; i < problem.parts(); ++i) {
    const double effect = problem.largest_effect[i];
    if (effect == 0.0) continue;
    for (std::size_t p = allowed[i].first; p < allowed[i].last; ++p) {
      const SizedProcess& process = problem.menus[i][p];
      const double size = std::fmax(process.lo, std::fmin(process.hi, 1.0 / (parts * effect)));
      if (!process.single()) sum += -size * process.cost.curve(size, problem.stacking).slope;
      costs += std::abs(process.cost.at(tolerance_of(size, problem.stacking)));
    }
  }
  if (sum > 0.0 && std::isfinite(sum)) return sum;
  return costs > 0.0 && std::isfinite(costs) ? costs : 1.0;
}

/// Cholesky's factorisation of a symmetric matrix [K x K], of which the lower half is given, in place. Positive
/// definite but for rounding, for which the diagonal gets a little more.
void factorise(std::vector<double>& matrix, std::size_t k) {
  double trace = 0.0;
  for (std::size_t r = 0; r < k; ++r) trace += matrix[r * k + r];
  const double ridge = 4.0 * kEpsilon * trace;
  for (std::size_t c = 0; c < k; ++c) {
    double pivot = matrix[c * k + c] + ridge;
    for (std::size_t j = 0; j < c; ++j) pivot -= matrix[c * k + j] * matrix[c * k + j];
    pivot = std::sqrt(std::fmax(pivot, ridge));
    matrix[c * k + c] = pivot;
    for (std::size_t r = c + 1; r < k; ++r) {
      double sum = matrix[r * k + c];
      for (std::size_t j = 0; j < c; ++j) sum -= matrix[r * k + j] * matrix[c * k + j];
      matrix[r * k + c] = sum / pivot;
    }
  }
}

/// Solves with a factor of factorise(), in place.
void solve(const std::vector<double>& factor, std::vector<double>& x) {
  const std::size_t k = x.size();
  for (std::size_t r = 0; r < k; ++r) {
    for (std::size_t j = 0; j < r; ++j) x[r] -= factor[r * k + j] * x[j];
    x[r] /= factor[r * k + r];
  }
  for (std::size_t r = k; r-- > 0;) {
    for (std::size_t j = r + 1; j < k; ++j) x[r] -= factor[j * k + r] * x[j];
    x[r] /= factor[r * k + r];
  }
}

}  // namespace

Offer offer(const SizedProcess& process, double price, Stacking stacking) {
  const double size = process.size_at(price, stacking);
  const double cost = process.cost.at(tolerance_of(size, stacking));
  return {size, cost, cost + price * size};
}

PartAnswer answer(std::span<const SizedProcess> menu, MenuRange allowed, double price, double mixing,
                  Stacking stacking) {
  POESY_EXPECTS(allowed.size() > 0 && allowed.last <= menu.size());
  const Offer first = offer(menu[allowed.first], price, stacking);
  PartAnswer part{price, first.size, 0.0, first.cost, first.total, 0.0, allowed.first};
  if (allowed.size() == 1) {
    part.give = give_of(menu[allowed.first], first.size, stacking);
    return part;
  }
  for (std::size_t p = allowed.first + 1; p < allowed.last; ++p) {
    const double total = offer(menu[p], price, stacking).total;
    if (total >= part.least) continue;
    part.least = total;
    part.main = p;
  }
  double weights = 0.0;
  double give = 0.0;
  double cost = 0.0;
  double shift = 0.0;  // sizes from that of the main process: a variance from differences
  double square = 0.0;
  const double size = menu[part.main].size_at(price, stacking);
  for (std::size_t p = allowed.first; p < allowed.last; ++p) {
    const Offer one = offer(menu[p], price, stacking);
    const double above = (one.total - part.least) / mixing;
    if (!(above < kWeightless)) continue;
    const double weight = std::exp(-above);
    weights += weight;
    give += weight * give_of(menu[p], one.size, stacking);
    cost += weight * one.cost;
    shift += weight * (one.size - size);
    square += weight * (one.size - size) * (one.size - size);
  }
  const double mean = shift / weights;
  const double variance = std::fmax(0.0, square / weights - mean * mean);
  part.size = size + mean;
  part.cost = cost / weights;
  part.give = give / weights + variance / mixing;
  part.scatter = std::sqrt(variance);
  return part;
}

double lower_bound(const SizedProblem& problem, std::span<const MenuRange> allowed, std::span<const std::size_t> rows,
                   std::span<const double> prices) {
  double bound = 0.0;
  double magnitude = 0.0;
  for (std::size_t i = 0; i < problem.parts(); ++i) {
    double price = 0.0;
    for (std::size_t k = 0; k < rows.size(); ++k) price += prices[k] * problem.row(rows[k])[i];
    Offer best{0.0, 0.0, kInfinity};
    for (std::size_t p = allowed[i].first; p < allowed[i].last; ++p) {
      const Offer one = offer(problem.menus[i][p], price, problem.stacking);
      if (one.total < best.total) best = one;
    }
    bound += best.total;
    magnitude += std::abs(best.cost) + price * best.size;
  }
  for (const double price : prices) bound -= price;
  magnitude = std::accumulate(prices.begin(), prices.end(), magnitude);
  // Each number is the result of some 64 operations at most, and of one for each limit and each part.
  const double operations = static_cast<double>(problem.parts() + rows.size()) + 64.0;
  return bound - operations * kEpsilon * magnitude;
}

PricePath::PricePath(const SizedProblem& problem, std::vector<std::size_t> rows)
    : problem_(problem),
      room_(1.0 - rounding_margin(problem.parts())),
      joined_(problem.full),  // limits that are full already have nothing to say
      answers_(problem.parts()),
      sizes_(problem.parts()) {
  for (const std::size_t row : rows) {
    if (!joined_[row]) join(row);
  }
}

void PricePath::join(std::size_t row) {
  joined_[row] = 1;
  rows_.push_back(row);
  const auto effects = problem_.row(row);
  work_.insert(work_.end(), effects.begin(), effects.end());
  prices_.push_back(0.0);
}

void PricePath::begin(std::span<const double> start, double mu) {
  for (std::size_t k = 0; k < prices_.size(); ++k) prices_[k] = std::fmax(mu, k < start.size() ? start[k] : 0.0);
}

/// What all parts do at the prices, and the slack that it leaves.
void PricePath::respond(double mu) {
  const std::size_t parts = problem_.parts();
  std::fill(sizes_.begin(), sizes_.end(), 0.0);  // first the prices
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    for (std::size_t i = 0; i < parts; ++i) sizes_[i] += prices_[k] * work_[k * parts + i];
  }
  for (std::size_t i = 0; i < parts; ++i) {
    answers_[i] = answer(problem_.menus[i], allowed_[i], sizes_[i], mu, problem_.stacking);
    sizes_[i] = answers_[i].size;
  }
  slack_.resize(rows_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k) slack_[k] = room_ - dot({&work_[k * parts], parts}, sizes_);
}

/// Whether price x slack is between mu / 2 and 3 mu / 2 for all limits: then they are kept.
bool PricePath::is_centred(double mu) const {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    if (!(std::abs(mu - prices_[k] * slack_[k]) <= 0.5 * mu)) return false;
  }
  return true;
}

bool PricePath::centre(double mu) {
  respond(mu);
  for (int step = 0; step < kNewtonSteps && !is_centred(mu); ++step) {
    if (!find_direction(mu)) return false;
    move(mu);
  }
  return is_centred(mu);
}

/// Newton's direction in units of the prices: (P A G A' P + mu I) d = mu - P slack, with P = diag(prices), G =
/// diag(give). False when the direction is not finite because numbers overflow.
bool PricePath::find_direction(double mu) {
  const std::size_t count = rows_.size();
  const std::size_t parts = problem_.parts();
  std::vector<double> scaled(count * parts);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < parts; ++i)
      scaled[k * parts + i] = prices_[k] * work_[k * parts + i] * answers_[i].give;
  }
  std::vector<double> matrix(count * count);
  direction_.resize(count);
  for (std::size_t r = 0; r < count; ++r) {
    for (std::size_t c = 0; c <= r; ++c) {
      matrix[r * count + c] = prices_[c] * dot({&scaled[r * parts], parts}, {&work_[c * parts], parts});
    }
    matrix[r * count + r] += mu;
    direction_[r] = mu - prices_[r] * slack_[r];
  }
  factorise(matrix, count);
  solve(matrix, direction_);
  return std::ranges::all_of(direction_, [](double one) { return std::isfinite(one); });
}

/// Goes along the direction. The function is concave, so its slope falls on the way. A step that makes it as negative
/// as half of what it was positive is too long; between such a step and a point before it the slope is made small,
/// because parts that come to a bound bend the function sharply.
void PricePath::move(double mu) {
  const std::vector<double> before = prices_;
  double step = 1.0;
  for (const double d : direction_) step = std::fmin(step, d < 0.0 ? -0.9 / d : d > 0.0 ? 10.0 / d : 1.0);
  const auto slope = [&] {
    double sum = 0.0;
    for (std::size_t k = 0; k < before.size(); ++k) sum += direction_[k] * before[k] * (mu / prices_[k] - slack_[k]);
    return sum;
  };
  const double steep = slope();
  std::pair<double, double> near{0.0, steep};  // step and slope
  std::pair<double, double> far{kInfinity, 0.0};
  for (int attempt = 0; attempt < kSearchSteps; ++attempt) {
    for (std::size_t k = 0; k < before.size(); ++k) prices_[k] = before[k] * (1.0 + step * direction_[k]);
    respond(mu);
    const double now = slope();
    const bool too_long = now < -0.5 * steep;
    const bool too_short = now > 0.5 * steep && far.first < kInfinity;
    if (!too_long && !too_short) return;
    (too_long ? far : near) = {step, now};
    const double part = std::clamp(near.second / (near.second - far.second), 0.1, 0.9);
    step = near.first + part * (far.first - near.first);
  }
}

/// The limits that the sizes break most join, a few at once. False where none is broken.
bool PricePath::join_broken(double mu) {
  struct Excess {
    double over;
    std::size_t row;
  };
  std::vector<Excess> broken;
  const double least = 0.5 * (1.0 - room_);
  for (std::size_t l = 0; l < problem_.limits; ++l) {
    if (joined_[l]) continue;
    const double over = dot(problem_.row(l), sizes_) - room_;
    if (over > least) broken.push_back({over, l});
  }
  std::ranges::sort(
      broken, [](const Excess& a, const Excess& b) { return a.over != b.over ? a.over > b.over : a.row < b.row; });
  if (broken.size() > kJoinAtOnce) broken.resize(kJoinAtOnce);
  for (const Excess& excess : broken) {
    join(excess.row);
    prices_.back() = mu / excess.over;
  }
  return !broken.empty();
}

PathPoint PricePath::here() const {
  double cost = 0.0;
  for (const PartAnswer& part : answers_) cost += part.cost;
  return {answers_, prices_, lower_bound(problem_, allowed_, rows_, prices_), cost};
}

PathPoint PricePath::follow(std::span<const MenuRange> allowed, std::span<const double> start,
                            const PathTarget& target) {
  allowed_ = allowed;
  const double scale = price_scale(problem_, allowed);
  double mixed = 0.0;
  for (const MenuRange& range : allowed) mixed += std::log(static_cast<double>(range.size()));
  double mu = (start.empty() ? 0.1 : 0.01) * scale;
  begin(start, mu);
  for (int round = 0; round < kRounds; ++round) {
    const bool centred = centre(mu);
    if (join_broken(mu)) continue;
    PathPoint point = here();
    double changes = 0.0;
    for (std::size_t i = 0; i < answers_.size(); ++i) changes += changeable(problem_.menus[i], allowed[i], answers_[i]);
    const bool mixes = std::ranges::any_of(answers_, [](const PartAnswer& part) { return part.scatter > 0.0; });
    const double gap = (1.5 * static_cast<double>(rows_.size()) + mixed) * mu;
    const bool ended = gap <= kLastGap * changes || mu <= kLastMu * scale || (mixes && mu <= kLastMixing * changes);
    const bool hopeless = target.only_to_branch && point.cost < target.cutoff &&
                          point.cost - point.lower < 0.2 * (target.cutoff - point.lower);
    if (!centred || ended || hopeless || point.lower >= target.cutoff) return point;
    mu *= kShrink;
  }
  return here();
}

}  // namespace poesy
