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
/// resolved text, templates and the reference are made of the rows. A default is what a default-constructed object has.

namespace poesy {

/// One of the words that a key takes.
struct StudyWord {
  std::string_view name;     ///< as a study file has it
  std::string_view meaning;  ///< a clause
};

/// What is said of one key.
struct StudyKey {
  std::string_view name;              ///< in capitals what stands for a name of the model's: "FACTOR", not "E"
  std::string type;                   ///< "integer", "length", "list of numbers", ...
  std::string bounds = {};            ///< "at least 1"; empty where the type says all
  std::vector<StudyWord> words = {};  ///< that it takes, where it takes no others
  bool required = false;              ///< wherever it holds
  std::string missing = {};           ///< what to do where it is missing; empty: it may be left out
  std::string usual = {};             ///< the default: a value in backquotes, or a clause that says which it is
  std::string example = {};           ///< a TOML value that is no default
  std::vector<std::string_view> only_for = {};  ///< words of the table's chooser for which it holds; empty: all
  bool may_stay = false;                        ///< where it does not hold it is ignored, not refused
  std::string_view meaning;                     ///< a sentence
};

/// A table of a study file, or several that have the same keys.
struct StudyTable {
  /// "analysis.cases", with '.' between names and without the numbers of a list; empty for the file itself.
  /// "analysis.groups[]" is an element of a list alone: there may be a table "analysis.groups" as well.
  std::vector<std::string_view> paths;
  std::string_view meaning;       ///< a sentence
  std::string_view chooser = {};  ///< the key by whose word other keys of this table hold or not; empty: all hold
  std::string_view owner = {};    ///< how messages speak of the chooser's word: "select ="
  std::vector<StudyKey> keys;     ///< in the order in which they are listed

  /// Null where it has none of that name. Where keys of one name hold for different words of the chooser, the one that
  /// holds for this word, else the first.
  const StudyKey* find(std::string_view key, std::string_view word = {}) const;
  std::vector<std::string_view> names() const;  ///< The keys' names, in order.
  bool has_names_of_model() const;              ///< Whether it has a key that stands for names of the model's.
  /// `select = "grid"`: what a key does not belong to that does not hold for this word.
  std::string owner_of(std::string_view word) const;
  /// What to do where the key is missing; a name of the model's has that of the key that stands for it.
  std::string remedy(std::string_view key) const;
};

/// The table at this path, in which names of the model's may stand for themselves and a list's elements have their
/// numbers: "errors.override.delta_1", "analysis.groups[0]". Null where there is none.
const StudyTable* find_table(const StudyTables& tables, std::string_view path);

/// Whether the key holds where the table's chooser is this word.
bool holds_for(std::span<const std::string_view> only_for, std::string_view word);

/// The key in plain text: its meaning and bounds, where it holds or is required, and its default.
std::string explanation(const StudyTable& table, const StudyKey& key);

/// The tables as Markdown, each with its keys and their words.
std::string tables_reference(const StudyTables& tables);

std::string comment(std::string_view text);  ///< Text of any number of lines as comment lines of TOML.

/// What a template says of keys. Every text is whole lines of TOML. Precondition: there are such tables and keys.
class TemplateLines {
 public:
  /// The tables must outlive it. word: the chooser's where keys of one name hold for different words.
  explicit TemplateLines(const StudyTables& tables, std::string_view word = {}) : tables_(&tables), word_(word) {}

  /// A line that shows this key, with its explanation: behind it where that fits, else in comment lines before it, with
  /// the words that it takes.
  std::string explained(std::string_view table, std::string_view key, std::string_view line) const;
  /// The same of "KEY = VALUE", the key's default, or its example where the default is no value; behind `sign`.
  std::string usual(std::string_view table, std::string_view key, std::string_view sign = "") const;
  /// "KEY: explanation" in comment lines, and below it the words that the key takes.
  std::string explanation_lines(std::string_view table, std::string_view key) const;
  /// The same for every key of a table, `depth` steps further in: what an inline table may hold.
  std::string keys_lines(std::string_view table, std::size_t depth = 1) const;
  /// An inline table of the keys whose default or example is a value: "{ min = 1000, max = 1000000 }".
  std::string inline_table(std::string_view table) const;
  /// The key's example.
  std::string_view example(std::string_view table, std::string_view key) const;
  std::string_view meaning(std::string_view table) const;  ///< What is said of a table as a whole.

