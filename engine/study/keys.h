#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/schema/keys.h"
#include "engine/study/study_file.h"

/// The tables of a study file: rows of keys, with what reads and writes those that are more than a value. One file for
/// each table of the file, with the tables inside it.

namespace poesy {

/// Limits of what a study may ask for: far above any use, far below what breaks memory or arithmetic.
inline constexpr std::int64_t kMostPoses = 10'000'000;
inline constexpr std::int64_t kMostCells = 10'000'000;              ///< (factor, pose) pairs of a result
inline constexpr std::int64_t kMostSolves = 1'000'000'000'000'000;  ///< of a run

struct StudyKinds;

/// What a row's reader may look at in addition to the value.
struct Reading {
  const StudySection& root;  ///< the whole file
  const Catalog& catalog;    ///< of mechanisms
  const StudyKinds& kinds;   ///< of studies
  StudyUse use;              ///< how much must be there
  /// What a study that is kept beside its mechanism's file says; null: the file is read.
  const std::string* mechanism_text = nullptr;
};

/// The scope of tables whose rows need the value alone.
struct Nothing {};

/// A row of a study's own tables.
using StudyRow = Key<Study, Reading>;
/// A table of a study.
using StudyRows = Keys<Study, Reading>;
/// A row of a table inside one.
template <class Object>
using InnerRow = Key<Object, Nothing>;
/// A table inside one.
template <class Object>
using InnerRows = Keys<Object, Nothing>;

/// The rows of the study's own tables; those of [analysis] as this kind has them.
/// @{
const StudyRows& file_keys();
const StudyRows& mechanism_keys();
const StudyRows& poses_keys();
const StudyRows& errors_keys();
StudyRows analysis_keys(const StudyKind& kind);
const StudyRows& solver_keys();
const StudyRows& run_keys();
/// @}

/// The same with the tables inside them, as they are described.
/// @{
StudyTables mechanism_tables();
StudyTables poses_tables();
StudyTables errors_tables();
StudyTables analysis_tables(std::span<const StudyKind* const> kinds, std::span<const std::string_view> order);
/// @}

/// Each reads a part of a study file and throws InputError for the first thing that is wrong with it.
/// @{
void read_mechanism(Study& study, const Reading& reading);
void read_poses_section(Study& study, const Reading& reading);
void read_errors_section(Study& study, const Reading& reading);
void read_analysis(Study& study, const Reading& reading);
void read_solver(Study& study, const Reading& reading);
/// @}

/// A file named by the study, relative to the study's folder.
std::string beside_study(const StudySection& section, const std::string& file);
/// What errors of this dimension have that have no distribution of their own.
Distribution usual_distribution(const StudySection& root, Dimension dimension);
/// A factor set, "all", or a list of names without repetition.
std::vector<FactorIndex> read_factors(const StudyValue& value, const ModelDescription& model);
/// The text of `name`, which must not be among those that are taken; `usual` where there is none.
std::string read_name(const StudySection& section, std::span<const std::string_view> taken, const std::string& usual);
/// The factor sets of a model in comment lines of a template.
std::string sets_comment(const ModelDescription& model);
/// A length or an angle of so many millimetres or degrees, as templates show it: "1 mm" in quotes.
std::string example_size(Dimension dimension, double units);

/// Throws InputError at its place for an error of the study that makes no sense on this model (Model::error_bound): the
/// standard deviation of one that varies, and the size of one that is held, or that the kind sets.
void check_error_bounds(const StudySection& root, const Study& study, const Model& model);
/// The same for one error of these sizes, which `linear` and `angular` of a section set.
void check_error_size(const Model& model, FactorIndex factor, double linear, double angular,
                      const StudySection& section);
/// Throws for an error that is too large, at the section's value of this key, or at the section where it has none.
[[noreturn]] void refuse_error(const StudySection& section, std::string_view key, const std::string& problem);
/// What to do about an error that is too large.
inline constexpr std::string_view kTooLargeRemedy = "write a smaller one";

}  // namespace poesy
