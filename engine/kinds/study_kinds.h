#pragma once

#include "engine/study/study_kind.h"

namespace poesy {

/// Every kind of study.
const StudyKinds& study_kinds();

}  // namespace poesy
