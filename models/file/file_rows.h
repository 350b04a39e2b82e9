#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/schema/keys.h"
#include "models/file/lines.h"

/// Rows of the tables of a mechanism file, and functions that read their values.
namespace poesy::file {

/// The scope of tables whose rows need only the value.
struct Nothing {};

/// A row of a table with scope Nothing.
template <class Object>
using Row = Key<Object, Nothing>;

/// A value for the member at this path, made by `read` from a StudyValue.
template <class Read, class... Path>
auto kept(std::string type, Read read, Path... path) {
  using Object = OwnerOf<Path...>;
  return KeyValue<Object>{.type = std::move(type), .read = [=](const StudyValue& value, Object& object) {
                            detail::at(object, path...) = read(value);
                          }};
}

/// A value made by `read` from a StudyValue and the present object.
template <class Object>
KeyValue<Object> read_by(std::string type, void (*read)(const StudyValue&, Object&)) {
  return {.type = std::move(type), .read = read};
}

/// A required row, for all words of the table's chooser or only for these.
template <class Object>
Row<Object> needed(std::string_view name, KeyValue<Object> value, std::string example, std::string_view meaning,
                   std::vector<std::string_view> only_for = {}) {
  Row<Object> row{.name = name, .value = std::move(value), .missing = "write {}", .meaning = meaning};
  row.example = std::move(example);
  row.only_for = std::move(only_for);
  return row;
}

/// An optional row. usual: the value if it is left out.
template <class Object>
Row<Object> optional(std::string_view name, KeyValue<Object> value, std::string usual, std::string_view meaning,
                     std::vector<std::string_view> only_for = {}) {
  Row<Object> row{.name = name, .value = std::move(value), .usual = std::move(usual), .meaning = meaning};
  row.only_for = std::move(only_for);
  return row;
}

/// The base's axes by their names.
inline constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};

Expression expression(const StudyValue& value);  ///< A text or a bare number.
Triple point(const StudyValue& value);           ///< A list of three entries.
Triple direction(const StudyValue& value);       ///< "x", "-z", or three numbers or expressions.

Reference reference(const StudyValue& value);                ///< A name.
std::vector<Reference> references(const StudyValue& value);  ///< A name, or a list of names.

/// Throws if a name is too long or contains letters that names must not have.
void check_name(const Reference& reference);

/// Throws if the name is already taken.
template <class Named>
void check_new(const Reference& reference, const std::vector<Named>& taken, std::string_view whose) {
  check_name(reference);
  const auto same = [&](const Named& other) { return other.name == reference.name; };
  if (std::ranges::none_of(taken, same)) return;
  throw InputError(reference.place,
                   reference.key + " '" + reference.name + "' is the name of another " + std::string(whose),
                   "give it a name of its own");
}

std::string read_name(const StudyValue& value);  ///< A text that passes check_name().

/// The keys of a table, in the order of the file, which chooses their names.
std::vector<Reference> keys_in_order(const StudySection& section);

/// The tables of a list `[[...]]`.
std::vector<StudyValue> tables(const StudyValue& value);

/// Reads `copies = { count = 3, about = "z" }`.
Copies read_copies(const StudyValue& value);

/// The keys of `copies`, for the reference.
StudyTable copies_table();

}  // namespace poesy::file
