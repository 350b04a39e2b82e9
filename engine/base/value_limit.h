#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace poesy {

/// The values of a response that a limit allows, SI. A response is limited at each pose of a machine, at a share of its
/// poses, or by its spread over them. A value equal to an end is allowed.
class ValueLimit {
 public:
  /// Magnitudes up to `most`, at each pose. Infinite: no limit.
  ValueLimit(double most = std::numeric_limits<double>::infinity()) : from_(-most), to_(most) {}  // NOLINT: implicit
  /// Values from `from` to `to`, at each pose; an end may be infinite. Precondition: from <= to.
  static ValueLimit between(double from, double to);
  /// The largest less the smallest value over the poses of a machine is at most `most`.
  static ValueLimit of_spread(double most);
  /// The same limit, to be kept at this share of the poses of a machine. Preconditions: 0 < share <= 1; not of the
  /// spread.
  ValueLimit at_share(double share) const;

  double from() const { return from_; }          ///< Lower end; minus infinity for none.
  double to() const { return to_; }              ///< Upper end; infinity for none. Of a spread its limit.
  double share() const { return share_; }        ///< Share of the poses of a machine at which the limit is kept.
  bool is_spread() const { return is_spread_; }  ///< Whether the spread over the poses is limited.
  /// Whether a value is good up to some magnitude.
  bool is_magnitude() const { return from_ == -to_ && !is_spread_; }
  /// Whether one pose alone cannot tell if the limit is kept.
  bool is_over_poses() const { return is_spread_ || share_ < 1.0; }
  /// Whether it is a magnitude at each pose.
  bool is_plain() const { return is_magnitude() && share_ == 1.0; }

  /// Whether the limit allows this value, or this spread. False for NaN.
  bool holds(double value) const { return from_ <= value && value <= to_; }
  /// How bad a value is: of a limit on magnitudes its magnitude, otherwise how far it is beyond the nearer end, which
  /// is negative inside. Infinite for NaN.
  double badness(double value) const;
  /// The number of poses, of so many, at which a machine may be beyond the limit.
  std::size_t poses_beyond(std::size_t poses) const;
  /// The number of a machine by which it is judged. values: at the poses where the machine is solved, which are
  /// reordered; `poses`: the number of all its poses. For a limit on the spread it is the spread of the values, for any
  /// other limit the value with the largest badness after those that poses_beyond() permits. NaN if there is none.
  double deciding(std::span<double> values, std::size_t poses) const;
  /// Whether a machine with these values keeps the limit. Poses where it is not solved count as kept.
  bool keeps(std::span<double> values, std::size_t poses) const;

  friend bool operator==(const ValueLimit&, const ValueLimit&) = default;  ///< Whether both allow the same.

 private:
  double from_;
  double to_;
  double share_ = 1.0;
  bool is_spread_ = false;
};

}  // namespace poesy
