#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/schema/keys_section.h"
#include "engine/study/calibration.h"
#include "engine/study/study.h"

namespace poesy {

/// The values of a table in the order of the file.
std::vector<std::pair<std::string, StudyValue>> in_order(const StudySection& section);

/// Reads the fitted errors of [analysis.calibration]: errors, patterns, sets, and combinations of its table. value: of
/// the key `fit`. section: the whole table. Throws InputError at the place of a name that is unknown, of an error that
/// changes from move to move, of a factor without the unit it needs, and of numbers that are dependent whatever is
/// measured.
std::vector<FittedErrors> read_fitted(const StudyValue& value, const StudySection& section, const Study& study);

}  // namespace poesy
