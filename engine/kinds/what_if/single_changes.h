#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/kinds/what_if/deciding_poses.h"
#include "engine/kinds/what_if/machines.h"
#include "engine/kinds/what_if/tried.h"
#include "engine/kinds/what_if/what_if.h"

namespace poesy {

/// A change of a study, and the yield that is predicted for it.
struct PredictedChange {
  std::string change;     ///< description of the change: "halving seat_*"
  double yield;           ///< predicted yield, 0 to 1
  double standard_error;  ///< standard error of `yield` by chance, if the yield of the study is exact
};

/// The yields that are predicted for single changes, the largest first. A change halves the sizes of the errors of one
/// name in all limbs, or sets their means to zero, or removes the means of the limited vectors over the machines at
/// each pose. means: [errors] means of the errors, SI. yield: yield of the study.
std::vector<PredictedChange> single_changes(std::span<const SizedErrors> errors, std::span<const double> means,
                                            double yield, const TriedMachines& tried, const WhatIfMachines& machines,
                                            const DecidingPoses& deciding);

/// The changes that raise the yield most, and how uncertain they are: "Predicted yields for one change alone, now 78.4
/// %: halving elbow 89.3 %, ...". Empty if no change raises the yield by more than 0.001. quantile: half the width of
/// an interval, in standard errors.
std::string changes_text(std::span<const PredictedChange> changes, double yield, double quantile);

}  // namespace poesy
