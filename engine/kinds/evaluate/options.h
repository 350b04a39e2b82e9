#pragma once

#include <string>
#include <vector>

#include "engine/study/study.h"

namespace poesy {

/// A fixed set of errors with a name.
struct ErrorCase {
  std::string name;            ///< stands in tables
  std::vector<double> errors;  ///< [F], SI
};

/// What a study of cases alone asks.
struct CaseOptions {
  std::vector<ErrorCase> cases;  ///< in the order of the study
};

/// The kind of study of named cases of fixed errors.
extern const StudyKind kEvaluateStudy;

}  // namespace poesy
