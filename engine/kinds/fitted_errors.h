#pragma once

#include <span>
#include <vector>

#include "engine/calibration/fit.h"
#include "engine/study/calibration.h"
#include "engine/study/study.h"

namespace poesy {

/// The mean and the covariance of errors before any measurement, from the tolerances in [errors]. For correlated
/// errors, the correlation is that of their normal scores.
struct ToleranceKnowledge {
  std::vector<FactorIndex> factors;  ///< [errors] indices of the errors, ascending
  calibration::Vector mean;          ///< [errors] mean of each error, SI
  calibration::Matrix root;          ///< [errors x errors] matrix L, where L^T L is the inverse of the covariance
};

/// The mean and the covariance of these errors before any measurement. factors: indices of the errors, ascending; each
/// error has a tolerance.
ToleranceKnowledge tolerance_knowledge(const ErrorModel& errors, std::vector<FactorIndex> factors);

/// The directions, scales and difference steps of the fitted errors, and the prior. A fitted error is one number of the
/// fit: a single error, or a combination of errors with fixed weights. It has a column in the matrix F of
/// FittedDirections.
struct FittedColumns {
  /// Directions of the fitted errors. The scale of a fitted error is the standard deviation that follows from the
  /// tolerances. If one of its errors has no tolerance, the scale is 1 mm for a length, otherwise 1 mm divided by the
  /// reach of the mechanism.
  calibration::FittedDirections directions;
  /// Prior knowledge from the tolerances; fitted_columns() leaves it empty if the study uses none.
  calibration::Prior prior;
  bool has_tolerances = false;  ///< whether the scales of all columns follow from tolerances
};

/// The columns of the fitted errors of a study.
FittedColumns fitted_columns(const Study& study, const CalibrationTable& table,
                             const calibration::ExactMachine& machine);

/// The columns of all errors that may differ from 0: first one for each error with a tolerance, then one for each
/// fitted error that contains errors without a tolerance. The column of such a fitted error has weights only for its
/// errors without a tolerance.
FittedColumns all_columns(const Study& study, const CalibrationTable& table, const calibration::ExactMachine& machine);

}  // namespace poesy
