#pragma once

#include "engine/report/html/parts.h"

namespace poesy {

/// Adds to the page a section that predicts yield and cost with other tolerances of the parts. The predictions use the
/// certificate's machines: fresh machines that were solved once after the search. Adds nothing if the study cannot be
/// read and solved again, or if what_if() predicts nothing.
void add_prediction(const ReportedResult& reported, Page& page);

}  // namespace poesy
