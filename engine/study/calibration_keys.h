#pragma once

#include "engine/study/study_kind.h"

namespace poesy {

/// The row of `calibration` in [analysis]. Precondition of reading: [poses] and [errors] were read.
StudyRow calibration_row();

/// The tables of its keys.
StudyTables calibration_tables();

/// The errors with a tolerance, ascending: those whose distribution [errors] states, and that `factors` names if the
/// study has this key. root: the whole file.
std::vector<FactorIndex> errors_with_tolerance(const Study& study, const StudySection& root);

}  // namespace poesy
