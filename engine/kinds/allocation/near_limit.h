#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace poesy {

/// Machines whose load is near the limit of 1. They tell how many rejects one coarser part adds. A machine counts as a
/// reject by degrees, from 0 to 1 within a window about the limit, so that effects too small to change a count show.
/// theory.md, "A coarser part".
class NearLimit {
 public:
  /// Chooses the `count` machines nearest to the limit, within a window of at most 0.2. machines: [m] ascending
  /// numbers, among them all rejects; loads: [m].
  NearLimit(std::span<const std::uint32_t> machines, std::span<const double> loads, std::size_t count);

  const std::vector<std::uint32_t>& machines() const { return machines_; }  ///< [n] The chosen machines, ascending.
  double window() const { return window_; }  ///< They are the machines with loads from 1 - window to 1 + window.

  /// [n] The loads of one variation, from those [V x n] of all.
  std::span<const double> of_variation(const std::vector<double>& loads, std::size_t variation) const {
    return std::span(loads).subspan(variation * machines_.size(), machines_.size());
  }
  /// The root mean square of the change of the loads, where `loads` [n] are those with a part changed. Infinite loads
  /// do not count. 0 for no machines.
  double change(std::span<const double> loads) const;
  /// The expected number of rejects that a coarser part adds among all machines, by the loads [n] of the chosen
  /// machines with that part coarser.
  double added_rejects(std::span<const double> coarser) const;
  /// The same by antithetic pairs (e, -e) of a part's errors, which reduce the variance. Precondition: the errors are
  /// symmetric about zero. Loads [n] of the chosen machines: with the part coarser, mirrored, and both.
  double added_rejects(std::span<const double> coarser, std::span<const double> mirrored,
                       std::span<const double> mirrored_coarser) const;

 private:
  bool is_near(double load) const;
  double reject(double load) const;

  double window_;
  std::vector<std::uint32_t> machines_;
  std::vector<double> loads_;  ///< [n]
  double scale_ = 1.0;         ///< rejects over their count by degrees
};

}  // namespace poesy
