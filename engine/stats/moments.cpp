#include "engine/stats/moments.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

#include "engine/base/contract.h"
#include "engine/base/eight_sums.h"
#include "engine/base/instruction_sets.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

POESY_EACH_INSTRUCTION_SET double sum_of(std::span<const double> values) {
  Sums sums{};
  const std::size_t whole = values.size() / kSums * kSums;
  for (std::size_t k = 0; k < whole; k += kSums) {
    for (std::size_t j = 0; j < kSums; ++j) sums[j] += values[k + j];
  }
  for (std::size_t k = whole; k < values.size(); ++k) sums[k - whole] += values[k];
  return total(sums);
}

struct PowerSums {
  double s1, s2, s3, s4;
};

/// Sums of the first four powers of value - centre.
POESY_EACH_INSTRUCTION_SET PowerSums power_sums(std::span<const double> values, double centre) {
  Sums s1{}, s2{}, s3{}, s4{};
  const auto add = [&](std::size_t j, double value) {
    const double d = value - centre;
    const double square = d * d;
    s1[j] += d;
    s2[j] += square;
    s3[j] += square * d;
    s4[j] += square * square;
  };
  const std::size_t whole = values.size() / kSums * kSums;
  for (std::size_t k = 0; k < whole; k += kSums) {
    for (std::size_t j = 0; j < kSums; ++j) add(j, values[k + j]);
  }
  for (std::size_t k = whole; k < values.size(); ++k) add(k - whole, values[k]);
  return {total(s1), total(s2), total(s3), total(s4)};
}

}  // namespace

void Moments::add(double value) {
  const auto before = static_cast<double>(count_);
  ++count_;
  const auto n = static_cast<double>(count_);
  const double delta = value - mean_;
  const double step = delta / n;
  const double square = delta * step * before;
  mean_ += step;
  m4_ += square * step * step * (n * n - 3.0 * n + 3.0) + 6.0 * step * step * m2_ - 4.0 * step * m3_;
  m3_ += square * step * (n - 2.0) - 3.0 * step * m2_;
  m2_ += square;
}

Moments Moments::of(std::span<const double> values) {
  Moments moments;
  if (values.empty()) return moments;
  const auto n = static_cast<double>(values.size());
  const double mean = sum_of(values) / n;
  const auto [m1, m2, m3, m4] = power_sums(values, mean);
  // Here `shift` is the rounding error of the mean; it corrects the moments about the mean.
  const double shift = m1 / n;
  moments.count_ = values.size();
  moments.mean_ = mean + shift;
  moments.m2_ = std::max(0.0, m2 - n * shift * shift);  // rounding must not make m2_ negative
  moments.m3_ = m3 - 3.0 * shift * m2 + 2.0 * n * shift * shift * shift;
  moments.m4_ = m4 - 4.0 * shift * m3 + 6.0 * shift * shift * m2 - 3.0 * n * shift * shift * shift * shift;
  return moments;
}

void Moments::merge(const Moments& other) {
  if (other.count_ == 0) return;
  if (count_ == 0) {
    *this = other;
    return;
  }
  const auto na = static_cast<double>(count_);
  const auto nb = static_cast<double>(other.count_);
  const double n = na + nb;
  const double delta = other.mean_ - mean_;
  const double step = delta / n;
  const double square = delta * step * na * nb;
  m4_ += other.m4_ + square * step * step * (na * na - na * nb + nb * nb) +
         6.0 * step * step * (na * na * other.m2_ + nb * nb * m2_) + 4.0 * step * (na * other.m3_ - nb * m3_);
  m3_ += other.m3_ + square * step * (na - nb) + 3.0 * step * (na * other.m2_ - nb * m2_);
  m2_ += other.m2_ + square;
  mean_ += step * nb;
  count_ += other.count_;
}

double Moments::variance() const {
  if (count_ < 2) return kNaN;
  return m2_ / static_cast<double>(count_ - 1);
}

double Moments::standard_deviation() const { return std::sqrt(variance()); }

double Moments::skewness() const {
  if (count_ < 2 || m2_ == 0.0) return kNaN;
  const auto n = static_cast<double>(count_);
  return std::sqrt(n) * (m3_ / m2_) / std::sqrt(m2_);
}

double Moments::kurtosis() const {
  if (count_ < 2 || m2_ == 0.0) return kNaN;
  return static_cast<double>(count_) * (m4_ / m2_) / m2_;
}

void Moments::state(Archive& archive) {
  archive.number(count_);
  archive.real(mean_, m2_, m3_, m4_);
}

double sample_mean_square(double mean, double standard_deviation, double count) {
  return mean * mean + standard_deviation * standard_deviation * (count - 1.0) / count;
}

double root_mean_square(double mean, double standard_deviation, std::uint64_t count) {
  const double spread = count < 2 ? 0.0 : standard_deviation;  // zero for a single value
  return std::sqrt(sample_mean_square(mean, spread, static_cast<double>(count)));
}

double root_mean_square(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double two_sided_normal_quantile(double conf_level) {
  POESY_EXPECTS(conf_level > 0.0 && conf_level < 1.0);
  return std::numbers::sqrt2 * boost::math::erf_inv(conf_level);
}

double two_sided_student_quantile(double freedom, double conf_level) {
  POESY_EXPECTS(conf_level > 0.0 && conf_level < 1.0);
  const boost::math::students_t student(freedom);
  return boost::math::quantile(boost::math::complement(student, 0.5 * (1.0 - conf_level)));
}

Interval mean_interval(const Moments& moments, double conf_level) { return MeanIntervals(conf_level).of(moments); }

Interval MeanIntervals::of(const Moments& moments) {
  if (moments.count() < 2) return {kNaN, kNaN};
  const auto n = static_cast<double>(moments.count());
  if (moments.count() != count_) {
    count_ = moments.count();
    quantile_ = two_sided_student_quantile(n - 1.0, conf_level_);
  }
  const double half = quantile_ * moments.standard_deviation() / std::sqrt(n);
  return {moments.mean() - half, moments.mean() + half};
}

Estimate stratified_mean(const Groups& groups, double conf_level) {
  double total = 0.0;
  double sum = 0.0;
  double squares = 0.0;   // sum of n s^2 over the groups, with n samples of standard deviation s
  double quartics = 0.0;  // sum of (n s^2)^2 / (n - 1) over the groups
  for (std::size_t m = 0; m < groups.count.size(); ++m) {
    if (groups.count[m] == 0) continue;
    const auto n = static_cast<double>(groups.count[m]);
    const double within = n * groups.std[m] * groups.std[m];
    total += n;
    sum += n * groups.mean[m];
    squares += within;
    quartics += within * within / (n - 1.0);
  }
  if (total == 0.0) return {kNaN, {kNaN, kNaN}};
  const double mean = sum / total;
  if (squares == 0.0) return {mean, {mean, mean}};
  if (!std::isfinite(quartics)) return {mean, {kNaN, kNaN}};
  const double half = two_sided_student_quantile(squares * squares / quartics, conf_level) * std::sqrt(squares) / total;
  return {mean, {mean - half, mean + half}};
}

}  // namespace poesy
