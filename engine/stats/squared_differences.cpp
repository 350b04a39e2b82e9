#include "engine/stats/squared_differences.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {

void RatioSums::add(std::span<const double> x, std::span<const double> w, std::span<const std::uint8_t> counts) {
  POESY_EXPECTS(x.size() == counts.size() && w.size() == counts.size());
  constexpr std::size_t kLanes = 8;  // separate sums, so that the compiler may use vectors
  std::array<double, kLanes> sx{};
  std::array<double, kLanes> sw{};
  std::array<double, kLanes> sxx{};
  std::array<double, kLanes> sxw{};
  std::array<double, kLanes> sww{};
  const auto add_one = [&](std::size_t b, std::size_t lane) {
    const double one_x = counts[b] != 0 ? x[b] : 0.0;
    const double one_w = counts[b] != 0 ? w[b] : 0.0;
    sx[lane] += one_x;
    sw[lane] += one_w;
    sxx[lane] += one_x * one_x;
    sxw[lane] += one_x * one_w;
    sww[lane] += one_w * one_w;
    count_ += counts[b] != 0 ? 1 : 0;
  };
  std::size_t b = 0;
  for (; b + kLanes <= x.size(); b += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) add_one(b + lane, lane);
  }
  for (std::size_t lane = 0; b < x.size(); ++b, ++lane) add_one(b, lane);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    x_ += sx[lane];
    w_ += sw[lane];
    xx_ += sxx[lane];
    xw_ += sxw[lane];
    ww_ += sww[lane];
  }
}

void RatioSums::add(double x, double w) {
  ++count_;
  x_ += x;
  w_ += w;
  xx_ += x * x;
  xw_ += x * w;
  ww_ += w * w;
}

void RatioSums::merge(const RatioSums& other) {
  count_ += other.count_;
  x_ += other.x_;
  w_ += other.w_;
  xx_ += other.xx_;
  xw_ += other.xw_;
  ww_ += other.ww_;
}

double RatioSums::mean_x() const { return count_ == 0 ? kNaN : x_ / static_cast<double>(count_); }

double RatioSums::mean_w() const { return count_ == 0 ? kNaN : w_ / static_cast<double>(count_); }

double RatioSums::value() const { return w_ > 0.0 ? x_ / w_ : kNaN; }

Estimate RatioSums::estimate(double conf_level) const {
  POESY_EXPECTS(conf_level > 0.0 && conf_level < 1.0);
  if (count_ < 2 || !(w_ > 0.0)) return {value(), {kNaN, kNaN}};
  if (xx_ == xw_ * value() && xw_ == ww_ * value()) return {value(), {value(), value()}};  // there is no scatter
  const auto n = static_cast<double>(count_);
  const double z = two_sided_student_quantile(n - 1.0, conf_level);
  // z^2 times the variances of the means of x and w, and z^2 times their covariance. The unit is the mean of w, so that
  // small numbers do not underflow.
  const double mean = w_ / n;
  const double ratio = x_ / w_;
  const double scale = z * z / (n * (n - 1.0));
  const double vww = scale * (ww_ / mean / mean - n);
  const double vxw = scale * (xw_ / mean / mean - n * ratio);
  const double vxx = scale * (xx_ / mean / mean - n * ratio * ratio);
  // The ratios t for which the mean of x - t w may be zero at this level: a t^2 - 2 b t + d <= 0 (Fieller 1954).
  const double a = 1.0 - vww;
  const double b = ratio - vxw;
  const double d = ratio * ratio - vxx;
  if (!(a > 0.0)) return {ratio, {kNaN, kNaN}};
  const double half = std::sqrt(std::max(0.0, b * b - a * d));
  return {ratio, {std::min(ratio, (b - half) / a), std::max(ratio, (b + half) / a)}};
}

void RatioSums::state(Archive& archive) {
  archive.number(count_);
  archive.real(x_, w_, xx_, xw_, ww_);
  const std::array sums{x_, w_, xx_, xw_, ww_};
  const bool finite = std::ranges::all_of(sums, [](double sum) { return std::isfinite(sum); });
  const bool empty = std::ranges::all_of(sums, [](double sum) { return sum == 0.0; });
  const bool possible = finite && w_ >= 0.0 && xx_ >= 0.0 && ww_ >= 0.0 && (count_ > 0 || empty);
  archive.expect(possible, "has sums that no pairs give");
}

}  // namespace poesy
