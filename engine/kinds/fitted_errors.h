#pragma once

#include <span>
#include <vector>

#include "engine/calibration/fit.h"
#include "engine/study/calibration.h"
#include "engine/study/study.h"

namespace poesy {

/// The mean and the covariance of errors before any measurement, from the tolerances in [errors]. Correlated errors
/// have the correlation of their normal scores.
struct ToleranceKnowledge {
  std::vector<FactorIndex> factors;  ///< [errors] the errors, ascending
  calibration::Vector mean;          ///< [errors] mean of each error, SI
  calibration::Matrix root;          ///< [errors x errors] matrix L for which L^T L is the inverse of the covariance
};

/// The mean and covariance of these errors before any measurement. factors: ascending, each with a tolerance.
ToleranceKnowledge tolerance_knowledge(const ErrorModel& errors, std::vector<FactorIndex> factors);

/// The directions, scales and difference steps of the fitted errors, and the prior. A fitted error is one of the
/// numbers that are fitted: a single error, or a weighted sum of errors. Each has a column in the matrix F of
/// FittedDirections.
struct FittedColumns {
  /// Directions of the fitted errors. The scale of a fitted error is the standard deviation that the tolerances give
  /// it. If one of its errors has no tolerance, the scale is 1 mm for a length, and 1 mm / reach for an angle.
  calibration::FittedDirections directions;
  calibration::Prior prior;     ///< empty if the study does not use tolerances as a prior
  bool has_tolerances = false;  ///< whether the scales of all columns follow from tolerances
};

/// The columns of the fitted errors of a study.
FittedColumns fitted_columns(const Study& study, const CalibrationTable& table,
                             const calibration::ExactMachine& machine);

/// The columns of all errors that may differ from 0. First comes one column for each error with a tolerance. Then comes
/// one column for each fitted error that contains errors without a tolerance, with the weights of only these errors.
FittedColumns all_columns(const Study& study, const CalibrationTable& table, const calibration::ExactMachine& machine);

}  // namespace poesy
