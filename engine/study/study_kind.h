#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/schema/keys.h"
#include "engine/study/study_file.h"

/// The tables of a study file. A row of a table describes one key and has the functions that read and write it; longer
/// functions are in a source file for each table. A kind of study extends these tables by a StudyKind, which has data
/// and functions; a member that is null or empty adds nothing. The kinds are in engine/kinds; the files of this folder
/// know none of them.

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

/// The type of the additional argument of readers that need only the value of the key.
struct Nothing {};

using StudyRow = Key<Study, Reading>;    ///< A key of a study's own tables: description and functions.
using StudyRows = Keys<Study, Reading>;  ///< A table of a study.
/// A key of a table inside a section: description and functions.
template <class Object>
using InnerRow = Key<Object, Nothing>;
/// A table inside a section.
template <class Object>
using InnerRows = Keys<Object, Nothing>;

/// Which factors of a study vary at the same time.
enum class Varies {
  none,        ///< every error has fixed values
  one_by_one,  ///< factors vary one after the other, each drawn from its distribution while the others are constant
  together     ///< all factors vary together, drawn from their distributions
};

/// The number of values and solves of a study at each pose, with words that say how these numbers are computed.
struct AtPose {
  double values;               ///< number of values of one response in the result
  std::string_view of_values;  ///< the product that gives `values`, in words: "factors"
  double solves;               ///< number of solves of the mechanism
  std::string_view of_solves;  ///< the product that gives `solves`, in words: "factors times samples"
};

/// Why something is not possible, and what to do.
struct Refusal {
  std::string problem;  ///< reason, as a clause
  std::string remedy;   ///< advice to the user
};

