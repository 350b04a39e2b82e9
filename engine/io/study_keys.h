#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace poesy {

/// One of the words that a key takes.
struct StudyWord {
  std::string_view name;     ///< as a study file has it
  std::string_view meaning;  ///< a clause
};

/// One key of a study file. Plain data, of which readers, templates and the reference are made.
struct StudyKey {
  std::string_view name;              ///< in capitals what stands for a name of the model's: "FACTOR"
  std::string_view type;              ///< "integer", "length", "list of numbers", ...
  std::string_view bounds = {};       ///< "at least 1"; empty where the type says all
  std::vector<StudyWord> words = {};  ///< that it takes, where it takes no others
  bool required = false;              ///< wherever it holds
  std::string_view usual = {};        ///< the default: a value in backquotes, or a clause that says which it is
  std::vector<std::string_view> only_for = {};  ///< words of the table's chooser for which it holds; empty: all
  bool may_stay = false;                        ///< where it does not hold it is ignored, not refused
  std::string_view meaning;                     ///< a sentence
};

/// A table of a study file, or several that have the same keys.
struct StudyTable {
  /// "analysis.groups", with '.' between names and without the numbers of a list; empty for the file itself.
  std::vector<std::string_view> paths;
  std::string_view meaning;       ///< a sentence
  std::string_view chooser = {};  ///< the key by whose word other keys of this table hold or not
  std::vector<StudyKey> keys;     ///< in the order in which they are listed

  /// Null where it has none of that name.
  const StudyKey* find(std::string_view key) const;
  /// The keys' names, in order.
  std::vector<std::string_view> names() const;
  /// Whether it has a key that stands for names of the model's.
  bool has_names_of_model() const;
};

/// Every table of a study file, with every key.
const std::vector<StudyTable>& study_tables();

/// The table at this path, in which names of the model's may stand for themselves and a list's elements have their
/// numbers: "errors.override.delta_1", "analysis.groups[0]". Null where there is none.
const StudyTable* find_study_table(std::string_view path);

/// A key that is described. Precondition: there are such a table and such a key in it.
const StudyKey& study_key(std::string_view path, std::string_view key);

/// Whether a key stands for names of the model's.
bool is_name_of_model(const StudyKey& key);

/// Whether the key holds where the table's chooser is this word.
bool holds_for(const StudyKey& key, std::string_view word);

/// The key in plain text: its meaning and bounds, where it holds or is required, and its default.
std::string explanation(const StudyKey& key);

/// The whole reference of study files, as Markdown.
std::string study_reference();

}  // namespace poesy
