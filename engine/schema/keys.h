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

/// Each key of a study or mechanism file is described by one typed object, a Key, which is a row of a table Keys. It
/// states the name of the key, the member that the key sets, its bounds and its meaning. The functions that read files,
/// write the resolved text (a study with every default filled in), and make templates and the reference all use these
/// descriptions. A key's default is the value in a default-constructed object.

namespace poesy {

/// One of the words that a key accepts.
struct StudyWord {
  std::string_view name;     ///< the word in a study file
  std::string_view meaning;  ///< what the word means, as a clause
};

/// The description of a key, from which messages, templates and the reference of study files are made.
struct StudyKey {
  std::string_view name;    ///< name of the key; in capitals ("FACTOR"), a placeholder for names that the model gives
  std::string type;         ///< type of the value: "integer", "length", "list of numbers", ...
  std::string bounds = {};  ///< bounds of the value: "at least 1"; empty if the type has no further bounds
  std::vector<StudyWord> words = {};  ///< words that the key accepts; empty if it accepts other values
  bool required = false;              ///< true if the key is required where it applies
  /// Advice to a user who leaves out a required key; may be empty.
  std::string missing = {};
  std::string usual = {};    ///< default: a value in backquotes, or a description in words
  std::string example = {};  ///< example of a value in TOML that is not the default
  std::vector<std::string_view> only_for =
      {};                    ///< words of the chooser (see StudyTable) with which the key applies; empty: all
  bool may_stay = false;     ///< true if the key is ignored with other words; false if it is refused
  std::string_view meaning;  ///< what the key means, as a sentence
};

/// The description of a table of a study file, or of several tables with the same keys.
struct StudyTable {
  /// Paths of the tables: "analysis.cases", with '.' between names and without the numbers of lists. The path of the
  /// file itself is empty. "analysis.groups[]" means the elements of a list, in contrast to a table "analysis.groups".
  std::vector<std::string_view> paths;
  std::string_view meaning;  ///< what the table is for, as a sentence
  /// Name of the chooser: the key whose word selects which other keys of the table apply. Empty: all keys apply.
  std::string_view chooser = {};
  std::string_view owner = {};  ///< text before the chooser's word in messages: "the distribution"; empty: "CHOOSER ="
  std::vector<StudyKey> keys;   ///< the keys, in the order in which they are listed

  /// The key of this name; null if the table has none. Several keys may have the same name if they apply with different
  /// words of the chooser. The result is then the one that applies with `word`, or the first one if none does.
  const StudyKey* find(std::string_view key, std::string_view word = {}) const;
  std::vector<std::string_view> names() const;  ///< The names of the keys, each once, in order.
  bool has_names_of_model() const;              ///< Returns true if a key is a placeholder for names of the model.
  /// The setting of the chooser as messages name it, for a key that does not apply with this word: `select = "grid"`.
  std::string owner_of(std::string_view word) const;
  /// The advice to a user who leaves the key out. A key that is not described is a name that the model gives; it has
  /// the advice of the table's placeholder.
  std::string remedy(std::string_view key) const;
};

/// The table at this path; null if there is none. In the path, names of the model may replace placeholders, and
/// elements of lists have numbers: "errors.override.delta_1", "analysis.groups[0]".
const StudyTable* find_table(const StudyTables& tables, std::string_view path);

/// Returns true if a key applies when the value of the table's key StudyTable::chooser is this word. only_for: the
/// key's StudyKey::only_for.
bool holds_for(std::span<const std::string_view> only_for, std::string_view word);

/// The explanation of a key as plain text: its meaning and bounds, when it applies or is required, and its default.
std::string explanation(const StudyTable& table, const StudyKey& key);

/// The tables as Markdown, each with its keys and the words that they accept.
std::string tables_reference(const StudyTables& tables);

std::string comment(std::string_view text);  ///< Text of any number of lines as comment lines of TOML.

/// Makes lines of a template: a study file with explanations, which a user edits. The functions return whole lines of
/// TOML, except inline_table(), example() and meaning(). Precondition: the tables and keys exist.
class TemplateLines {
 public:
  /// tables: must outlive this object. word: the word of the chooser, which selects among keys of the same name.
  explicit TemplateLines(const StudyTables& tables, std::string_view word = {}) : tables_(&tables), word_(word) {}

