#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/schema/keys_section.h"
#include "engine/study/calibration.h"
#include "engine/study/study.h"

namespace poesy {

/// The keys of a table and their values, in the order of the file.
std::vector<std::pair<std::string, StudyValue>> in_order(const StudySection& section);

/// Reads the fitted errors of [analysis.calibration]: errors, patterns, sets, and combinations that the table defines.
/// value: the value of the key `fit`. section: the whole table. Throws InputError at the place of the mistake for an
/// unknown name, for an error that a machine draws anew at each pose, and for a weight that lacks its unit. Also throws
/// if the fitted numbers are linearly dependent, because no measurement can separate them.
std::vector<FittedErrors> read_fitted(const StudyValue& value, const StudySection& section, const Study& study);

}  // namespace poesy
