#pragma once

#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "engine/schema/keys.h"
#include "models/file/lines.h"

/// The keys of the tables of a mechanism file (each is a row of a table of keys), with functions that read their
/// values.
namespace poesy::file {

/// The empty context of tables whose values can be read without other data (the parameter Scope of Key).
struct Nothing {};

/// A key of a table whose value can be read without other data.
template <class Object>
using Row = Key<Object, Nothing>;

/// The KeyValue of a key whose value is converted by read(StudyValue) and stored in a member of the object. path:
/// pointers to members that lead from the object to this member.
template <class Read, class... Path>
auto kept(std::string type, Read read, Path... path) {
  using Object = OwnerOf<Path...>;
  return KeyValue<Object>{.type = std::move(type), .read = [=](const StudyValue& value, Object& object) {
                            detail::at(object, path...) = read(value);
                          }};
}

/// The KeyValue of a key whose value is read by read(StudyValue, object), which sets members of the object.
template <class Object>
KeyValue<Object> read_by(std::string type, void (*read)(const StudyValue&, Object&)) {
  return {.type = std::move(type), .read = read};
}

/// A key that must be given. only_for: the kinds of the table (values of its key `type` or `kind`) that have the key;
/// empty: all.
template <class Object>
Row<Object> needed(std::string_view name, KeyValue<Object> value, std::string example, std::string_view meaning,
                   std::vector<std::string_view> only_for = {}) {
  Row<Object> row{.name = name, .value = std::move(value), .missing = "write {}", .meaning = meaning};
  row.example = std::move(example);
  row.only_for = std::move(only_for);
  return row;
}

/// A key that may be left out. usual: text that states the value if the key is left out. only_for: as for needed().
template <class Object>
Row<Object> optional(std::string_view name, KeyValue<Object> value, std::string usual, std::string_view meaning,
                     std::vector<std::string_view> only_for = {}) {
  Row<Object> row{.name = name, .value = std::move(value), .usual = std::move(usual), .meaning = meaning};
  row.only_for = std::move(only_for);
  return row;
}

/// The names of the base's axes, in files.
inline constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};

Expression expression(const StudyValue& value);  ///< Reads an expression: a text or a bare number.
Triple point(const StudyValue& value);           ///< Reads a point: a list of three entries.
Triple direction(const StudyValue& value);       ///< Reads a direction: "x", "-z", or three numbers or expressions.

Reference reference(const StudyValue& value);                ///< Reads a name.
std::vector<Reference> references(const StudyValue& value);  ///< Reads a name, or a list of names.

/// Throws InputError if a name is empty, is too long, begins with -, or contains a character that names must not have.
void check_name(const Reference& reference);

/// Adds the name to `taken`. Throws if check_name() does, or if `taken` already has the name. whose: noun for the owner
/// of the name in the message, such as "limb".
void add_name(const Reference& reference, std::unordered_set<std::string>& taken, std::string_view whose);

std::string read_name(const StudyValue& value);  ///< Reads a text that passes check_name().

/// The keys of a table in which the file chooses the names of the keys, in the order of the file. Throws if
/// check_name() does.
std::vector<Reference> keys_in_order(const StudySection& section);

/// The tables in a list of tables `[[...]]`. Throws InputError if the value is a single table.
std::vector<StudyValue> tables(const StudyValue& value);

/// Reads `copies = { count = 3, about = "z" }`.
Copies read_copies(const StudyValue& value);

/// The table of the keys of `copies`, for key_reference().
StudyTable copies_table();

}  // namespace poesy::file
