#pragma once

#include "engine/study/study_kind.h"

namespace poesy {

/// The description of the key `calibration` of [analysis]. [poses] and [errors] must be read before this key.
StudyRow calibration_row();

/// The description of [analysis.calibration] and its inner tables.
StudyTables calibration_tables();

/// Throws InputError if the study has a calibration that does not state what is measured. Called for kinds of study
/// that simulate calibrations. analysis: the section [analysis].
void check_simulated(const Study& study, const StudySection& analysis);

/// Does the check of check_simulated() for a study of calibrated machines. Also throws InputError if the study has a
/// calibration and some errors are drawn anew at each pose.
void check_simulated_machines(const Study& study, const StudySection& analysis);

/// Throws InputError if the study has a calibration, but its kind of study does not simulate calibrations. kinds: all
/// kinds of study; the message names those that simulate calibrations. analysis: the section [analysis].
void refuse_calibration(const StudySection& analysis, const Study& study, const StudyKinds& kinds);

/// The errors for which [errors] states a distribution, ascending. If [analysis] has the key `factors`, only errors
/// that this key names. root: the whole file.
std::vector<FactorIndex> errors_with_tolerance(const Study& study, const StudySection& root);

}  // namespace poesy
