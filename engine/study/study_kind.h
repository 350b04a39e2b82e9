#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/schema/keys.h"
#include "engine/study/study_file.h"

/// The tables of a study file, as rows of keys. Each table of the file has a source file with the functions that read
/// and write keys that are more than a value. A kind of study adds one row of data and functions; null or empty members
/// add nothing. The rows of kinds are in engine/kinds; this code knows none of them.

namespace poesy {

/// The word for comparing a model's two fidelities.
inline constexpr std::string_view kBothFidelities = "both";

/// Limits on the size of a study: far above any use, and safe for memory and arithmetic.
inline constexpr std::int64_t kMostPoses = 10'000'000;
inline constexpr std::int64_t kMostCells = 10'000'000;              ///< (factor, pose) pairs of a result
inline constexpr std::int64_t kMostSolves = 1'000'000'000'000'000;  ///< solves of a run

struct StudyKinds;

/// What a row's reader may use in addition to the value.
struct Reading {
  const StudySection& root;  ///< the whole file
  const Catalog& catalog;    ///< catalog of mechanisms
  const StudyKinds& kinds;   ///< kinds of studies
  StudyUse use;              ///< which parts the command needs
  /// The content of the mechanism file, for a study stored beside it; null: the file is read.
  const std::string* mechanism_text = nullptr;
};

/// The scope of tables whose rows need only the value.
struct Nothing {};

using StudyRow = Key<Study, Reading>;    ///< A row of a study's own tables.
using StudyRows = Keys<Study, Reading>;  ///< A table of a study.
/// A row of a table inside a table.
template <class Object>
using InnerRow = Key<Object, Nothing>;
/// A table inside a table.
template <class Object>
using InnerRows = Keys<Object, Nothing>;

/// Which factors of a study vary together.
enum class Varies {
  none,        ///< every error has fixed values
  one_by_one,  ///< each alone, drawn from its distribution
  together     ///< all together, drawn from their distributions
};

/// The size of a study at each pose, and the words for the products from which it results.
struct AtPose {
  double values;               ///< numbers of one response in the result
  std::string_view of_values;  ///< words for these: "factors"
  double solves;               ///< solves of the mechanism
  std::string_view of_solves;  ///< words for these: "factors times samples"
};

/// The reason why something is not possible.
struct Refusal {
  std::string problem;  ///< a clause
  std::string remedy;   ///< advice
};

/// A kind of study: the part that study files use.
struct StudyKind {
  std::string_view name;                   ///< the word in a study file
  std::string_view asks;                   ///< a clause: "what each error does on its own"
  std::span<const std::string_view> keys;  ///< keys of [analysis], in the order of templates
  Varies varies = Varies::none;            ///< which factors vary together
  bool compares_fidelities = false;        ///< whether it can compare two fidelities
  bool draws_machines_anew = false;        ///< whether it tries several sets of machines, which cannot be given
  bool has_pose_before = false;            ///< whether the same errors are solved at all poses, whatever `draws` is
  bool decides_by_samples = false;         ///< whether changing `samples` invalidates a checkpoint
  std::string_view usual_factors = {};     ///< set of factors if a study names none; "all" for a model without it
  std::string_view usual_background = {};  ///< set of constant errors in templates, for models that have it
  std::string_view overrides = {};         ///< where a constant error may get another value: "a case sets"
  /// The rows of [analysis] that only this kind has. One with the name of a shared key replaces that key.
  std::vector<StudyRow> (*rows)() = nullptr;
  StudyTables (*tables)() = nullptr;  ///< tables inside [analysis]
  /// The reason why a study of this model cannot run.
  std::optional<Refusal> (*refusal)(const ModelDescription& model) = nullptr;
  /// The reason why there is no template for this model.
  std::optional<Refusal> (*no_template)(const ModelDescription& model) = nullptr;
  /// Completes the study and checks keys that depend on each other. Throws InputError.
  void (*complete)(Study& study, const Reading& reading) = nullptr;
  /// Throws InputError if an error in the kind's own keys makes no sense for this model (Model::error_bound).
  void (*check_errors)(const StudySection& analysis, const Study& study, const Model& model) = nullptr;
  AtPose (*at_pose)(const Study& study);  ///< the size of a study at each pose
  /// Turns a study of this kind into one that judges this yield; null: the kind judges no machines.
  void (*ask_yield)(Study& study, double yield) = nullptr;

