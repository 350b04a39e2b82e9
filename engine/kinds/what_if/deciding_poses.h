#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/kinds/what_if/tried.h"
#include "engine/kinds/what_if/what_if.h"

namespace poesy {

/// Poses that reject nearly all machines which any of the tried poses rejects.
struct DecidingPoses {
  std::vector<std::size_t> places;  ///< positions of these poses in TriedMachines::poses, ascending
  /// Share of machines that only other poses reject: the largest share over all settings of the sliders.
  double missed;
};

/// [errors] The factor on each error if the sliders have these factors; 1 for errors without a slider.
std::vector<double> sizes_of(std::span<const SizedErrors> sliders, std::span<const double> factors, std::size_t errors);

/// Chooses at most `most` poses. They are judged at settings of the sliders: all sliders at the same factor, and one
/// slider at its largest factor with the others at 1 or 0.5.
DecidingPoses deciding_poses(const TriedMachines& tried, const WhatIfMachines& machines,
                             std::span<const SizedErrors> sliders, std::size_t most);

}  // namespace poesy
