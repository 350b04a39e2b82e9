#include "engine/stats/moments.h"

#include <cmath>
#include <limits>

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

}  // namespace poesy
