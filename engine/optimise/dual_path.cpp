#include "engine/optimise/dual_path.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/base/contract.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// Factor by which the parameter mu of the path (DualPath) falls from one point to the next.
constexpr double kMuReduction = 0.1;
/// The path ends when the cost exceeds its lower bound by at most this share of the cost that tolerances can change
/// (changeable()).
constexpr double kRelativeGap = 1e-12;
/// The path ends if mu is below this share of multiplier_scale(), because rounding dominates there.
constexpr double kSmallestMu = 1e-16;
/// If processes are mixed, the path already ends when mu reaches this share of the cost that tolerances can change
/// (changeable()).
constexpr double kSmallestMixingMu = 3e-8;
constexpr int kMaxNewtonSteps = 60;      ///< largest number of Newton steps to one point of the path
constexpr int kMaxLineSearchSteps = 60;  ///< largest number of trial steps along one direction
constexpr int kMaxIterations = 400;      ///< largest number of points of the path plus additions to the working set
constexpr std::size_t kAddedAtOnce = 4;  ///< number of violated limits that join the working set in one iteration

/// The largest amount by which tolerances can change the cost of a part: the mean cost of its mixed processes, minus
/// the least fixed cost of its allowed processes.
double changeable(std::span<const SizedProcess> processes, ProcessRange allowed, const BestResponse& part) {
  double least = kInfinity;
  for (std::size_t p = allowed.first; p < allowed.last; ++p) least = std::fmin(least, processes[p].fixed_cost());
  return std::fmax(0.0, part.cost - least);
}

/// The order of magnitude of multipliers: the sum over the parts and their allowed processes of price x size, if each
/// part uses the share 1 / (number of parts) of the room of the limit that it affects most. The price is the one at
/// which this size is best.
double multiplier_scale(const SizedProblem& problem, std::span<const ProcessRange> allowed) {
  const auto parts = static_cast<double>(problem.parts());
  double sum = 0.0;
  double costs = 0.0;
  for (std::size_t i = 0; i < problem.parts(); ++i) {
    const double effect = problem.largest_effect[i];
    if (effect == 0.0) continue;
    for (std::size_t p = allowed[i].first; p < allowed[i].last; ++p) {
      const SizedProcess& process = problem.processes[i][p];
      const double size = std::fmax(process.lo, std::fmin(process.hi, 1.0 / (parts * effect)));
      if (!process.single()) sum += -size * process.cost.curve(size, problem.stacking).slope;
      costs += std::abs(process.cost.at(tolerance_of(size, problem.stacking)));
    }
  }
  if (sum > 0.0 && std::isfinite(sum)) return sum;
  return costs > 0.0 && std::isfinite(costs) ? costs : 1.0;
}

/// Factorises a symmetric matrix [k x k] in place by Cholesky's method; only its lower half is read. Adds a little to
/// the diagonal, because the matrix may not be positive definite after rounding.
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

/// Solves a linear system by the Cholesky factor from factorise(). x: the right-hand side, which the solution replaces.
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

double lower_bound(const SizedProblem& problem, std::span<const ProcessRange> allowed,
                   std::span<const std::size_t> working_set, std::span<const double> multipliers) {
  double bound = 0.0;
  double magnitude = 0.0;
  for (std::size_t i = 0; i < problem.parts(); ++i) {
    Prices prices{0.0};
    double inner_magnitude = 0.0;
    for (std::size_t k = 0; k < working_set.size(); ++k) prices.own += multipliers[k] * problem.row(working_set[k])[i];
    if (const auto& inner = problem.processes[i].front().inner) {
      for (std::size_t k = 0; k < working_set.size(); ++k) {
        const double price = multipliers[k] * problem.row(working_set[k])[inner->part];
        prices.inner += price;
        inner_magnitude += std::abs(price);
      }
    }
    ProcessResponse best{0.0, 0.0, kInfinity};
    for (std::size_t p = allowed[i].first; p < allowed[i].last; ++p) {
      const ProcessResponse one = process_response(problem.processes[i][p], prices, problem.stacking);
      if (one.lagrangian < best.lagrangian) best = one;
    }
    bound += best.lagrangian;
    magnitude += std::abs(best.cost) + prices.own * best.size + inner_magnitude * best.inner_size;
  }
  for (const double multiplier : multipliers) bound -= multiplier;
  magnitude = std::accumulate(multipliers.begin(), multipliers.end(), magnitude);
  // The margin for rounding: each number results from at most about 64 operations, plus one for each part and each
  // limit of the working set.
  const double operations = static_cast<double>(problem.parts() + working_set.size()) + 64.0;
  return bound - operations * kEpsilon * magnitude;
}

