#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace poesy {

/// A limit on a response: the range of allowed values, SI, including its ends. A machine must keep the limit at each
/// pose, or at a share of its poses. A limit can also be on the spread of the response over the poses of a machine.
class ValueLimit {
 public:
  /// Allows magnitudes up to `most` at each pose. Infinite: no limit.
  ValueLimit(double most = std::numeric_limits<double>::infinity()) : from_(-most), to_(most) {}  // NOLINT: implicit
  /// Allows values from `from` to `to` at each pose; an end may be infinite. Precondition: from <= to.
  static ValueLimit between(double from, double to);
  /// Limits the spread over the poses of a machine, the largest value minus the smallest, to `most`.
  static ValueLimit of_spread(double most);
  /// This limit, but a machine must keep it only at this share of its poses. Preconditions: 0 < share <= 1; the
  /// limit is not on the spread.
  ValueLimit at_share(double share) const;

  double from() const { return from_; }  ///< Lower end; minus infinity for none.
  double to() const { return to_; }  ///< Upper end; infinity for none. For a limit on the spread, the largest spread.
  double share() const { return share_; }        ///< Share of the poses of a machine at which it must keep the limit.
  bool is_spread() const { return is_spread_; }  ///< Returns true if the spread over the poses is limited.
  /// Returns true if the limit is on the magnitude of a value.
  bool is_magnitude() const { return from_ == -to_ && !is_spread_; }
  /// Returns true if the limit is on the values at several poses of a machine together, so that one pose does not show
  /// whether the machine keeps the limit.
  bool is_over_poses() const { return is_spread_ || share_ < 1.0; }
  /// Returns true if the limit is on the magnitude at each pose, which is the simplest form.
  bool is_plain() const { return is_magnitude() && share_ == 1.0; }

  /// Returns true if the limit allows this value (for a limit on the spread: this spread). Returns false for NaN.
  bool holds(double value) const { return from_ <= value && value <= to_; }
  /// A number that is larger for a worse value. For a limit on magnitudes it is the magnitude. For other limits it is
  /// the distance by which the value is beyond the nearer end, and negative inside the limit. Infinite for NaN.
  double badness(double value) const;
  /// The number of poses, out of `poses`, at which a machine may be beyond the limit.
  std::size_t poses_beyond(std::size_t poses) const;
  /// The number that decides whether a machine keeps the limit. For a limit on the spread it is the spread of the
  /// values. For other limits it is the worst value (largest badness) after the poses_beyond() worst values are left
  /// out. values: the response at the poses where the machine is solved; the function reorders them. poses: the number
  /// of all poses of the machine. Returns NaN if no value is left, or if a value is NaN in a limit on the spread.
  double deciding(std::span<double> values, std::size_t poses) const;
  /// Returns true if a machine keeps the limit. values, poses: as for deciding(). A pose where the machine is not
  /// solved counts as a pose where the limit is kept.
  bool keeps(std::span<double> values, std::size_t poses) const;

  /// Returns true if both limits are equal.
  friend bool operator==(const ValueLimit&, const ValueLimit&) = default;

 private:
  double from_;
  double to_;
  double share_ = 1.0;
  bool is_spread_ = false;
};

}  // namespace poesy
