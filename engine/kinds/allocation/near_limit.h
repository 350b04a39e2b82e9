#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace poesy {

/// Machines whose load is near the limit of 1: what they tell of rejects to come where one part is made coarser. A
/// machine counts as a reject by degrees, from 0 to 1 within a window about the limit, so that effects too small to
/// change a count show. theory.md, "A coarser part".
class NearLimit {
 public:
  /// Chooses `count` of these machines (ascending numbers) nearest to the limit, by their loads [the same number]:
  /// those within a window of at most 0.2. Precondition: all machines above the limit are among them.
  NearLimit(std::span<const std::uint32_t> machines, std::span<const double> loads, std::size_t count);

  const std::vector<std::uint32_t>& machines() const { return machines_; }  ///< [n] The chosen ones, ascending.
  double window() const { return window_; }  ///< They have all loads from 1 - window to 1 + window.

  /// [n] Of loads [V x n] of the chosen machines those with one of V variations.
  std::span<const double> of_variation(const std::vector<double>& loads, std::size_t variation) const {
    return std::span(loads).subspan(variation * machines_.size(), machines_.size());
  }
  /// Root mean square of what a part adds to or takes from the loads of the chosen machines; `loads` [n] with that part
  /// changed. Infinite ones do not count. 0 for no machines.
  double change(std::span<const double> loads) const;
  /// Expected rejects that come, of all machines, where a part's errors are so many times as large: by the loads [n] of
  /// the chosen machines with these.
  double rejects_to_come(std::span<const double> coarser) const;
  /// The same for errors that are symmetric about zero: a machine is as likely with the part's errors mirrored, all
  /// times -1, and the two counted together cancel what a small effect would drown in. Loads [n] of the chosen
  /// machines: with the part's errors so many times as large, mirrored, and both.
  double rejects_to_come(std::span<const double> coarser, std::span<const double> mirrored,
                         std::span<const double> mirrored_coarser) const;

 private:
  bool is_near(double load) const;
  double reject(double load) const;

  double window_;
  std::vector<std::uint32_t> machines_;
  std::vector<double> loads_;  ///< [n] of these
  double scale_ = 1.0;         ///< rejects over what counts as rejects by degrees
};

}  // namespace poesy