  /// Whether the kind has this key of [analysis], except `kind` itself.
  bool has_key(std::string_view key) const;
};

/// The kinds of studies in a program, and the tables of their study files.
struct StudyKinds {
  std::vector<const StudyKind*> all;  ///< in the order in which users see them; the first one is the default
  StudyTables tables;                 ///< all tables of a study file, with all keys
};

/// The tables of these kinds. order: the keys of [analysis] in the order of the reference; keys that it lacks come
/// last.
StudyKinds study_kinds_of(std::vector<const StudyKind*> all, std::span<const std::string_view> order);

/// The kind of this name; null if there is none.
const StudyKind* find(const StudyKinds& kinds, std::string_view name);

std::vector<std::string_view> names(const StudyKinds& kinds);  ///< The names of the kinds, in order.

/// A value of the kind's options as a value of the study.
template <class Options>
KeyValue<Study> asked_value(KeyValue<Options> value) {
  KeyValue<Study> whole{.type = value.type, .bounds = value.bounds, .words = value.words};
  if (value.read) {
    whole.read = [read = value.read](const StudyValue& written, Study& study) {
      read(written, asked_of<Options>(study.analysis));
    };
  }
  if (value.text) {
    whole.text = [text = value.text](const Study& study) { return text(asked_of<Options>(study.analysis)); };
  }
  return whole;
}

/// The rows of the study's own tables; [analysis] has those of this kind.
/// @{
const StudyRows& file_keys();
const StudyRows& mechanism_keys();
const StudyRows& poses_keys();
const StudyRows& errors_keys();
StudyRows analysis_keys(const StudyKind& kind);
const StudyRows& solver_keys();
const StudyRows& run_keys();
/// @}

/// The same with their inner tables, for the reference.
/// @{
StudyTables mechanism_tables();
StudyTables response_tables();
StudyTables poses_tables();
StudyTables errors_tables();
StudyTables analysis_tables(std::span<const StudyKind* const> kinds, std::span<const std::string_view> order);
/// @}

/// The shared row of [analysis] with this name, from which a kind makes its own row. Precondition: the row exists.
StudyRow shared_analysis_row(std::string_view name);

/// Each of these functions reads a part of a study file. Throws InputError for the first problem.
/// @{
void read_mechanism(Study& study, const Reading& reading);
void read_responses(Study& study, const Reading& reading);  ///< After the solver, whose metric they are of.
void read_poses_section(Study& study, const Reading& reading);
/// Reads a table as [poses] into the study's selection of poses.
void read_pose_selection(const StudySection& section, Study& study, const Reading& reading);
void read_errors_section(Study& study, const Reading& reading);
void read_analysis(Study& study, const Reading& reading);
void read_solver(Study& study, const Reading& reading);
/// @}

/// The key [[response]].
StudyRow response_row();
/// Throws InputError if a response is relative to the pose before in a study without machines, or to any other pose if
/// machines draw errors anew at each pose.
void check_other_poses(const Study& study, const Reading& reading);

/// The distribution of errors of this dimension that have none of their own.
Distribution usual_distribution(const Reading& reading, Dimension dimension);
/// The row of `correlated` in [errors]. Precondition of reading: the distributions were read.
/// @{
StudyRow correlated_row();
StudyTable correlated_table();
/// @}
/// The row of `zones` in [errors]. Precondition of reading: the distributions of all lengths were read.
/// @{
StudyRow zones_row();
StudyTable zones_table();
/// @}
/// The errors of clearances, ascending, which a machine has anew at each pose.
std::vector<FactorIndex> clearance_errors(const ModelDescription& model);
/// Sets the errors of features by errors.zones, and those of clearances, which are drawn anew at each pose.
void set_by_zones(Study& study);
/// [F] the standard deviations (m) that errors.zones and clearances give; none of an error without them.
std::vector<std::optional<double>> sigmas_by_zones(const Study& study);
/// Throws InputError at the block's place if correlated errors do not vary together.
void check_correlated(const Study& study, const Reading& reading);
/// Throws InputError if machines are given to a study that does not draw machines, or more samples are asked for.
void check_machines(const Study& study, const Reading& reading);
/// The path of a file that the study names relative to its folder.
std::string beside_study(const StudySection& section, const std::string& file);
/// Reads a factor set, "all", or a list of names without repetition.
std::vector<FactorIndex> read_factors(const StudyValue& value, const ModelDescription& model);
/// Reads `name`, or returns `usual` if there is none. Throws if the name is taken.
std::string read_name(const StudySection& section, std::span<const std::string_view> taken, const std::string& usual);
/// The factors as TOML: the name of their set in quotes, or a list of names.
std::string factors_text(std::span<const FactorIndex> factors, const ModelDescription& model);
/// The factors as a TOML list of names, even if they are a set.
std::string factor_list_text(std::span<const FactorIndex> factors, const ModelDescription& model);
/// The factor sets of a model, as comment lines of a template.
std::string sets_comment(const ModelDescription& model);
/// A limit as a TOML table, on the displacement of the tool or of the platform (leading_rank), or else on the first
/// response that is a length, or on the first; empty for a model without responses.
std::string example_limits(const ModelDescription& model);
/// A comment line of a template with the model's responses, and its line of limits after `sign`; empty without
/// responses.
std::string template_limits(const TemplateLines& lines, const ModelDescription& model, std::string_view sign);
/// A length or an angle of this many millimetres or degrees, as templates show it: "1 mm" in quotes.
std::string example_size(Dimension dimension, double units);

/// Throws InputError at its place if an error of the study makes no sense for this model (Model::error_bound). Checks
/// the standard deviation of errors that vary, and the size of errors that are constant or that the kind sets.
void check_error_bounds(const StudySection& root, const Study& study, const Model& model);
/// The same for one error of this size, which `linear`, `angular` or `relative` of a section sets.
void check_error_size(const Model& model, FactorIndex factor, double size, const StudySection& section);
/// Throws for an error that is too large, at the value of this key, or at the section if it has no such key.
[[noreturn]] void refuse_error(const StudySection& section, std::string_view key, const std::string& problem);
/// The advice for an error that is too large.
inline constexpr std::string_view kTooLargeRemedy = "write a smaller one";

}  // namespace poesy
