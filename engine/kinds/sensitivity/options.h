#pragma once

#include <optional>

#include "engine/study/study.h"

namespace poesy {

/// The error from which equal-effect tolerances are counted, and its own tolerance.
struct ToleranceReference {
  FactorIndex factor;  ///< one of those that vary
  double tolerance;    ///< SI
};

/// What a sensitivity study alone asks.
struct SensitivityOptions {
  std::optional<ToleranceReference> reference;  ///< empty: the error of smallest effect
  double linearity = 0.01;                      ///< at two fidelities: up to this an error is linear
};

/// The kind of study that tells what each error does on its own.
extern const StudyKind kSensitivityStudy;

}  // namespace poesy
