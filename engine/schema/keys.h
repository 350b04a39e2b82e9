#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/text.h"
#include "engine/schema/keys_section.h"

/// A key of a study file is one typed row: its name, the member that it sets, its bounds and its meaning. Reading, the
/// resolved text, templates and the reference are made from the rows. A default is the value in a default-constructed
/// object.

namespace poesy {

/// One of the words that a key accepts.
struct StudyWord {
  std::string_view name;     ///< the word in a study file
  std::string_view meaning;  ///< a clause
};

/// The description of a key.
struct StudyKey {
  std::string_view name;                        ///< name; a placeholder for names of the model is in capitals: "FACTOR"
  std::string type;                             ///< "integer", "length", "list of numbers", ...
  std::string bounds = {};                      ///< "at least 1"; empty if the type has no further bounds
  std::vector<StudyWord> words = {};            ///< the words that it accepts; empty if it accepts other values
  bool required = false;                        ///< whether it is required where it applies
  std::string missing = {};                     ///< advice if it is missing; empty: it is optional
  std::string usual = {};                       ///< the default: a value in backquotes, or a clause that describes it
  std::string example = {};                     ///< a TOML value that is not the default
  std::vector<std::string_view> only_for = {};  ///< words of the table's chooser for which it applies; empty: all
  bool may_stay = false;                        ///< whether it is ignored, instead of refused, where it does not apply
  std::string_view meaning;                     ///< a sentence
};

/// The description of a table of a study file, or of several with the same keys.
struct StudyTable {
  /// "analysis.cases", with '.' between names and without the numbers of lists; empty for the file itself.
  /// "analysis.groups[]" is only an element of a list, because there may also be a table "analysis.groups".
  std::vector<std::string_view> paths;
  std::string_view meaning;  ///< a sentence
  std::string_view chooser =
      {};  ///< the key whose word determines which other keys of this table apply; empty: all apply
  std::string_view owner = {};  ///< text for the chooser in messages: "select ="
  std::vector<StudyKey> keys;   ///< the keys, in the order in which they are listed

  /// The key of this name; null if there is none. If several apply for different words of the chooser, the one for this
  /// word, or the first.
  const StudyKey* find(std::string_view key, std::string_view word = {}) const;
  std::vector<std::string_view> names() const;  ///< The names of the keys, in order.
  bool has_names_of_model() const;              ///< Whether it has a placeholder for names of the model.
  /// The text in messages for a key that does not apply for this word: `select = "grid"`.
  std::string owner_of(std::string_view word) const;
  /// The advice if the key is missing. Names from the model have the advice of their placeholder.
  std::string remedy(std::string_view key) const;
};

/// The table at this path, in which names of the model may replace placeholders, and elements of lists have numbers:
/// "errors.override.delta_1", "analysis.groups[0]". Null if there is none.
const StudyTable* find_table(const StudyTables& tables, std::string_view path);

/// Whether the key applies for this word of the table's chooser.
bool holds_for(std::span<const std::string_view> only_for, std::string_view word);

/// The explanation of a key as plain text: its meaning and bounds, when it applies or is required, and its default.
std::string explanation(const StudyTable& table, const StudyKey& key);

/// The tables as Markdown, each with its keys and their words.
std::string tables_reference(const StudyTables& tables);

std::string comment(std::string_view text);  ///< Text of any number of lines as comment lines of TOML.

/// Makes lines of a template. Every text is whole lines of TOML. Precondition: the tables and keys exist.
class TemplateLines {
 public:
  /// The tables must outlive it. word: selects among keys of one name that apply for different words of the chooser.
  explicit TemplateLines(const StudyTables& tables, std::string_view word = {}) : tables_(&tables), word_(word) {}

  /// A line with this key and its explanation: after it if there is room, else in comment lines before it, with the
  /// words that it accepts.
  std::string explained(std::string_view table, std::string_view key, std::string_view line) const;
  /// The same for "KEY = VALUE" with the key's default, or its example if the default is not a value. sign: put before
  /// it.
  std::string usual(std::string_view table, std::string_view key, std::string_view sign = "") const;
  /// "KEY: explanation" as comment lines, followed by the words that the key accepts.
  std::string explanation_lines(std::string_view table, std::string_view key) const;
  /// The same for every key of an inline table, `depth` steps further indented.
  std::string keys_lines(std::string_view table, std::size_t depth = 1) const;
  /// An inline table of the keys whose default or example is a value: "{ min = 1000, max = 1000000 }".
  std::string inline_table(std::string_view table) const;
  /// The key's example.
  std::string_view example(std::string_view table, std::string_view key) const;
  std::string_view meaning(std::string_view table) const;  ///< The meaning of a table.

