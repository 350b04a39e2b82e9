#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/contract.h"
#include "engine/base/index.h"

namespace poesy {

/// M poses of C coordinates each, SI, row-major [M x C].
class PoseSet {
 public:
  PoseSet() = default;
  /// Values: [M x coordinates], row-major, SI.
  PoseSet(std::size_t coordinates, std::vector<double> values) : coordinates_(coordinates), values_(std::move(values)) {
    POESY_EXPECTS(coordinates_ > 0 && values_.size() % coordinates_ == 0);
  }

  /// M.
  std::size_t size() const { return coordinates_ == 0 ? 0 : values_.size() / coordinates_; }
  /// Numbers of a pose.
  std::size_t coordinates() const { return coordinates_; }
  /// [coordinates], SI.
  std::span<const double> operator[](PoseIndex pose) const {
    return std::span(values_).subspan(pose.value * coordinates_, coordinates_);
  }
  /// All values of one coordinate, [M].
  std::vector<double> column(std::size_t coordinate) const {
    std::vector<double> values(size());
    for (std::size_t m = 0; m < values.size(); ++m) values[m] = values_[m * coordinates_ + coordinate];
    return values;
  }
  /// Whether all numbers are equal.
  bool operator==(const PoseSet&) const = default;

 private:
  std::size_t coordinates_ = 0;
  std::vector<double> values_;
};

}  // namespace poesy
