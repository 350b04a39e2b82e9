#pragma once

#include "engine/report/html/parts.h"

namespace poesy::allocation {

/// Adds to the page a section that predicts yield and cost with other tolerances of the parts. The predictions use the
/// certificate's machines: fresh machines that were solved once after the search. Adds nothing if the result does
/// not fit its study or if the study calibrates machines by measurements. Also adds what the certificate does not cover
/// (add_not_covered()).
void add_prediction(const ReportedResult& reported, Page& page);

}  // namespace poesy::allocation
