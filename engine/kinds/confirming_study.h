#pragma once

#include <string>

#include "engine/study/poses/pose_selection.h"
#include "engine/study/study.h"

/// Studies that confirm or refute what another one found. They need no file of the study that they were made of: what
/// came from files stands beside them.
namespace poesy {

/// A study of drawn errors as a Monte Carlo study of the same errors at the same poses, with the usual options. Its
/// files are named by name_files_beside().
Study as_confirming_study(Study study, const std::string& stem);

/// Poses that came from a file will be in STEM_poses.csv, a mechanism from a file in STEM_mechanism.toml.
void name_files_beside(Study& confirming, const std::string& stem);

/// Writes the named files into a folder, as far as the study needs them. poses: those of the study. Throws FileError.
void write_files_beside(const std::string& folder, const Study& confirming, const PoseSet& poses);

/// Writes the study as NAME.toml, which begins with the comment, if there is one, and which errors are held; gives the
/// path. Throws FileError.
std::string write_confirming_study(const std::string& folder, const std::string& name, const Study& confirming,
                                   const std::string& comment);

}  // namespace poesy
