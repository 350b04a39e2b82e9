#pragma once

#include "engine/study/study_kind.h"

namespace poesy {

/// The row (description and functions) of the key `calibration` in [analysis]. Its reader needs a study whose [poses]
/// and [errors] have been read.
StudyRow calibration_row();

/// The tables of the keys of a calibration.
StudyTables calibration_tables();

/// Throws InputError if a study that simulates calibrations does not say what is measured. analysis: the section
/// [analysis].
void check_simulated(const Study& study, const StudySection& analysis);

/// Makes the checks of check_simulated() for a study of calibrated machines. Also throws InputError if errors of a
/// machine change from pose to pose.
void check_simulated_machines(const Study& study, const StudySection& analysis);

/// Refuses a calibration in a study whose kind does not simulate it. analysis: its section.
void refuse_calibration(const StudySection& analysis, const Study& study, const StudyKinds& kinds);

/// The errors that have a tolerance, ascending: those whose distribution [errors] states. If the study has the key
/// `factors`, only errors that this key names. root: the whole file.
std::vector<FactorIndex> errors_with_tolerance(const Study& study, const StudySection& root);

}  // namespace poesy