/// What study files need to know of a kind of study.
struct StudyKind {
  std::string_view name;  ///< the word in a study file
  std::string_view asks;  ///< what a study of this kind finds out, as a clause: "what each error does on its own"
  std::span<const std::string_view> keys;  ///< keys of [analysis] that the kind has, in the order of templates
  Varies varies = Varies::none;            ///< how factors vary
  bool compares_fidelities = false;        ///< true if the kind can compare two fidelities
  Draws draws = Draws::per_pose;           ///< when errors are drawn if the study does not state it
  bool draws_machines_anew = false;        ///< true if the kind tries several sets of machines; none can be given then
  bool has_pose_before = false;            ///< true if all poses have the same errors for any value of `draws`
  bool decides_by_samples = false;         ///< true if changing `samples` invalidates a checkpoint
  std::string_view usual_factors = {};     ///< set of factors if a study names none; without this set, all
  std::string_view usual_background = {};  ///< set of constant errors in templates, for models with this set
  std::string_view overrides = {};         ///< who may give a constant error another value, in words: "a case sets"
  /// The rows of [analysis] that only this kind has. A row with the name of a shared key replaces this key.
  std::vector<StudyRow> (*rows)() = nullptr;
  StudyTables (*tables)() = nullptr;  ///< tables inside [analysis] that only this kind has
  /// The reason why a study of this kind cannot run with this model; none if it can.
  std::optional<Refusal> (*refusal)(const ModelDescription& model) = nullptr;
  /// The reason why there is no template of this kind for this model; none if there is one.
  std::optional<Refusal> (*no_template)(const ModelDescription& model) = nullptr;
  /// Completes the study and checks keys that depend on each other. Throws InputError.
  void (*complete)(Study& study, const Reading& reading) = nullptr;
  /// Throws InputError if an error in the kind's own keys is too large for this model (Model::error_bound).
  void (*check_errors)(const StudySection& analysis, const Study& study, const Model& model) = nullptr;
  /// A clause on what the study leaves as it is, which users see before a run; null or empty: nothing.
  std::string (*note)(const Study& study) = nullptr;
  AtPose (*at_pose)(const Study& study);  ///< numbers of values and solves of a study at each pose
  /// Turns a study of this kind into one that judges whether machines reach this yield; null: the kind judges no
  /// machines.
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

/// Makes the description of a key that is read into a study from one that is read into the kind's options (asked_of()).
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

/// The keys of the tables that each study has, as rows; analysis_keys() gives the keys of [analysis] for this kind.
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

/// The shared key of [analysis] with this name, from which a kind may make a row of its own. Precondition: the key
/// exists.
StudyRow shared_analysis_row(std::string_view name);

/// Each of these functions reads a part of a study file. They throw InputError at the first problem.
/// @{
void read_mechanism(Study& study, const Reading& reading);
/// Must be called after read_solver(), because the responses depend on the metric.
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
/// Throws InputError if a response is relative to the previous pose, but different errors are solved at each pose. Also
/// throws if a response is relative to any other pose, and machines draw varied errors anew at each pose.
void check_other_poses(const Study& study, const Reading& reading);

/// The distribution that the study states for errors of this dimension that have no distribution of their own.
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
/// The errors that are clearances, ascending. A machine draws them anew at each pose.
std::vector<FactorIndex> clearance_errors(const ModelDescription& model);
/// Gives the errors of features the distributions for which errors.zones asks. Also gives clearances their
/// distributions, and lets machines draw them anew at each pose.
void set_by_zones(Study& study);
/// For each factor of the model: the distribution that errors.zones gives to it, or that it has as a clearance; none
/// for other errors. Errors of a feature that are drawn together get normal distributions with the same standard
/// deviations.
std::vector<std::optional<Distribution>> distributions_by_zones(const Study& study);
/// The features of a study whose errors vary and are drawn together (drawing::ZoneDraws).
std::vector<Feature> features_drawn_together(const Study& study);
/// Throws InputError if the errors of a feature that are drawn together do not all vary, are correlated, or are drawn
/// partly per pose and partly per machine.
void check_zones(const Study& study, const Reading& reading);
/// Returns true if [errors] states the size of an error, by its dimension or by a key of [errors.override].
bool states_size(const StudySection& errors, const Factor& factor);
/// Throws InputError if an error of a feature varies but neither errors.zones nor another key states its size. For such
/// an error the default size of lengths makes no sense. For other errors without a stated size, adds a warning that
/// names the default to study.doubts. of_parts: errors whose sizes the kind of study finds itself.
void check_error_sizes(Study& study, const Reading& reading, std::span<const FactorIndex> of_parts = {});
/// Throws InputError at the block's place if correlated errors do not vary together.
void check_correlated(const Study& study, const Reading& reading);
/// Throws InputError at errors.machines if machines are given to a study that does not take them, if a column is an
/// error that the study does not vary, or if the study asks for more samples than there are machines.
void check_machines(const Study& study, const Reading& reading);
/// The path of a file that the study names relative to its folder. place: any place in the study.
std::string beside_study(const Place& place, const std::string& file);
/// The path of the file that a value names relative to the study's folder. Throws at the value's place: FileError if
/// the file cannot be opened, InputError if it is a folder or a device.
std::string named_file(const StudyValue& value);
/// Reads a factor set, "all", or a list of names without repetition.
std::vector<FactorIndex> read_factors(const StudyValue& value, const Study& study);
/// The advice "'poesy models MECHANISM' lists them": MECHANISM is the file of the study's mechanism, or its name.
std::string listed_by_models(const Study& study);
/// Reads the key `name`; returns `usual` if the section lacks this key. Throws InputError if the name is taken.
std::string read_name(const StudySection& section, std::span<const std::string_view> taken, const std::string& usual);
/// The factors as TOML: the name of their set in quotes, or a list of names.
std::string factors_text(std::span<const FactorIndex> factors, const ModelDescription& model);
/// The factors as a TOML list of names, even if they are a set.
std::string factor_list_text(std::span<const FactorIndex> factors, const ModelDescription& model);
/// The factor sets of a model, as comment lines of a template.
std::string sets_comment(const ModelDescription& model);
/// An example of a limit as a TOML table. It limits the displacement of the tool or of the platform (leading_rank) if
/// the model has such a response, otherwise the first response that is a length, or the first response. Empty for a
/// model without responses.
std::string example_limits(const ModelDescription& model);
/// Lines of a template that list the model's responses in a comment and show example_limits(). Each line begins with
/// `sign`. Empty for a model without responses.
std::string template_limits(const TemplateLines& lines, const ModelDescription& model, std::string_view sign);
/// A length or an angle of this number of millimetres or degrees, as templates show it: "1 mm" in quotes.
std::string example_size(Dimension dimension, double units);

/// Throws InputError if an error of the study is too large for this model (Model::error_bound), at the place of the key
/// that states it. Checks the standard deviations of errors that vary, and the sizes of errors that are constant or
/// that the kind sets.
void check_error_bounds(const StudySection& root, const Study& study, const Model& model);
/// Checks one error of this size (SI), which the key `linear`, `angular` or `relative` of the section sets. Throws
/// InputError if it is too large for this model.
void check_error_size(const Model& model, FactorIndex factor, double size, const StudySection& section);
/// Throws InputError for an error that is too large, at the value of this key, or at the section if it lacks the key.
[[noreturn]] void refuse_error(const StudySection& section, std::string_view key, const std::string& problem);
/// The advice for an error that is too large.
inline constexpr std::string_view kTooLargeRemedy = "write a smaller one";

}  // namespace poesy
