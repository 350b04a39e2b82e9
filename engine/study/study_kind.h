#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/schema/keys.h"
#include "engine/study/study_file.h"

/// The tables of a study file. A row of a table describes one key, and has the functions that read and write it. Each
/// table has its own source file (*_keys.cpp). A kind of study adds keys and tables by a StudyKind, which has data and
/// functions; a member that is null or empty adds nothing. The kinds are defined in engine/kinds; the code of
/// engine/study depends on none of them.

namespace poesy {

/// The word in a study file that asks to compare a model's two fidelities.
inline constexpr std::string_view kBothFidelities = "both";

/// Limits on the size of a study: far larger than useful studies, and safe for memory and arithmetic.
inline constexpr std::int64_t kMostPoses = 10'000'000;
inline constexpr std::int64_t kMostCells = 10'000'000;  ///< largest number of values in a result for one response
inline constexpr std::int64_t kMostSolves = 1'000'000'000'000'000;  ///< largest number of solves of a run

struct StudyKinds;

/// What the reader of a key may use in addition to the value of the key.
struct Reading {
  const StudySection& root;  ///< the whole study file
  const Catalog& catalog;    ///< catalog of mechanisms
  const StudyKinds& kinds;   ///< kinds of studies in the program
  StudyUse use;              ///< purpose for which the study is read
  /// The content of the mechanism file, if it is stored with the study; null: the file is read.
  const std::string* mechanism_text = nullptr;
};

/// The Scope (see Key) of keys whose readers need only the value of the key.
struct Nothing {};

using StudyRow = Key<Study, Reading>;    ///< A key of a section, such as [poses].
using StudyRows = Keys<Study, Reading>;  ///< A section with its keys.
/// A key of a table inside a section, such as [analysis.background], which is read into an `Object`.
template <class Object>
using InnerRow = Key<Object, Nothing>;
/// A table inside a section, with its keys.
template <class Object>
using InnerRows = Keys<Object, Nothing>;

/// Which factors of a study vary at the same time.
enum class Varies {
  none,        ///< every error has fixed values
  one_by_one,  ///< one factor varies at a time, drawn from its distribution, while the others are constant
  together     ///< all factors vary together, drawn from their distributions
};

/// The number of values and of solves of a study at each pose, each also as a product in words.
struct AtPose {
  double values;               ///< number of values of one response in the result
  std::string_view of_values;  ///< `values` as a product in words: "factors"
  double solves;               ///< number of solves of the mechanism
  std::string_view of_solves;  ///< `solves` as a product in words: "factors times samples"
};

/// Why something is not possible, and what to do.
struct Refusal {
  std::string problem;  ///< reason, as a clause
  std::string remedy;   ///< advice to the user
};

/// The properties of a kind of study that the reader and writer of study files need.
struct StudyKind {
  std::string_view name;  ///< word for the kind in a study file
  std::string_view asks;  ///< what a study of this kind finds out, as a clause: "what each error does on its own"
  std::span<const std::string_view> keys;  ///< keys of [analysis] that the kind has, in the order of templates
  Varies varies = Varies::none;            ///< how factors vary
  bool compares_fidelities = false;        ///< true if the kind can compare two fidelities
  Draws draws = Draws::per_pose;           ///< when errors are drawn if the study does not state it
  /// True if the kind draws several sets of machines, so that a study cannot give the machines.
  bool draws_machines_anew = false;
  bool finds_sizes = false;  ///< true if the study finds the sizes of errors itself
  /// True if a sample has the same errors at all poses for any value of `draws`, so responses may be relative to the
  /// previous pose.
  bool has_pose_before = false;
  bool decides_by_samples = false;  ///< true if changing `samples` invalidates a checkpoint
  /// Name of the factor set that varies if a study names none; all factors if the model lacks this set.
  std::string_view usual_factors = {};
  /// Name of the factor set that templates hold constant, if the model has this set.
  std::string_view usual_background = {};
  /// What may change a constant error: "a case sets", as in "unless a case sets another value". Empty: nothing may.
  std::string_view overrides = {};
  /// The rows of [analysis] that only this kind has. A row with the name of a shared key replaces this key.
  std::vector<StudyRow> (*rows)() = nullptr;
  StudyTables (*tables)() = nullptr;  ///< tables inside [analysis] that only this kind has
  /// The reason why a study of this kind cannot run with this model; none if it can.
  std::optional<Refusal> (*refusal)(const ModelDescription& model) = nullptr;
  /// The reason why there is no template of this kind for this model; none if there is one.
  std::optional<Refusal> (*no_template)(const ModelDescription& model) = nullptr;
  /// Sets members of the study that follow from several keys, and checks keys that depend on each other. Throws
  /// InputError.
  void (*complete)(Study& study, const Reading& reading) = nullptr;
  /// Throws InputError if an error in the kind's own keys is too large for this model (Model::error_bound).
  void (*check_errors)(const StudySection& analysis, const Study& study, const Model& model) = nullptr;
  /// Returns a remark on the study that users see before a run, as a clause; null or an empty text: there is no remark.
  std::string (*note)(const Study& study) = nullptr;
  AtPose (*at_pose)(const Study& study);  ///< returns the numbers of values and solves of a study at each pose
  /// Changes a study of this kind so that it judges whether machines reach this yield; null: the kind cannot judge
  /// that.
  void (*ask_yield)(Study& study, double yield) = nullptr;

