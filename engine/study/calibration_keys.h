#pragma once

#include "engine/study/study_kind.h"

namespace poesy {

/// The description of the key `calibration` of [analysis]. Precondition for reading it: [poses] and [errors] of the
/// study have been read.
StudyRow calibration_row();

/// The description of [analysis.calibration] and its inner tables.
StudyTables calibration_tables();

/// Throws InputError if the study has a calibration that does not say what is measured. Used by kinds that simulate
/// calibrations. analysis: the section [analysis].
void check_simulated(const Study& study, const StudySection& analysis);

/// Makes the checks of check_simulated() for a study of calibrated machines. Also throws InputError if errors of a
/// machine change from pose to pose.
void check_simulated_machines(const Study& study, const StudySection& analysis);

/// Throws InputError if the study has a calibration but is of a kind that simulates none. analysis: the section
/// [analysis].
void refuse_calibration(const StudySection& analysis, const Study& study, const StudyKinds& kinds);

/// The errors that have a tolerance, ascending: those for which [errors] states a distribution. If the study has the
/// key `factors`, only errors that this key names. root: the whole file.
std::vector<FactorIndex> errors_with_tolerance(const Study& study, const StudySection& root);

}  // namespace poesy
