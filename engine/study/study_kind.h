#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/study/keys.h"

/// What a kind of study adds to study files: one row of data and functions, null or empty for nothing. engine/kinds has
/// the rows; nothing here knows one of them.

namespace poesy {

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
  std::string_view name;                      ///< as a study file has it
  std::string_view asks;                      ///< a clause: "what each error does on its own"
  std::span<const std::string_view> keys;     ///< of [analysis], in the order of its templates
  Varies varies = Varies::none;               ///< which factors vary at once
  bool compares_fidelities = false;           ///< whether it may solve at two fidelities
  std::string_view usual_factors = {};        ///< the set taken where a study names none; "all" for a model without it
  std::string_view usual_background = {};     ///< the set that templates hold, for models that have it
  std::string_view overrides = {};            ///< "a case sets": where a held error may have another value
  std::vector<StudyRow> (*rows)() = nullptr;  ///< of [analysis], those that it alone has
  StudyTables (*tables)() = nullptr;          ///< inside these
  /// Why such a study of this model cannot run.
  std::optional<Refusal> (*refusal)(const ModelDescription& model) = nullptr;
  /// Why there is no template for this model.
  std::optional<Refusal> (*no_template)(const ModelDescription& model) = nullptr;
  /// Fills in and checks what its keys say together. Throws InputError.
  void (*complete)(Study& study, const Reading& reading) = nullptr;
  /// Throws InputError for an error of its own keys that makes no sense on this model (Model::error_bound).
  void (*check_errors)(const StudySection& analysis, const Study& study, const Model& model) = nullptr;
  AtPose (*at_pose)(const Study& study);  ///< what a study of it asks for

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

/// Their names, in order.
std::vector<std::string_view> names(const StudyKinds& kinds);

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

}  // namespace poesy