DualPath::DualPath(const SizedProblem& problem, std::vector<std::size_t> working_set)
    : problem_(problem),
      room_(1.0 - rounding_margin(problem.parts())),
      is_in_set_(problem.tight),  // tight limits are marked as if they were in the working set, so that they are never
                                  // added: the parts that affect them are already fixed
      responses_(problem.parts()),
      sizes_(problem.parts()),
      inner_prices_(problem.parts()) {
  for (const std::size_t limit : working_set) {
    if (!is_in_set_[limit]) add_limit(limit);
  }
}

void DualPath::add_limit(std::size_t limit) {
  is_in_set_[limit] = 1;
  working_set_.push_back(limit);
  const auto effects = problem_.row(limit);
  effects_.insert(effects_.end(), effects.begin(), effects.end());
  multipliers_.push_back(0.0);
}

void DualPath::begin(std::span<const double> start, double mu) {
  for (std::size_t k = 0; k < multipliers_.size(); ++k) {
    multipliers_[k] = std::fmax(mu, k < start.size() ? start[k] : 0.0);
  }
}

/// Computes the best sizes of all parts at the multipliers, and the slack of the limits (room minus use).
void DualPath::update_responses(double mu) {
  const std::size_t parts = problem_.parts();
  std::fill(sizes_.begin(), sizes_.end(), 0.0);  // sizes_ holds the prices until the best sizes replace them
  for (std::size_t k = 0; k < working_set_.size(); ++k) {
    for (std::size_t i = 0; i < parts; ++i) sizes_[i] += multipliers_[k] * effects_[k * parts + i];
  }
  for (const Within& pair : problem_.pairs) inner_prices_[pair.outer] = sizes_[pair.inner];
  for (std::size_t i = 0; i < parts; ++i) {
    const Prices prices{sizes_[i], inner_prices_[i]};
    responses_[i] = best_response(problem_.processes[i], allowed_[i], prices, mu, problem_.stacking);
    sizes_[i] = responses_[i].size;
  }
  for (const Within& pair : problem_.pairs) {
    responses_[pair.inner].size = sizes_[pair.inner] = responses_[pair.outer].inner.size;
  }
  slack_.resize(working_set_.size());
  for (std::size_t k = 0; k < working_set_.size(); ++k) {
    slack_[k] = room_ - dot({&effects_[k * parts], parts}, sizes_);
  }
}

/// Whether multiplier x slack is between mu / 2 and 3 mu / 2 for every limit of the working set. If so, all these
/// limits are kept.
bool DualPath::is_centred(double mu) const {
  for (std::size_t k = 0; k < working_set_.size(); ++k) {
    if (!(std::abs(mu - multipliers_[k] * slack_[k]) <= 0.5 * mu)) return false;
  }
  return true;
}

bool DualPath::centre(double mu) {
  update_responses(mu);
  for (int step = 0; step < kMaxNewtonSteps && !is_centred(mu); ++step) {
    if (!find_newton_direction(mu)) return false;
    search_line(mu);
  }
  return is_centred(mu);
}

/// [working set x parts] The matrix P A G with P = diag(multipliers), the effects A [working set x parts], and G [parts
/// x parts]: the decrease of each part's best size per unit of its price (BestResponse). G is diagonal except for the
/// two parts of a pair (Within).
std::vector<double> DualPath::scaled_effects() const {
  const std::size_t parts = problem_.parts();
  std::vector<double> scaled(effects_.size());
  for (std::size_t k = 0; k < working_set_.size(); ++k) {
    for (std::size_t i = 0; i < parts; ++i) {
      scaled[k * parts + i] = multipliers_[k] * effects_[k * parts + i] * responses_[i].inverse_curvature;
    }
    for (const Within& pair : problem_.pairs) {
      const InnerResponse& inner = responses_[pair.outer].inner;
      const double own = multipliers_[k] * effects_[k * parts + pair.outer];
      const double within = multipliers_[k] * effects_[k * parts + pair.inner];
      scaled[k * parts + pair.outer] += within * inner.cross;
      scaled[k * parts + pair.inner] = own * inner.cross + within * inner.inverse_curvature;
    }
  }
  return scaled;
}

/// Finds Newton's direction d, relative to the multipliers, from (P A G A^T P + mu I) d = mu - P slack, with the
/// symbols of scaled_effects(). Returns false if the direction is not finite because numbers overflow.
bool DualPath::find_newton_direction(double mu) {
  const std::size_t count = working_set_.size();
  const std::size_t parts = problem_.parts();
  const std::vector<double> scaled = scaled_effects();
  std::vector<double> matrix(count * count);
  direction_.resize(count);
  for (std::size_t r = 0; r < count; ++r) {
    for (std::size_t c = 0; c <= r; ++c) {
      matrix[r * count + c] = multipliers_[c] * dot({&scaled[r * parts], parts}, {&effects_[c * parts], parts});
    }
    matrix[r * count + r] += mu;
    direction_[r] = mu - multipliers_[r] * slack_[r];
  }
  factorise(matrix, count);
  solve(matrix, direction_);
  return std::ranges::all_of(direction_, [](double one) { return std::isfinite(one); });
}

