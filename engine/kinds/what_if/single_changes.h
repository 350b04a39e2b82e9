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
  std::string change;     ///< such as "halving seat_*"
  double yield;           ///< 0 to 1
  double standard_error;  ///< of `yield` by chance, if the yield of the study is exact
};

/// The yields that are predicted if one change alone is made: errors of one name, in all limbs, have half their size,
/// or mean zero, or the means of the limited vectors over the machines are removed at each pose. The largest yield
/// comes first. means: [errors] SI. yield: that of the study.
std::vector<PredictedChange> single_changes(std::span<const SizedErrors> errors, std::span<const double> means,
                                            double yield, const TriedMachines& tried, const WhatIfMachines& machines,
                                            const DecidingPoses& deciding);

/// The changes that raise the yield most, and how uncertain they are: "Predicted yields for one change alone, now 78.4
/// %: halving elbow 89.3 %, ...". Empty if no change raises the yield. quantile: half the width of an interval, in
/// standard errors.
std::string changes_text(std::span<const PredictedChange> changes, double yield, double quantile);

}  // namespace poesy
