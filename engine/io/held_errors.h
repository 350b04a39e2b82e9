#pragma once

#include <string>

#include "engine/study/study.h"

namespace poesy {

/// Which errors the study's background holds, at which size, on one line: "held constant: 30 errors of set 'benign' at
/// 1 mm and 1 deg". Empty where it holds none. Errors that vary are not held, nor are those whose size is zero.
std::string held_errors_text(const Study& study);

}  // namespace poesy