  /// The given line, which sets this key, with the key's explanation: at the end of the line if there is room and the
  /// key has no words, otherwise in comment lines before it, followed by the words that the key accepts.
  std::string explained(std::string_view table, std::string_view key, std::string_view line) const;
  /// A line "KEY = VALUE" with its explanation, made by explained(). The value is the key's default if the description
  /// states a value, otherwise the key's example. sign: text before the key, such as "# ".
  std::string usual(std::string_view table, std::string_view key, std::string_view sign = "") const;
  /// "KEY: explanation" as comment lines, followed by the words that the key accepts with their meanings.
  std::string explanation_lines(std::string_view table, std::string_view key) const;
  /// The explanation_lines() of every key of a table, indented by 2 x depth columns.
  std::string keys_lines(std::string_view table, std::size_t depth = 1) const;
  /// An inline table of the keys whose default or example is a value, in TOML: "{ min = 1000, max = 1000000 }".
  std::string inline_table(std::string_view table) const;
  /// The example of a key.
  std::string_view example(std::string_view table, std::string_view key) const;
  std::string_view meaning(std::string_view table) const;  ///< The meaning of a table, from its description.

 private:
  const StudyTable& table(std::string_view path) const;
  const StudyKey& key(std::string_view path, std::string_view name) const;

  const StudyTables* tables_;
  std::string word_;
};

std::string in_quotes(std::string_view text);  ///< A text as a TOML string, in quotes and escaped.

/// A value (SI) of this dimension as TOML text that reads back to exactly the same number: "0.001 m" in quotes, or a
/// bare number.
std::string exact_value(double si, Dimension dimension);

/// A value (SI) as TOML text in the unit that results show, if this text is as exact and at most one character longer
/// than exact_value(): "60 mm" instead of "0.06 m". Otherwise exact_value().
std::string readable_value(double si, Dimension dimension);

/// A function like exact_value() or readable_value().
using ValueText = std::string (*)(double si, Dimension dimension);

std::string list_text(std::span<const std::string> values);  ///< Values as a TOML list: "[a, b]".

/// Things with a member `name` as a TOML inline table, "{ a = 1, b = 2 }". value(k): the value of the k-th thing as
/// TOML.
template <class Named, class Value>
std::string inline_table(const std::vector<Named>& things, Value value) {
  std::string text;
  for (std::size_t k = 0; k < things.size(); ++k) {
    text += (k == 0 ? "{ " : ", ") + std::string(things[k].name) + " = " + std::string(value(k));
  }
  return text + " }";
}

/// Calls read(k, value) for each thing whose name is a key of the section, in the order of the things; k is the index
/// of the thing. Throws InputError for a key that names no thing. what: noun for a thing in messages, such as "joint".
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
  bool ends_included;      ///< true if the ends are allowed
  std::string_view words;  ///< the bounds in words: "between 0 and 1"
  std::string remedy;      ///< advice for a number outside the bounds: "it must lie between 0 and 1, e.g. 0.95"
  bool percent = false;    ///< true if a text such as "95 %" is allowed too
};

NumberBounds above_zero(std::string_view example);  ///< Bounds of a number greater than zero.
NumberBounds above_one(std::string_view example);   ///< Bounds of a number greater than one.
/// Bounds of a number between 0 and 1, both excluded; a percentage is allowed.
NumberBounds between_0_and_1(std::string_view example);

/// Reads a number within the bounds. Throws InputError at the value's place if the number is outside.
double read_number(const StudyValue& value, const NumberBounds& bounds);

