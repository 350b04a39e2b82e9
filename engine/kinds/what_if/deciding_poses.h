#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/kinds/what_if/tried.h"
#include "engine/kinds/what_if/what_if.h"

namespace poesy {

/// Poses that together reject nearly all rejected machines. A pose rejects a machine that exceeds a limit there.
struct DecidingPoses {
  std::vector<std::size_t> places;  ///< positions of these poses in TriedMachines::poses, ascending
  /// Share of machines that only other poses reject: the largest share over the tried settings of the sliders.
  double missed;
};

/// [errors] The factor that multiplies the size of each error if the sliders are at `factors`; 1 for an error without a
/// slider. errors: number of errors.
std::vector<double> sizes_of(std::span<const SizedErrors> sliders, std::span<const double> factors, std::size_t errors);

/// Chooses at most `most` poses by the machines that they reject at several settings of the sliders: all sliders at the
/// same factor, and one slider at its largest factor with the others at 1 or 0.5.
DecidingPoses deciding_poses(const TriedMachines& tried, const WhatIfMachines& machines,
                             std::span<const SizedErrors> sliders, std::size_t most);

}  // namespace poesy
