#pragma once

#include <span>
#include <vector>

#include "engine/calibration/fit.h"
#include "engine/study/calibration.h"
#include "engine/study/study.h"

namespace poesy {

/// What the tolerances of [errors] say about errors before any measurement: mean and covariance. Correlated errors have
/// the correlation of their normal scores.
struct ToleranceKnowledge {
  std::vector<FactorIndex> factors;  ///< [errors] the errors, ascending
  calibration::Vector mean;          ///< [errors] mean of each error, SI
  calibration::Matrix root;          ///< [errors x errors] matrix L for which L^T L is the inverse of the covariance
};

/// The mean and covariance of these errors. factors: ascending, each with a tolerance.
ToleranceKnowledge tolerance_knowledge(const ErrorModel& errors, std::vector<FactorIndex> factors);

/// The matrix F of the fitted errors (FittedDirections) with one column for each, its scales and difference steps, and
/// the prior.
struct FittedColumns {
  calibration::FittedDirections directions;  ///< directions of the fitted errors. The scale of each is its tolerance.
                                             ///< Without a tolerance it is 1 mm, or 1 mm / reach for an angle.
  calibration::Prior prior;                  ///< empty if the study does not use tolerances as a prior
  bool has_tolerances = false;               ///< whether the scale of every column is a tolerance
};

/// The columns of the fitted errors of a study.
FittedColumns fitted_columns(const Study& study, const CalibrationTable& table,
                             const calibration::ExactMachine& machine);

/// The columns of all errors that may differ from 0: one column for each error with a tolerance, and one for each
/// fitted error, restricted to its errors without a tolerance.
FittedColumns all_columns(const Study& study, const CalibrationTable& table, const calibration::ExactMachine& machine);

}  // namespace poesy
