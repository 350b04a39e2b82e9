#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/schema/keys.h"
#include "engine/study/study_file.h"

/// The tables of a study file: rows of keys, with what reads and writes those that are more than a value, in one file
/// for each table of the file. And what a kind of study adds to them: one row of data and functions, null or empty for
/// nothing. engine/kinds has the rows of kinds; nothing here knows one of them.

namespace poesy {

/// The word for the comparison of a model's two fidelities.
inline constexpr std::string_view kBothFidelities = "both";

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

using StudyRow = Key<Study, Reading>;    ///< A row of a study's own tables.
using StudyRows = Keys<Study, Reading>;  ///< A table of a study.
/// A row of a table inside one.
template <class Object>
using InnerRow = Key<Object, Nothing>;
/// A table inside one.
template <class Object>
using InnerRows = Keys<Object, Nothing>;

/// Which of a study's factors vary at once.
enum class Varies {
  none,        ///< every error has fixed sizes
  one_by_one,  ///< each alone, drawn from its distribution
  together     ///< all, drawn from their distributions
};

/// What a study asks for at each pose, and what these numbers are the product of.
struct AtPose {
  double values;               ///< of one response that the result keeps
  std::string_view of_values;  ///< "factors"
  double solves;               ///< of the mechanism
  std::string_view of_solves;  ///< "factors times samples"
};

/// Why something cannot be had.
struct Refusal {
  std::string problem;  ///< a clause
  std::string remedy;   ///< what to do
};

/// A kind of study, as study files know it.
struct StudyKind {
  std::string_view name;                   ///< as a study file has it
  std::string_view asks;                   ///< a clause: "what each error does on its own"
  std::span<const std::string_view> keys;  ///< of [analysis], in the order of its templates
  Varies varies = Varies::none;            ///< which factors vary at once
  bool compares_fidelities = false;        ///< whether it may solve at two fidelities
  bool decides_by_samples = false;      ///< what it solves depends on all samples: no run goes on from one with fewer
  std::string_view usual_factors = {};  ///< the set taken where a study names none; "all" for a model without it
  std::string_view usual_background = {};  ///< the set that templates hold, for models that have it
  std::string_view overrides = {};         ///< "a case sets": where a held error may have another value
  /// Of [analysis], those that it alone has; one with the name of a shared key takes that key's place.
  std::vector<StudyRow> (*rows)() = nullptr;
  StudyTables (*tables)() = nullptr;  ///< inside these
  /// Why such a study of this model cannot run.
  std::optional<Refusal> (*refusal)(const ModelDescription& model) = nullptr;
  /// Why there is no template for this model.
  std::optional<Refusal> (*no_template)(const ModelDescription& model) = nullptr;
  /// Fills in and checks what its keys say together. Throws InputError.
  void (*complete)(Study& study, const Reading& reading) = nullptr;
  /// Throws InputError for an error of its own keys that makes no sense on this model (Model::error_bound).
  void (*check_errors)(const StudySection& analysis, const Study& study, const Model& model) = nullptr;
  AtPose (*at_pose)(const Study& study);  ///< what a study of it asks for
  /// Makes a study, already of this kind, one of machines of which this share must keep all limits; null: it judges no
  /// machines.
  void (*ask_yield)(Study& study, double yield) = nullptr;

  /// Whether a key of [analysis] holds for it; `kind` itself is none of its keys.
  bool has_key(std::string_view key) const;
};

/// The kinds of studies that a program offers, and the study files that they make.
struct StudyKinds {
  std::vector<const StudyKind*> all;  ///< in the order in which they are offered; the first one is the default
  StudyTables tables;                 ///< every table of a study file, with every key
};

/// Of these kinds. order: the keys of [analysis] as the reference lists them; those that it lacks come last.
StudyKinds study_kinds_of(std::vector<const StudyKind*> all, std::span<const std::string_view> order);

/// The kind of this name; null where there is none.
const StudyKind* find(const StudyKinds& kinds, std::string_view name);

std::vector<std::string_view> names(const StudyKinds& kinds);  ///< Their names, in order.

/// A value of what the kind alone asks, as a value of the study.
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

/// The row of [analysis] of this name that several kinds share, for one that takes its place. Precondition: there is
/// such a row.
StudyRow shared_analysis_row(std::string_view name);

/// Each reads a part of a study file and throws InputError for the first thing that is wrong with it.
/// @{
void read_mechanism(Study& study, const Reading& reading);
void read_poses_section(Study& study, const Reading& reading);
void read_errors_section(Study& study, const Reading& reading);
void read_analysis(Study& study, const Reading& reading);
void read_solver(Study& study, const Reading& reading);
/// @}

/// What errors of this dimension have that have no distribution of their own.
Distribution usual_distribution(const Reading& reading, Dimension dimension);
/// [errors] correlated: how it is read, written and described. The distributions must have been read.
/// @{
StudyRow correlated_row();
StudyTable correlated_table();
/// @}
/// Throws InputError at the block's place where correlated errors do not vary together.
void check_correlated(const Study& study, const Reading& reading);
/// A file named by the study, relative to the study's folder.
std::string beside_study(const StudySection& section, const std::string& file);
/// A factor set, "all", or a list of names without repetition.
std::vector<FactorIndex> read_factors(const StudyValue& value, const ModelDescription& model);
/// The text of `name`, which must not be among those that are taken; `usual` where there is none.
std::string read_name(const StudySection& section, std::span<const std::string_view> taken, const std::string& usual);
/// The name of their set in quotes, or the factors as a TOML list of names.
std::string factors_text(std::span<const FactorIndex> factors, const ModelDescription& model);
/// The factors as a TOML list of names, whether they are a set or not.
std::string factor_list_text(std::span<const FactorIndex> factors, const ModelDescription& model);
/// The factor sets of a model in comment lines of a template.
std::string sets_comment(const ModelDescription& model);
/// A limit of the model's first response that is a length, else of its first one, as a TOML table; empty for a model
/// without responses.
std::string example_limits(const ModelDescription& model);
/// The model's responses in a comment line of a template, and its line of limits behind `sign`; empty without
/// responses.
std::string template_limits(const TemplateLines& lines, const ModelDescription& model, std::string_view sign);
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
