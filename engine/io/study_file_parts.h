#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/io/study_file.h"
#include "engine/io/study_file_section.h"

namespace poesy {

/// Limits of what a study may ask for: far above any use, far below what breaks memory or arithmetic.
inline constexpr std::int64_t kMostPoses = 10'000'000;
inline constexpr std::int64_t kMostCells = 10'000'000;              ///< (factor, pose) pairs of a result
inline constexpr std::int64_t kMostSolves = 1'000'000'000'000'000;  ///< of a run

/// Each reads one part of a study file and throws InputError for the first thing that is wrong with it.
MechanismChoice read_mechanism(const StudySection& root, const Catalog& catalog);
/// For StudyUse::evaluate the pose file is not opened.
PoseSelection read_pose_selection(const StudySection& root, const ModelDescription& model, StudyUse use);
/// A file named by the study, relative to the study's folder.
std::string beside_study(const StudySection& section, const std::string& file);
/// Poses.max_condition.
double read_max_condition(const StudyValue& value);
/// What select = "trajectory" has besides; fills in `trajectory`, `count` and `place`. For StudyUse::evaluate the
/// trajectory may be absent and its file is not opened.
void read_trajectory_section(const StudySection& poses, const ModelDescription& model, StudyUse use,
                             PoseSelection& selection);
/// What errors of this dimension have that have no distribution of their own.
Distribution read_usual_distribution(const StudySection& root, Dimension dimension);
/// [errors].
ErrorModel read_error_model(const StudySection& root, const ModelDescription& model);
/// The cases of kind = "evaluate"; what a case does not set has the background's value.
std::vector<ErrorCase> read_cases(const StudySection& analysis, const ModelDescription& model,
                                  const std::vector<double>& background, StudyUse use);
/// The groups of kind = "identification".
std::vector<ErrorSize> read_groups(const StudySection& analysis);
/// A factor set, "all", or a list of names without repetition.
std::vector<FactorIndex> read_factors(const StudyValue& value, const ModelDescription& model);
/// A share between 0 and 1, both excluded.
double read_share(const StudyValue& value, std::string_view example);
/// `samples`, a number or the table of adaptive samples, and `conf_level`.
void read_samples(const StudySection& analysis_section, Analysis& analysis);
/// The text of `name`, which must not be among those that are taken; `usual` where there is none.
std::string read_name(const StudySection& section, std::span<const std::string_view> taken, const std::string& usual);
/// The keys of kind = "coupling". For StudyUse::evaluate sizes and sources may be missing.
CouplingStudy read_coupling(const StudySection& analysis, const ModelDescription& model, StudyUse use);
/// `limits`, `judge` and `share`, with the rules between them.
void read_limits(const StudySection& analysis_section, const ModelDescription& model, Analysis& analysis);
/// [analysis].
Analysis read_analysis(const StudySection& root, const ModelDescription& model, StudyUse use);

/// Throws InputError at its place for an error of the study that makes no sense on this model (Model::error_bound): the
/// standard deviation of one that varies, and the size of one that is held, tried, set by a case, or a reference
/// tolerance.
void check_error_bounds(const StudySection& root, const Study& study, const Model& model);

}  // namespace poesy
