#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/study/study_file.h"
#include "engine/schema/keys.h"

/// The tables of a study file: rows of keys, with what reads and writes those that are more than a value. One file for
/// each table of the file, with the tables inside it.

namespace poesy {

/// Limits of what a study may ask for: far above any use, far below what breaks memory or arithmetic.
inline constexpr std::int64_t kMostPoses = 10'000'000;
inline constexpr std::int64_t kMostCells = 10'000'000;              ///< (factor, pose) pairs of a result
inline constexpr std::int64_t kMostSolves = 1'000'000'000'000'000;  ///< of a run

/// What a row's reader may look at in addition to the value.
struct Reading {
  const StudySection& root;  ///< the whole file
  const Catalog& catalog;    ///< of mechanisms
  StudyUse use;              ///< how much must be there
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

/// The rows of the study's own tables.
/// @{
const StudyRows& file_keys();
const StudyRows& mechanism_keys();
const StudyRows& poses_keys();
const StudyRows& errors_keys();
const StudyRows& analysis_keys();
const StudyRows& solver_keys();
const StudyRows& run_keys();
/// @}

/// The same with the tables inside them, as they are described.
/// @{
StudyTables mechanism_tables();
StudyTables poses_tables();
StudyTables errors_tables();
StudyTables analysis_tables();
StudyTables case_tables();
StudyTable group_table();
StudyTable source_table();
/// @}

/// Every table of a study file, with every key.
const StudyTables& study_tables();

/// The keys of [analysis] that hold for this kind, in the order of its templates.
std::span<const std::string_view> keys_of(Analysis::Kind kind);

/// The rows of [analysis] that only some kinds have.
/// @{
StudyRow groups_row();
StudyRow cases_row();
std::vector<StudyRow> coupling_rows_of_keys();
/// @}

/// Each reads a part of a study file and throws InputError for the first thing that is wrong with it.
/// @{
void read_mechanism(Study& study, const Reading& reading);
void read_poses_section(Study& study, const Reading& reading);
void read_errors_section(Study& study, const Reading& reading);
void read_analysis(Study& study, const Reading& reading);
void read_solver(Study& study, const Reading& reading);
/// What kind = "coupling" asks of its keys together; fills in the literature's sources.
void complete_coupling(Study& study, const Reading& reading);
/// @}

/// A file named by the study, relative to the study's folder.
std::string beside_study(const StudySection& section, const std::string& file);
/// What errors of this dimension have that have no distribution of their own.
Distribution usual_distribution(const StudySection& root, Dimension dimension);
/// A factor set, "all", or a list of names without repetition.
std::vector<FactorIndex> read_factors(const StudyValue& value, const ModelDescription& model);
/// The text of `name`, which must not be among those that are taken; `usual` where there is none.
std::string read_name(const StudySection& section, std::span<const std::string_view> taken, const std::string& usual);
/// The group of an identification study that names none.
ErrorSize usual_group();

/// Throws InputError at its place for an error of the study that makes no sense on this model (Model::error_bound): the
/// standard deviation of one that varies, and the size of one that is held, tried, set by a case, or a reference
/// tolerance.
void check_error_bounds(const StudySection& root, const Study& study, const Model& model);

}  // namespace poesy