/// Describes how the value of a key is read into an object and written from it, and which values a file may have.
template <class Object>
struct KeyValue {
  std::string type;                   ///< type for users: "integer", "length", "list of numbers", ...
  std::string bounds = {};            ///< bounds for users: "at least 1"; empty if the type has no further bounds
  std::vector<StudyWord> words = {};  ///< words that the key accepts; empty if it accepts other values
  /// Stores the value in the object; none if Key::reader does so instead.
  std::function<void(const StudyValue&, Object&)> read = {};
  /// Returns the value as TOML; none if Key::lines writes the lines of the key, or if it has no line.
  std::function<std::string(const Object&)> text = {};
};

/// One key of a table (a row of Keys): its description, and the functions that read its value into an Object and write
/// it. Scope: type of the data that a reader needs in addition to the value, such as the model.
template <class Object, class Scope>
struct Key {
  std::string_view name;   ///< name of the key; in capitals ("FACTOR"), a placeholder for names that the model gives
  KeyValue<Object> value;  ///< type, bounds and words of the value, and how it is read and written
  /// Advice to a user who leaves the key out, with "{}" in place of the example; if the advice is not empty, the key is
  /// required.
  std::string missing = {};
  bool required = false;  ///< true if the key is required by code outside read_keys()
  /// The default in words; none: the value of a default-constructed object is the default. An empty text means that
  /// there is no default.
  std::optional<std::string> usual = {};
  std::string besides = {};  ///< remark that follows the default, or the word "required", in descriptions
  std::string example = {};  ///< example of a value in TOML that is not the default
  std::vector<std::string_view> only_for =
      {};                    ///< words of the chooser (see StudyTable) with which the key applies; empty: all
  bool may_stay = false;     ///< true if the key is ignored with other words; false if it is refused
  std::string_view meaning;  ///< what the key means, as a sentence
  /// Reads the value if its meaning depends on the model, on files or on other keys; replaces KeyValue::read.
  void (*reader)(const StudyValue& value, Object& object, const Scope& scope) = nullptr;
  /// Writes the key's lines of the resolved text, which may be empty; null: the line is "KEY = VALUE".
  std::string (*lines)(const Object& object) = nullptr;
  int late = 0;  ///< order in the resolved text: keys with a larger number come later
  /// Writes the key's lines of a template for this object, which may be empty; null: the template shows the default.
  std::string (*shown)(const TemplateLines& lines, const Object& object) = nullptr;
  bool commented = false;  ///< true if a template shows the default in a comment line
};

/// A table of keys with their values. described() makes a StudyTable of it.
template <class Object, class Scope>
struct Keys {
  /// Paths of the table in a file: "analysis.cases"; empty for the file itself.
  std::vector<std::string_view> paths = {};
  std::string_view meaning = {};  ///< what the table is for, as a sentence
  /// Name of the chooser: the key whose word selects which other keys apply. It is the first of `rows`. Empty: all keys
  /// apply.
  std::string_view chooser = {};
  std::string_view owner = {};  ///< text before the chooser's word in messages: "the distribution"; empty: "CHOOSER ="
  std::vector<Key<Object, Scope>> rows;  ///< keys, in the order in which they are listed and read
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

/// Removes the plus sign and leading zeros of a positive exponent: "1e8" for "1e+08". Other texts stay as they are.
std::string without_plus(std::string text);

/// The value of a default-constructed object in backquotes, as the reference shows it.
template <class Object>
std::string usual_text(const KeyValue<Object>& value) {
  return value.text ? "`" + without_plus(value.text(Object{})) + "`" : std::string();
}

}  // namespace detail

/// The class to which the first of these pointers to members belongs.
template <class... Path>
using OwnerOf = decltype(detail::owner_of(Path()...));

/// Makes a KeyValue for a member of an object. path: pointers to members that lead from the object to this member.
/// read: converts a StudyValue to the member's value. text: writes this value as TOML.
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

