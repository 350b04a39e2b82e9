#pragma once

#include <string>

#include "engine/study/poses/pose_selection.h"
#include "engine/study/study.h"

/// Studies that confirm or refute the result of another study. They do not need files of that study, because data that
/// came from files are written beside them.
namespace poesy {

/// Converts a study of drawn errors to a Monte Carlo study of the same errors at the same poses, with default options.
/// name_files_beside() names its files.
Study as_confirming_study(Study study, const std::string& stem);

/// Changes the paths: poses from a file will be in STEM_poses.csv, a mechanism from a file in STEM_mechanism.toml.
void name_files_beside(Study& confirming, const std::string& stem);

/// Writes the files that the study needs into a folder. poses: those of the study. Throws FileError.
void write_files_beside(const std::string& folder, const Study& confirming, const PoseSet& poses);

/// Writes the study as NAME.toml, beginning with the comment, if any, and with the errors that are constant. Returns
/// the path. Throws FileError.
std::string write_confirming_study(const std::string& folder, const std::string& name, const Study& confirming,
                                   const std::string& comment);

}  // namespace poesy