/// Moves the multipliers along Newton's direction to a point at which the function that the path maximises (DualPath)
/// is larger. The function is concave, so its slope falls along the direction. A step is too long if the slope at its
/// end is below minus half of the slope at its beginning. After a step that is too long, the search continues between a
/// shorter step and this one until the slope is small, because the function bends sharply where sizes reach a bound.
void DualPath::search_line(double mu) {
  const std::vector<double> before = multipliers_;
  double step = 1.0;
  for (const double d : direction_) step = std::fmin(step, d < 0.0 ? -0.9 / d : d > 0.0 ? 10.0 / d : 1.0);
  const auto slope = [&] {
    double sum = 0.0;
    for (std::size_t k = 0; k < before.size(); ++k) {
      sum += direction_[k] * before[k] * (mu / multipliers_[k] - slack_[k]);
    }
    return sum;
  };
  const double steep = slope();
  std::pair<double, double> near{0.0, steep};  // longest step that is too short: its length, and the slope at its end
  std::pair<double, double> far{kInfinity, 0.0};
  for (int attempt = 0; attempt < kMaxLineSearchSteps; ++attempt) {
    for (std::size_t k = 0; k < before.size(); ++k) multipliers_[k] = before[k] * (1.0 + step * direction_[k]);
    update_responses(mu);
    const double now = slope();
    const bool too_long = now < -0.5 * steep;
    const bool too_short = now > 0.5 * steep && far.first < kInfinity;
    if (!too_long && !too_short) return;
    (too_long ? far : near) = {step, now};
    const double part = std::clamp(near.second / (near.second - far.second), 0.1, 0.9);
    step = near.first + part * (far.first - near.first);
  }
}

/// Adds the most violated limits to the working set, at most kAddedAtOnce. Returns false if no limit is violated.
bool DualPath::add_violated_limits(double mu) {
  struct Violation {
    double excess;
    std::size_t limit;
  };
  std::vector<Violation> violated;
  const double least = 0.5 * (1.0 - room_);
  for (std::size_t l = 0; l < problem_.limits; ++l) {
    if (is_in_set_[l]) continue;
    const double excess = dot(problem_.row(l), sizes_) - room_;
    if (excess > least) violated.push_back({excess, l});
  }
  std::ranges::sort(violated, [](const Violation& a, const Violation& b) {
    return a.excess != b.excess ? a.excess > b.excess : a.limit < b.limit;
  });
  if (violated.size() > kAddedAtOnce) violated.resize(kAddedAtOnce);
  for (const Violation& one : violated) {
    add_limit(one.limit);
    multipliers_.back() = mu / one.excess;
  }
  return !violated.empty();
}

PathPoint DualPath::here() const {
  double cost = 0.0;
  for (const BestResponse& part : responses_) cost += part.cost;
  return {responses_, multipliers_, lower_bound(problem_, allowed_, working_set_, multipliers_), cost};
}

PathPoint DualPath::follow(std::span<const ProcessRange> allowed, std::span<const double> start,
                           const PathTarget& target) {
  allowed_ = allowed;
  const double scale = multiplier_scale(problem_, allowed);
  double entropy = 0.0;
  for (const ProcessRange& range : allowed) entropy += std::log(static_cast<double>(range.size()));
  double mu = (start.empty() ? 0.1 : 0.01) * scale;
  begin(start, mu);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const bool centred = centre(mu);
    if (add_violated_limits(mu)) continue;
    PathPoint point = here();
    double changes = 0.0;
    for (std::size_t i = 0; i < responses_.size(); ++i) {
      changes += changeable(problem_.processes[i], allowed[i], responses_[i]);
    }
    const bool mixes = std::ranges::any_of(
        responses_, [](const BestResponse& part) { return part.deviation > 0.0 || part.inner.deviation > 0.0; });
    const double gap = (1.5 * static_cast<double>(working_set_.size()) + entropy) * mu;
    const bool ended =
        gap <= kRelativeGap * changes || mu <= kSmallestMu * scale || (mixes && mu <= kSmallestMixingMu * changes);
    const bool hopeless = target.only_to_branch && point.cost < target.cutoff &&
                          point.cost - point.lower_bound < 0.2 * (target.cutoff - point.lower_bound);
    if (!centred || ended || hopeless || point.lower_bound >= target.cutoff) return point;
    mu *= kMuReduction;
  }
  return here();
}

}  // namespace poesy