/// The KeyValue of a text. path: pointers to members, as for value_at().
template <class... Path>
auto text_at(Path... path) {
  return value_at(
      "text", "", [](const StudyValue& value) { return value.text(); }, in_quotes, path...);
}

/// The KeyValue of a whole number from `least` to `most`. path: pointers to members, as for value_at().
template <class... Path>
auto whole_at(std::int64_t least, std::int64_t most, Path... path) {
  const auto read = [=](const StudyValue& value) { return value.whole_number(least, most); };
  const auto text = [](auto number) { return std::to_string(number); };
  return value_at("integer", "at least " + std::to_string(least), read, text, path...);
}

/// The KeyValue of a number without a unit, within bounds. path: pointers to members, as for value_at().
template <class... Path>
auto number_at(const NumberBounds& bounds, Path... path) {
  const auto read = [=](const StudyValue& value) { return read_number(value, bounds); };
  return value_at("number", bounds.words, read, shortest, path...);
}

/// The KeyValue of a quantity of this dimension, SI. path: pointers to members, as for value_at().
template <class... Path>
auto quantity_at(Dimension dimension, Path... path) {
  const auto read = [=](const StudyValue& value) { return value.quantity(dimension); };
  const auto text = [=](double si) { return exact_value(si, dimension); };
  return value_at(std::string(name(dimension)), "", read, text, path...);
}

/// The KeyValue of a quantity of this dimension above zero, SI. path: pointers to members, as for value_at().
template <class... Path>
auto positive_at(Dimension dimension, Path... path) {
  const auto read = [=](const StudyValue& value) { return value.positive_quantity(dimension); };
  const auto text = [=](double si) { return exact_value(si, dimension); };
  return value_at(std::string(name(dimension)), "greater than 0", read, text, path...);
}

/// A value of an enumeration with its meaning. Its word in a file is name(value).
template <class Enum>
struct WordFor {
  Enum value;                ///< value of the enumeration
  std::string_view meaning;  ///< what the value means, as a clause
};

/// The KeyValue of an enumeration whose values a file states as one of these words. path: pointers to members, as for
/// value_at().
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

/// The description of a table's keys, without their values.
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

/// The word that this object has for the table's chooser (Keys::chooser); empty if the table has no chooser.
template <class Object, class Scope>
std::string chosen_word(const Keys<Object, Scope>& keys, const Object& object) {
  if (keys.chooser.empty()) return {};
  const std::string quoted = keys.rows.front().value.text(object);
  return quoted.substr(1, quoted.size() - 2);
}

/// The key of this name. Precondition: the key exists.
template <class Object, class Scope>
const Key<Object, Scope>& row_of(const Keys<Object, Scope>& keys, std::string_view name) {
  return *std::ranges::find(keys.rows, name, &Key<Object, Scope>::name);
}

/// Reads the value of one key into an object.
template <class Object, class Scope>
void read_key(const Key<Object, Scope>& row, const StudyValue& value, Object& object, const Scope& scope) {
  if (row.reader != nullptr) {
    row.reader(value, object, scope);
  } else if (row.value.read) {
    row.value.read(value, object);
  }
}

/// Which keys must be present when a table is read, and which may be present.
enum class Extent {
  complete,  ///< all required keys must be present, and keys that do not apply are refused
  partial,   ///< required keys may be missing; keys that do not apply are refused
  any        ///< required keys may be missing, and keys that do not apply are read as well
};

/// Reads a table key by key, in the order of its rows. Throws InputError for unknown keys, values out of bounds, and
/// keys that are missing or refused according to `extent`.
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

/// The lines of a key in a template that shows this object.
template <class Object, class Scope>
std::string template_lines(const TemplateLines& lines, std::string_view table, const Key<Object, Scope>& row,
                           const Object& object) {
  if (row.shown != nullptr) return row.shown(lines, object);
  return lines.usual(table, row.name, row.commented ? "# " : "");
}

/// The lines of all keys of a table in a template that shows this object.
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