 private:
  const StudyTable& table(std::string_view path) const;
  const StudyKey& key(std::string_view path, std::string_view name) const;

  const StudyTables* tables_;
  std::string word_;
};

std::string in_quotes(std::string_view text);  ///< A TOML string: in quotes, and escaped.

/// A value of this dimension for a study file, which reads back exactly: "0.001 m" in quotes, or a bare number.
std::string exact_value(double si, Dimension dimension);

/// The same in the unit that people read, if that is equally exact and shorter: "60 mm" instead of "0.06 m".
std::string readable_value(double si, Dimension dimension);

using ValueText = std::string (*)(double si, Dimension dimension);  ///< One of the two functions above.

std::string list_text(std::span<const std::string> values);  ///< Values as a TOML list: "[a, b]".

/// Named things as a TOML inline table, "{ a = 1, b = 2 }"; value(k) is the text of the k-th.
template <class Named, class Value>
std::string inline_table(const std::vector<Named>& things, Value value) {
  std::string text;
  for (std::size_t k = 0; k < things.size(); ++k) {
    text += (k == 0 ? "{ " : ", ") + std::string(things[k].name) + " = " + std::string(value(k));
  }
  return text + " }";
}

/// Calls read(k, value) for each thing for which the section has a key, in the order of the things. Throws InputError
/// for other keys. what: a noun for the keys.
template <class Named, class Read>
void read_named(const StudySection& section, const std::vector<Named>& things, std::string_view what, Read read) {
  section.allow(names(things), what);
  for (std::size_t k = 0; k < things.size(); ++k) {
    if (const auto value = section.find(things[k].name)) read(k, *value);
  }
}

/// The bounds of a number without a unit.
struct NumberBounds {
  double least;            ///< lower end
  double most;             ///< upper end
  bool ends_included;      ///< whether the ends are allowed
  std::string_view words;  ///< text: "between 0 and 1"
  std::string remedy;      ///< advice for a number outside: "it must lie between 0 and 1, e.g. 0.95"
  bool percent = false;    ///< whether a text such as "95 %" is allowed too
};

NumberBounds above_zero(std::string_view example);       ///< Greater than zero.
NumberBounds above_one(std::string_view example);        ///< Greater than one.
NumberBounds between_0_and_1(std::string_view example);  ///< Between 0 and 1, both excluded, or in percent.

/// Reads a number within the bounds. Throws InputError at the value's place.
double read_number(const StudyValue& value, const NumberBounds& bounds);

/// How a key's value is stored in an object, and which values a study file may have.
template <class Object>
struct KeyValue {
  std::string type;                                           ///< see StudyKey
  std::string bounds = {};                                    ///< see StudyKey
  std::vector<StudyWord> words = {};                          ///< see StudyKey
  std::function<void(const StudyValue&, Object&)> read = {};  ///< none if the row has a reader
  std::function<std::string(const Object&)> text = {};        ///< TOML; none if the row has its own lines, or none
};

/// A row: one key of a table, with its value in an object.
template <class Object, class Scope>
struct Key {
  std::string_view name;     ///< see StudyKey
  KeyValue<Object> value;    ///< type, bounds, words, and how it is read and written
  std::string missing = {};  ///< see StudyKey, with "{}" for the example; not empty: the key is required
  bool required = false;     ///< whether other rules than this row require the key
  /// The default, if it is not the value of a default-constructed object; empty: there is none.
  std::optional<std::string> usual = {};
  std::string besides = {};                     ///< remark after the default, or after "required"
  std::string example = {};                     ///< see StudyKey
  std::vector<std::string_view> only_for = {};  ///< see StudyKey
  bool may_stay = false;                        ///< see StudyKey
  std::string_view meaning;                     ///< see StudyKey
  /// Reads a value that depends on more than itself: the model, files, other keys.
  void (*reader)(const StudyValue& value, Object& object, const Scope& scope) = nullptr;
  /// The key's lines of the resolved text, if they are not "KEY = VALUE"; may be empty.
  std::string (*lines)(const Object& object) = nullptr;
  int late = 0;  ///< order in the resolved text: a key comes after those with a smaller number
  /// The key's lines of a template for this object, if they are not its default; may be empty.
  std::string (*shown)(const TemplateLines& lines, const Object& object) = nullptr;
  bool commented = false;  ///< whether a template has the default as a comment
};

/// A table of typed rows.
template <class Object, class Scope>
struct Keys {
  std::vector<std::string_view> paths = {};  ///< see StudyTable
  std::string_view meaning = {};             ///< see StudyTable
  std::string_view chooser = {};             ///< see StudyTable; the key of the first row
  std::string_view owner = {};               ///< see StudyTable
  std::vector<Key<Object, Scope>> rows;      ///< rows, in the order in which they are listed and read
};

namespace detail {

template <class Object, class Member>
auto& at(Object& object, Member member) {
  return object.*member;
}

template <class Object, class Member, class... Rest>
auto& at(Object& object, Member member, Rest... rest) {
  return at(object.*member, rest...);
}

template <class Class, class Type, class... Rest>
Class owner_of(Type Class::*, Rest...);

std::string without_plus(std::string text);  ///< Removes the plus of exponents: "1e-15", and "1e8" for 1e+08.

/// The value of a default-constructed object, as text for readers.
template <class Object>
std::string usual_text(const KeyValue<Object>& value) {
  return value.text ? "`" + without_plus(value.text(Object{})) + "`" : std::string();
}

}  // namespace detail

/// The type to which the first of these pointers to members belongs.
template <class... Path>
using OwnerOf = decltype(detail::owner_of(Path()...));

/// The member at this path of members. read: converts a StudyValue; text: writes TOML.
template <class Read, class Text, class... Path>
KeyValue<OwnerOf<Path...>> value_at(std::string type, std::string_view bounds, Read read, Text text, Path... path) {
  using Object = OwnerOf<Path...>;
  return {.type = std::move(type),
          .bounds = std::string(bounds),
          .read =
              [=](const StudyValue& value, Object& object) {
                auto& member = detail::at(object, path...);
                member = static_cast<std::remove_reference_t<decltype(member)>>(read(value));
              },
          .text = [=](const Object& object) { return text(detail::at(object, path...)); }};
}

/// A text in the member at this path.
template <class... Path>
auto text_at(Path... path) {
  return value_at(
      "text", "", [](const StudyValue& value) { return value.text(); }, in_quotes, path...);
}

/// A whole number between `least` and `most`, both included.
template <class... Path>
auto whole_at(std::int64_t least, std::int64_t most, Path... path) {
  const auto read = [=](const StudyValue& value) { return value.whole_number(least, most); };
  const auto text = [](auto number) { return std::to_string(number); };
  return value_at("integer", "at least " + std::to_string(least), read, text, path...);
}

/// A number without a unit, within bounds.
template <class... Path>
auto number_at(const NumberBounds& bounds, Path... path) {
  const auto read = [=](const StudyValue& value) { return read_number(value, bounds); };
  return value_at("number", bounds.words, read, shortest, path...);
}

/// A quantity of this dimension.
template <class... Path>
auto quantity_at(Dimension dimension, Path... path) {
  const auto read = [=](const StudyValue& value) { return value.quantity(dimension); };
  const auto text = [=](double si) { return exact_value(si, dimension); };
  return value_at(std::string(name(dimension)), "", read, text, path...);
}

/// A quantity of this dimension above zero.
template <class... Path>
auto positive_at(Dimension dimension, Path... path) {
  const auto read = [=](const StudyValue& value) { return value.positive_quantity(dimension); };
  const auto text = [=](double si) { return exact_value(si, dimension); };
  return value_at(std::string(name(dimension)), "greater than 0", read, text, path...);
}

/// A value of an enumeration with its meaning; its word is name(value).
template <class Enum>
struct WordFor {
  Enum value;                ///< the value
  std::string_view meaning;  ///< a clause
};

/// One word of an enumeration.
template <class Enum, class... Path>
auto word_at(std::vector<WordFor<Enum>> words, Path... path) {
  std::vector<std::string_view> known;
  for (const WordFor<Enum>& word : words) known.push_back(name(word.value));
  const auto read = [=](const StudyValue& value) { return words[value.word(known)].value; };
  auto made = value_at(
      "text", "", read, [](Enum value) { return in_quotes(name(value)); }, path...);
  for (const WordFor<Enum>& word : words) made.words.push_back({name(word.value), word.meaning});
  return made;
}

/// The description of a table's keys.
template <class Object, class Scope>
StudyTable described(const Keys<Object, Scope>& keys) {
  StudyTable table{keys.paths, keys.meaning, keys.chooser, keys.owner, {}};
  for (const Key<Object, Scope>& row : keys.rows) {
    const bool required = row.required || !row.missing.empty();
    const std::string usual = required ? "" : row.usual ? *row.usual : detail::usual_text(row.value);
    table.keys.push_back({row.name, row.value.type, row.value.bounds, row.value.words, required, row.missing,
                          usual + row.besides, row.example, row.only_for, row.may_stay, row.meaning});
  }
  return table;
}

/// The word of the table's chooser in an object; empty without a chooser.
template <class Object, class Scope>
std::string chosen_word(const Keys<Object, Scope>& keys, const Object& object) {
  if (keys.chooser.empty()) return {};
  const std::string quoted = keys.rows.front().value.text(object);
  return quoted.substr(1, quoted.size() - 2);
}

/// The row of this name. Precondition: it exists.
template <class Object, class Scope>
const Key<Object, Scope>& row_of(const Keys<Object, Scope>& keys, std::string_view name) {
  return *std::ranges::find(keys.rows, name, &Key<Object, Scope>::name);
}

/// Reads one key.
template <class Object, class Scope>
void read_key(const Key<Object, Scope>& row, const StudyValue& value, Object& object, const Scope& scope) {
  if (row.reader != nullptr) {
    row.reader(value, object, scope);
  } else if (row.value.read) {
    row.value.read(value, object);
  }
}

/// Which keys a table must have, and may have.
enum class Extent {
  complete,  ///< all required keys, and none that does not apply for the chooser's word
  partial,   ///< required keys may be missing
  any        ///< required keys may be missing, and keys that do not apply are read
};

/// Reads a table key by key, in the order of its rows. Throws InputError for unknown keys, values out of bounds, and
/// keys that `extent` does not allow.
template <class Object, class Scope>
void read_keys(const Keys<Object, Scope>& keys, const StudySection& section, Object& object, const Scope& scope,
               Extent extent = Extent::complete) {
  section.allow();
  std::string word;
  for (const Key<Object, Scope>& row : keys.rows) {
    const auto value = section.find(row.name);
    if (value) read_key(row, *value, object, scope);
    if (!value && extent == Extent::complete && !row.missing.empty() && holds_for(row.only_for, word)) {
      static_cast<void>(section.require(row.name));
    }
    if (row.name != keys.chooser) continue;
    word = chosen_word(keys, object);
    if (extent != Extent::any) section.refuse_all_but_those_for(word);
  }
}

/// The key's lines of a template for this object.
template <class Object, class Scope>
std::string template_lines(const TemplateLines& lines, std::string_view table, const Key<Object, Scope>& row,
                           const Object& object) {
  if (row.shown != nullptr) return row.shown(lines, object);
  return lines.usual(table, row.name, row.commented ? "# " : "");
}

/// The lines of all keys of a table.
template <class Object, class Scope>
std::string template_lines(const TemplateLines& lines, const Keys<Object, Scope>& keys, const Object& object) {
  std::string text;
  for (const Key<Object, Scope>& row : keys.rows) text += template_lines(lines, keys.paths.front(), row, object);
  return text;
}

/// The resolved text of a table's keys: lines "KEY = VALUE" with every default filled in.
template <class Object, class Scope>
std::string keys_text(const Keys<Object, Scope>& keys, const Object& object) {
  const std::string word = chosen_word(keys, object);
  int last = 0;
  for (const auto& row : keys.rows) last = std::max(last, row.late);
  std::string text;
  for (int late = 0; late <= last; ++late) {
    for (const Key<Object, Scope>& row : keys.rows) {
      if (row.late != late || !holds_for(row.only_for, word)) continue;
      if (row.lines != nullptr) {
        text += row.lines(object);
      } else if (row.value.text) {
        text += std::string(row.name) + " = " + row.value.text(object) + "\n";
      }
    }
  }
  return text;
}

}  // namespace poesy
