#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace poesy::allocation {

/// The machines whose loads are near 1. They serve to estimate how many rejects a larger tolerance of a part adds. The
/// load of a machine is the largest ratio of a response to its limit, over all limits and poses; above 1 the machine is
/// a reject. Because many effects are too small to change a count, a machine counts as a fraction of a reject: the
/// fraction rises from 0 to 1 in a window around the load 1. See theory.md, "A coarser part".
class NearLimit {
 public:
  /// Chooses about `count` machines: those in a window around the load 1. The window is just wide enough for the
  /// `count` loads nearest to 1, but its half-width is at least 0.02 and at most 0.2. machines: [listed] ascending
  /// numbers, including all rejects; loads: [listed].
  NearLimit(std::span<const std::uint32_t> machines, std::span<const double> loads, std::size_t count);

  /// The numbers of the chosen machines, ascending.
  const std::vector<std::uint32_t>& machines() const { return machines_; }
  /// The half-width of the window: loads of chosen machines are from 1 - window to 1 + window.
  double window() const { return window_; }

  /// [chosen] The loads of machines() under one variation. loads: [variations x chosen] loads under all variations.
  std::span<const double> of_variation(const std::vector<double>& loads, std::size_t variation) const {
    return std::span(loads).subspan(variation * machines_.size(), machines_.size());
  }
  /// The root mean square change of the chosen machines' loads if the tolerance of a part changes. loads: [chosen]
  /// loads after the change. Machines with an infinite load are left out; 0 if all loads are infinite.
  double change(std::span<const double> loads) const;
  /// The expected number of rejects, among all machines, that a larger tolerance of a part adds. coarser: [chosen]
  /// loads of machines() with this larger tolerance.
  double added_rejects(std::span<const double> coarser) const;
  /// The expected number of rejects that a larger tolerance of a part adds, estimated from antithetic pairs (e, -e) of
  /// the part's errors e, so that it has less variance. Precondition: the errors are symmetric about zero. All
  /// arguments are loads [chosen] of machines(): with the larger tolerance, with -e instead of e, and with both
  /// changes.
  double added_rejects(std::span<const double> coarser, std::span<const double> mirrored,
                       std::span<const double> mirrored_coarser) const;

 private:
  bool is_near(double load) const;
  double reject(double load) const;

  double window_;
  std::vector<std::uint32_t> machines_;
  std::vector<double> loads_;  ///< [chosen] loads of the chosen machines
  double scale_ = 1.0;         ///< number of rejects divided by the sum of fractional rejects
};

}  // namespace poesy::allocation
