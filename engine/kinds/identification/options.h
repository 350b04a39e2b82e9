#pragma once

#include <string>
#include <vector>

#include "engine/study/study.h"

namespace poesy {

/// The sizes at which identification sets errors.
struct ErrorSize {
  std::string name;  ///< stands in tables
  double linear;     ///< m
  double angular;    ///< rad
};

/// What an identification study alone asks.
struct IdentificationOptions {
  std::vector<ErrorSize> groups;  ///< each gives verdicts of its own
  double pose_share = 0.95;       ///< of the poses that a verdict asks for
};

/// The kind of study that tells which errors deform the mechanism at all.
extern const StudyKind kIdentificationStudy;

}  // namespace poesy
