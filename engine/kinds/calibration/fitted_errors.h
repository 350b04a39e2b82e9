#pragma once

#include <span>
#include <vector>

#include "engine/calibration/fit.h"
#include "engine/study/calibration.h"
#include "engine/study/study.h"

namespace poesy {

/// The tolerances of errors as knowledge: the covariance of [errors]. Correlated errors have their correlation of
/// normal scores.
struct ToleranceKnowledge {
  std::vector<FactorIndex> factors;  ///< [p], ascending
  calibration::Vector mean;          ///< [p] means, SI
  calibration::Matrix root;          ///< [p x p] L with L^T L the inverse of their covariance
};

/// The knowledge about these errors. factors: ascending, all with a tolerance.
ToleranceKnowledge tolerance_knowledge(const ErrorModel& errors, std::vector<FactorIndex> factors);

/// The columns F of fitted errors, their scales and steps, and the prior.
struct FittedColumns {
  calibration::FittedDirections directions;  ///< with the scale: the tolerance, or 1 mm and 1 mm over the reach
  calibration::Prior prior;                  ///< empty unless tolerances count
  bool has_tolerances = false;               ///< whether all scales are tolerances
};

/// The columns of the fitted errors of a study.
FittedColumns fitted_columns(const Study& study, const CalibrationTable& table,
                             const calibration::ExactMachine& machine);

/// The columns of all errors that may differ from 0: those with a tolerance, each alone, and the parts of fitted errors
/// without one.
FittedColumns all_columns(const Study& study, const CalibrationTable& table, const calibration::ExactMachine& machine);

}  // namespace poesy