  /// Returns true if the kind has this key of [analysis]. The key `kind`, which all kinds have, does not count.
  bool has_key(std::string_view key) const;
};

/// The kinds of studies in a program, and all tables of their study files.
struct StudyKinds {
  std::vector<const StudyKind*> all;  ///< kinds, in the order in which users see them; the first one is the default
  StudyTables tables;                 ///< all tables of a study file, with all keys
};

/// Makes the tables of these kinds. order: names of the keys of [analysis] in the order of the reference; other keys
/// come last.
StudyKinds study_kinds_of(std::vector<const StudyKind*> all, std::span<const std::string_view> order);

/// The kind of this name; null if there is none.
const StudyKind* find(const StudyKinds& kinds, std::string_view name);

std::vector<std::string_view> names(const StudyKinds& kinds);  ///< The names of the kinds, in order.

/// Converts the KeyValue of a member of the kind's options (asked_of()) to the KeyValue of the same key in a study.
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

/// The keys of the tables that each study has, as rows; analysis_keys() returns the keys of [analysis] for one kind of
/// study.
/// @{
const StudyRows& file_keys();
const StudyRows& mechanism_keys();
const StudyRows& poses_keys();
const StudyRows& errors_keys();
StudyRows analysis_keys(const StudyKind& kind);
const StudyRows& solver_keys();
const StudyRows& run_keys();
/// @}

/// The tables of a study together with the tables inside them, for the reference.
/// @{
StudyTables mechanism_tables();
StudyTables response_tables();
StudyTables poses_tables();
StudyTables errors_tables();
StudyTables analysis_tables(std::span<const StudyKind* const> kinds, std::span<const std::string_view> order);
/// @}

/// The key of [analysis] with this name that several kinds of study share. A kind may copy and change it. Precondition:
/// the key exists.
StudyRow shared_analysis_row(std::string_view name);

/// Each of these functions reads one section of a study file, or one table of it. They throw InputError at the first
/// problem.
/// @{
void read_mechanism(Study& study, const Reading& reading);
/// Reads [[response]]. Must be called after read_solver(), because the responses depend on the metric.
void read_responses(Study& study, const Reading& reading);
void read_poses_section(Study& study, const Reading& reading);
/// Reads a table with the keys of [poses] into the study's selection of poses.
void read_pose_selection(const StudySection& section, Study& study, const Reading& reading);
void read_errors_section(Study& study, const Reading& reading);
void read_analysis(Study& study, const Reading& reading);
void read_solver(Study& study, const Reading& reading);
/// @}

/// The key [[response]].
StudyRow response_row();
/// Throws InputError if a response is relative to the previous pose, but samples have different errors at each pose.
/// Also throws if any response is relative to a pose, but machines draw some of the varied errors anew at each pose.
void check_other_poses(const Study& study, const Reading& reading);

/// The distribution of errors of this dimension that are not in [errors.override]: from errors.linear, errors.angular
/// or errors.relative, or the default.
Distribution usual_distribution(const Reading& reading, Dimension dimension);
/// The key `correlated` of [errors], which must be read after the distributions, and the table of its keys.
/// @{
StudyRow correlated_row();
StudyTable correlated_table();
/// @}
/// The key `zones` of [errors], which must be read after the distribution of lengths, and the table of its keys.
/// @{
StudyRow zones_row();
StudyTable zones_table();
/// @}
/// The errors of features that have a clearance (Feature::clearance), ascending. A machine draws them anew at each
/// pose.
std::vector<FactorIndex> clearance_errors(const ModelDescription& model);
/// Sets the distributions of the errors of features: those that follow from errors.zones, and those of clearances,
/// which machines draw anew at each pose.
void set_by_zones(Study& study);
/// [factors of the model] The distribution that an error has by errors.zones or as a clearance; none for other errors.
/// For errors of a feature that are drawn together, it is the normal distribution with the same standard deviation.
std::vector<std::optional<Distribution>> distributions_by_zones(const Study& study);
/// The features of a study whose errors vary and are drawn together (drawing::ZoneDraws).
std::vector<Feature> features_drawn_together(const Study& study);
/// Throws InputError if the errors of a feature that are drawn together do not all vary, are correlated, or are drawn
/// partly per pose and partly per machine.
void check_zones(const Study& study, const Reading& reading);
/// Returns true if [errors] states the size of an error, by its dimension or by a key of [errors.override].
bool states_size(const StudySection& errors, const Factor& factor);
/// Sets ErrorModel::unused_zone. If the study is read for a run, also checks the sizes of the errors that vary. Throws
/// InputError if neither errors.zones nor another key states the size of an error of a feature, because the default
/// size of lengths makes no sense for it. If the mechanism is from a file, adds to study.doubts a warning that names
/// the default for other errors without a stated size. of_parts: errors that are not checked, because the kind of study
/// finds their sizes.
void check_error_sizes(Study& study, const Reading& reading, std::span<const FactorIndex> of_parts = {});
/// Throws InputError at the key `correlated` if correlated errors do not all vary together.
void check_correlated(const Study& study, const Reading& reading);
/// Throws InputError at errors.machines if machines are given to a study that does not take them, if a column is an
/// error that the study does not vary, or if the study asks for more samples than there are machines.
void check_machines(const Study& study, const Reading& reading);
/// The path of a file whose name in the study is relative to the study's folder. place: any place in the study.
std::string beside_study(const Place& place, const std::string& file);
/// The path of the file that a value names relative to the study's folder. Throws at the value's place: FileError if
/// the file cannot be opened, InputError if it is a folder or a device.
std::string named_file(const StudyValue& value);
/// Reads the name of a factor set, "all", or a list of names of factors and patterns such as "rod_*". Throws InputError
/// if a name is repeated.
std::vector<FactorIndex> read_factors(const StudyValue& value, const Study& study);
/// The advice "'poesy models MECHANISM' lists them": MECHANISM is the file of the study's mechanism, or its name.
std::string listed_by_models(const Study& study);
/// Reads the key `name`; returns `usual` if the section lacks this key. Throws InputError if the name is in `taken`, or
/// breaks the rule of label_problem().
std::string read_name(const StudySection& section, std::span<const std::string_view> taken, const std::string& usual);
/// The factors as TOML: the name of their set in quotes, or a list of names.
std::string factors_text(std::span<const FactorIndex> factors, const ModelDescription& model);
/// The factors as a TOML list of names, even if they form a set.
std::string factor_list_text(std::span<const FactorIndex> factors, const ModelDescription& model);
/// The factor sets of a model, as comment lines of a template.
std::string sets_comment(const ModelDescription& model);
/// An example of a limit as a TOML table. It limits the displacement of the tool or of the platform (leading_rank) if
/// the model has such a response, otherwise the first response that is a length, or the first response. Empty for a
/// model without responses.
std::string example_limits(const ModelDescription& model);
/// Lines of a template that list the model's responses in a comment, show example_limits() in a line "limits = ...",
/// and explain the key. sign: text before the line "limits = ...", such as "# ". Empty for a model without responses.
std::string template_limits(const TemplateLines& lines, const ModelDescription& model, std::string_view sign);
/// A quantity as templates write it: "1 mm" in quotes. units: its value in the unit in which results show the dimension
/// (mm, deg, N, ...).
std::string example_size(Dimension dimension, double units);

/// Throws InputError if an error of the study is too large for this model (Model::error_bound), at the place of the key
/// that states it. Checks the distributions of errors that vary, and the sizes of errors that are constant or that the
/// kind sets. Also throws if errors of calibrated machines are drawn anew at each pose.
void check_error_bounds(const StudySection& root, const Study& study, const Model& model);
/// Throws InputError if an error of this size (SI) is too large for this model. section: the table whose key `linear`,
/// `angular` or `relative` states the size.
void check_error_size(const Model& model, FactorIndex factor, double size, const StudySection& section);
/// Throws InputError with this problem, for an error that is too large: at the value of the key, or at the section if
/// it lacks the key.
[[noreturn]] void refuse_error(const StudySection& section, std::string_view key, const std::string& problem);
/// The advice for an error that is too large.
inline constexpr std::string_view kTooLargeRemedy = "write a smaller one";

}  // namespace poesy
