#include "engine/stats/moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace poesy {

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
  // Eight sums each, so that an addition need not wait for the one before.
  constexpr std::size_t kSums = 8;
  std::array<double, kSums> sum{};
  for (std::size_t k = 0; k < values.size(); ++k) sum[k % kSums] += values[k];
  const double mean = std::accumulate(sum.begin(), sum.end(), 0.0) / n;
  std::array<double, kSums> s1{}, s2{}, s3{}, s4{};
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double d = values[k] - mean;
    const double square = d * d;
    s1[k % kSums] += d;
    s2[k % kSums] += square;
    s3[k % kSums] += square * d;
    s4[k % kSums] += square * square;
  }
  // The mean was rounded by shift; the moments about the mean follow from those about the rounded one.
  const double shift = std::accumulate(s1.begin(), s1.end(), 0.0) / n;
  const double m2 = std::accumulate(s2.begin(), s2.end(), 0.0);
  const double m3 = std::accumulate(s3.begin(), s3.end(), 0.0);
  const double m4 = std::accumulate(s4.begin(), s4.end(), 0.0);
  moments.count_ = values.size();
  moments.mean_ = mean + shift;
  moments.m2_ = std::max(0.0, m2 - n * shift * shift);  // rounding may not leave less than nothing
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
  if (count_ < 2) return std::numeric_limits<double>::quiet_NaN();
  return m2_ / static_cast<double>(count_ - 1);
}

double Moments::standard_deviation() const { return std::sqrt(variance()); }

double Moments::kurtosis() const {
  if (count_ < 2 || m2_ == 0.0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(count_) * (m4_ / m2_) / m2_;
}

void Moments::write(ByteWriter& to) const {
  to.number(count_);
  to.reals(std::array{mean_, m2_, m3_, m4_});
}

Moments Moments::read(ByteReader& from) {
  Moments moments;
  moments.count_ = from.number();
  for (double* value : {&moments.mean_, &moments.m2_, &moments.m3_, &moments.m4_}) *value = from.real();
  return moments;
}

}  // namespace poesy