 private:
  const StudyTable& table(std::string_view path) const;
  const StudyKey& key(std::string_view path, std::string_view name) const;

  const StudyTables* tables_;
  std::string word_;
};

std::string in_quotes(std::string_view text);  ///< A TOML string: in quotes, with what needs it escaped.

/// A value of this dimension as a study file has it, exact when read back: "0.001 m" in quotes, or a bare number.
std::string exact_value(double si, Dimension dimension);

/// The same in the unit in which people read it, where that is as exact and shorter: "60 mm" rather than "0.06 m".
std::string readable_value(double si, Dimension dimension);

using ValueText = std::string (*)(double si, Dimension dimension);  ///< One of these two.

std::string list_text(std::span<const std::string> values);  ///< Values as a TOML list: "[a, b]".

/// Named things as a TOML inline table, "{ a = 1, b = 2 }", where value(k) is the text of the k-th.
template <class Named, class Value>
std::string inline_table(const std::vector<Named>& things, Value value) {
  std::string text;
  for (std::size_t k = 0; k < things.size(); ++k) {
    text += (k == 0 ? "{ " : ", ") + std::string(things[k].name) + " = " + std::string(value(k));
  }
  return text + " }";
}

/// Calls read(k, value) for each of the things that the section has a key for, in their order. Throws InputError for
/// other keys; `what` says what the keys are.
template <class Named, class Read>
void read_named(const StudySection& section, const std::vector<Named>& things, std::string_view what, Read read) {
  section.allow(names(things), what);
  for (std::size_t k = 0; k < things.size(); ++k) {
    if (const auto value = section.find(things[k].name)) read(k, *value);
  }
}

/// What a number without a unit must be.
struct NumberBounds {
  double least;            ///< the lower end
  double most;             ///< the upper end
  bool ends_included;      ///< whether the ends are inside
  std::string_view words;  ///< "between 0 and 1"
  std::string remedy;      ///< for a number outside: "it must lie between 0 and 1, e.g. 0.95"
  bool percent = false;    ///< whether a text such as "95 %" is one too
};

NumberBounds above_zero(std::string_view example);       ///< Greater than zero.
NumberBounds above_one(std::string_view example);        ///< Greater than one.
NumberBounds between_0_and_1(std::string_view example);  ///< Between 0 and 1, both excluded, or in percent.

/// A number inside the bounds. Throws InputError at the value's place.
double read_number(const StudyValue& value, const NumberBounds& bounds);

/// Where a value is in an object, and what a study file may say for it.
template <class Object>
struct KeyValue {
  std::string type;                                           ///< as StudyKey has it
  std::string bounds = {};                                    ///< likewise
  std::vector<StudyWord> words = {};                          ///< likewise
  std::function<void(const StudyValue&, Object&)> read = {};  ///< none where the row has a reader
  std::function<std::string(const Object&)> text = {};        ///< TOML; none: the row has lines of its own, or none
};

/// A row: one key of a table, and where its value is in an object.
template <class Object, class Scope>
struct Key {
  std::string_view name;     ///< as StudyKey has it
  KeyValue<Object> value;    ///< type, bounds, words, and how it is read and written
  std::string missing = {};  ///< as StudyKey has it, "{}" for the example; not empty: the key is required
  bool required = false;     ///< for keys that other rules than this row require
  /// The default, where it is not the value of a default-constructed object; empty: there is none.
  std::optional<std::string> usual = {};
  std::string besides = {};  ///< what is said of the default after its value, or after that the key is required
  std::string example = {};  ///< as StudyKey has it
  std::vector<std::string_view> only_for = {};  ///< as StudyKey has it
  bool may_stay = false;                        ///< likewise
  std::string_view meaning;                     ///< likewise
  /// Reads what needs more than the value itself: the model, files, other keys.
  void (*reader)(const StudyValue& value, Object& object, const Scope& scope) = nullptr;
  /// The key's lines of the resolved text, where they are not "KEY = VALUE"; may be none.
  std::string (*lines)(const Object& object) = nullptr;
  int late = 0;  ///< in the resolved text, a key comes after those with a smaller number
  /// The key's lines of a template for such an object, where they are not its default; may be none.
  std::string (*shown)(const TemplateLines& lines, const Object& object) = nullptr;
  bool commented = false;  ///< whether a template has the default behind a '#'
};

/// A table of typed rows.
template <class Object, class Scope>
struct Keys {
  std::vector<std::string_view> paths = {};  ///< as StudyTable has them
  std::string_view meaning = {};             ///< likewise
  std::string_view chooser = {};             ///< likewise; the first row then
  std::string_view owner = {};               ///< likewise
  std::vector<Key<Object, Scope>> rows;      ///< in the order in which they are listed and read
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

std::string without_plus(std::string text);  ///< "1e-15", "1e8" for 1e+08.

/// The value of a default-constructed object, as readers see it.
template <class Object>
std::string usual_text(const KeyValue<Object>& value) {
  return value.text ? "`" + without_plus(value.text(Object{})) + "`" : std::string();
}

}  // namespace detail

/// The object that the first of these pointers to members belongs to.
template <class... Path>
using OwnerOf = decltype(detail::owner_of(Path()...));

/// A value in the member at this path of members, which `read` makes of a StudyValue and `text` writes as TOML.
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

/// A text.
template <class... Path>
auto text_at(Path... path) {
  return value_at(
      "text", "", [](const StudyValue& value) { return value.text(); }, in_quotes, path...);
}

/// A whole number between these, both included.
template <class... Path>
auto whole_at(std::int64_t least, std::int64_t most, Path... path) {
  const auto read = [=](const StudyValue& value) { return value.whole_number(least, most); };
  const auto text = [](auto number) { return std::to_string(number); };
  return value_at("integer", "at least " + std::to_string(least), read, text, path...);
}

/// A number without a unit.
template <class... Path>
auto number_at(const NumberBounds& bounds, Path... path) {
  const auto read = [=](const StudyValue& value) { return read_number(value, bounds); };
  return value_at("number", bounds.words, read, shortest, path...);
}

/// A length or an angle.
template <class... Path>
auto quantity_at(Dimension dimension, Path... path) {
  const auto read = [=](const StudyValue& value) { return value.quantity(dimension); };
  const auto text = [=](double si) { return exact_value(si, dimension); };
  return value_at(std::string(name(dimension)), "", read, text, path...);
}

/// A length or an angle, above zero.
template <class... Path>
auto positive_at(Dimension dimension, Path... path) {
  const auto read = [=](const StudyValue& value) { return value.positive_quantity(dimension); };
  const auto text = [=](double si) { return exact_value(si, dimension); };
  return value_at(std::string(name(dimension)), "greater than 0", read, text, path...);
}

/// A value of an enumeration, with its word's meaning; the word is name(value).
template <class Enum>
struct WordFor {
  Enum value;                ///< what it stands for
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

/// What is said of the keys of a table.
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

/// The word of the table's chooser that an object has; empty without a chooser.
template <class Object, class Scope>
std::string chosen_word(const Keys<Object, Scope>& keys, const Object& object) {
  if (keys.chooser.empty()) return {};
  const std::string quoted = keys.rows.front().value.text(object);
  return quoted.substr(1, quoted.size() - 2);
}

/// The row of this name. Precondition: there is one.
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

/// What a table must and may have.
enum class Extent {
  complete,  ///< every required key, and none that does not hold for the chooser's word
  partial,   ///< required keys may be missing
  any        ///< and keys that do not hold are read as well
};

/// Reads a table key by key, in the order of its rows. Throws InputError for unknown keys, values out of bounds, and
/// what `extent` does not allow.
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

/// The same of all keys of a table.
template <class Object, class Scope>
std::string template_lines(const TemplateLines& lines, const Keys<Object, Scope>& keys, const Object& object) {
  std::string text;
  for (const Key<Object, Scope>& row : keys.rows) text += template_lines(lines, keys.paths.front(), row, object);
  return text;
}

/// The resolved text of a table's keys: "KEY = VALUE" in lines, with every default filled in.
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
