#pragma once

#include <string>
#include <vector>

#include "engine/study/poses/pose_selection.h"
#include "engine/study/study.h"

/// Studies that confirm or refute the result of an original study. They do not need the original's files, because
/// write_files_beside() writes files with the same contents.
namespace poesy {

/// Converts a study of drawn errors to a Monte Carlo study of the same errors at the same poses, with default options.
/// stem: first part of the names of its files, as in name_files_beside().
Study as_confirming_study(Study study, const std::string& stem);

/// Sets the paths of the files that the study will read: STEM_poses.csv for poses from a file, STEM_measured.csv for
/// the poses of a calibration from a file, STEM_mechanism.toml for a mechanism from a file. STEM is `stem`.
void name_files_beside(Study& confirming, const std::string& stem);

/// The names of the files that write_files_beside() writes.
std::vector<std::string> files_beside(const Study& confirming);

/// Writes into a folder the files that the study reads; files_beside() lists their names. poses: the poses of the
/// study. Throws FileError.
void write_files_beside(const std::string& folder, const Study& confirming, const PoseSet& poses);

/// Writes a study as NAME.toml and returns the path. The file begins with a comment on the errors that are held
/// constant, if there are any, and with `comment`, if it is not empty. Throws FileError.
std::string write_confirming_study(const std::string& folder, const std::string& name, const Study& confirming,
                                   const std::string& comment);

}  // namespace poesy
