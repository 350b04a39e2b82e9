#pragma once

#include <functional>
#include <string>

#include "engine/base/value_limit.h"
#include "engine/model/model.h"
#include "engine/schema/keys.h"
#include "engine/study/study.h"

namespace poesy {

/// Reads the limits of a study into study.analysis.limits, sorted in the order of the model's responses.
void read_response_limits(const StudyValue& value, Study& study);

/// The limits as lines of the resolved text (the study with every default filled in), one line for each limit.
std::string response_limits_lines(const Study& study);

/// The description of the tables [analysis.limits] and [analysis.limits.RESPONSE].
StudyTables limit_tables();

/// The value that states a limit in the section [analysis], for messages at its place. Precondition: the study was read
/// from this section.
StudyValue limit_value(const StudySection& analysis, const Study& study, const ResponseLimit& limit);

/// A limit in words: "0.03 mm", "-0.02 mm to 0.1 mm", "at most 0.1 mm", "a spread of 0.08 mm", "0.02 deg at 99 % of the
/// poses". value_text: converts a value of the response (SI) to text. Precondition: the limit is finite on at least one
/// side.
std::string limit_text(const ValueLimit& limit, const std::function<std::string(double)>& value_text);
/// The limit in words, with values in the unit in which results show this dimension.
std::string limit_text(const ValueLimit& limit, Dimension dimension);

}  // namespace poesy
