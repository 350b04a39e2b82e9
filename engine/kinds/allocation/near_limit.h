#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace poesy {

/// The machines whose loads are near the limit of 1, which tell how many rejects one coarser part adds. A machine
/// counts fractionally as a reject, from 0 to 1 within a window around the limit, because many effects are too small to
/// change a count. theory.md, "A coarser part".
class NearLimit {
 public:
  /// Chooses the `count` machines nearest to the limit, within a window of at most 0.2. machines: [m] ascending
  /// numbers, which include all rejects; loads: [m].
  NearLimit(std::span<const std::uint32_t> machines, std::span<const double> loads, std::size_t count);

  const std::vector<std::uint32_t>& machines() const { return machines_; }  ///< [n] The chosen machines, ascending.
  double window() const { return window_; }  ///< They are the machines with loads from 1 - window to 1 + window.

  /// [n] The loads of one variation. loads: [V x n] of all variations.
  std::span<const double> of_variation(const std::vector<double>& loads, std::size_t variation) const {
    return std::span(loads).subspan(variation * machines_.size(), machines_.size());
  }
  /// The root mean square of the changes of the loads. loads: [n] with a part changed. Infinite loads are left out. 0
  /// if there are no machines.
  double change(std::span<const double> loads) const;
  /// The expected number of rejects that a coarser part adds among all machines, by the loads [n] of the chosen
  /// machines with that part coarser.
  double added_rejects(std::span<const double> coarser) const;
  /// The same from antithetic pairs (e, -e) of a part's errors, which reduce the variance. Precondition: the errors are
  /// symmetric about zero. Loads [n] of the chosen machines: with the part coarser, with its errors mirrored, and with
  /// both.
  double added_rejects(std::span<const double> coarser, std::span<const double> mirrored,
                       std::span<const double> mirrored_coarser) const;

 private:
  bool is_near(double load) const;
  double reject(double load) const;

  double window_;
  std::vector<std::uint32_t> machines_;
  std::vector<double> loads_;  ///< [n]
  double scale_ = 1.0;         ///< the number of rejects over the sum of the fractional counts
};

}  // namespace poesy
