#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/units.h"

namespace poesy {

class StudySection;
struct StudyTable;
using StudyTables = std::vector<StudyTable>;  ///< The tables of a study file, with every key.

/// One value of a study file. Each function that reads it throws InputError at the value's place if the value has
/// another type or is not allowed. The object refers to the parsed file, which must outlive it.
class StudyValue {
 public:
  /// name: the value's full name for messages, "errors.linear.sigma". section: the place of the table that has the
  /// value; used if the parser gives no place for the value.
  StudyValue(const toml::node& node, std::string name, const Place& section, const StudyTables& tables);

  const std::string& full_name() const { return name_; }  ///< The full name, for messages.
  const Place& place() const { return place_; }           ///< The place of the value in the file.
  bool is_text() const { return node_->is_string(); }     ///< Returns true if the value is a text in quotes.
  bool is_section() const { return node_->is_table(); }   ///< Returns true if the value is a table.
  bool is_list() const { return node_->is_array(); }      ///< Returns true if the value is a list.
  /// The value if it is a boolean; none for any other value.
  std::optional<bool> boolean() const { return node_->value_exact<bool>(); }

  bool yes_or_no() const;    ///< Reads true or false.
  std::string text() const;  ///< Reads a text in quotes.
  /// Reads an integer within these bounds, both included.
  std::int64_t whole_number(std::int64_t least, std::int64_t most = std::numeric_limits<std::int64_t>::max()) const;
  double number() const;                       ///< Reads a finite number without a unit.
  double quantity(Dimension dimension) const;  ///< Reads a quantity of this dimension, SI.
  /// Returns true if the value is the number 0, which needs no unit.
  bool is_zero() const;
  double positive_quantity(Dimension dimension) const;  ///< Reads a quantity above zero, SI.
  /// Reads a quantity above zero, SI; as on a drawing, the text may begin with a plus-minus sign: "+-0.02 mm".
  double half_width(Dimension dimension) const;
  double percent() const;  ///< Reads a share from a text in percent, such as "99.73 %".
  /// Reads one of these words, and returns its index.
  std::size_t word(std::span<const std::string_view> words) const;
  StudySection section() const;  ///< Reads a table.
  /// Reads a list. The full name of each element ends with its index: "pairs[0]".
  std::vector<StudyValue> list() const;
  /// Reads a list of `size` elements. Throws InputError with this remedy if the list has another number of elements.
  std::vector<StudyValue> list(std::size_t size, std::string_view remedy) const;

  /// Reads `written`, a part of this value's text, as quantity() reads a whole text. Messages quote `written`.
  double quantity_of(const std::string& written, Dimension dimension) const;

  /// Throws InputError "NAME PROBLEM; REMEDY" at the value's place.
  [[noreturn]] void fail(std::string_view problem, std::string_view remedy) const;

 private:
  [[noreturn]] void wrong_type(std::string_view remedy) const;
  double positive(double value) const;

  const toml::node* node_;
  std::string name_;
  Place place_;
  const StudyTables* tables_;
};

/// A table of a study file; see StudyValue. A caller may only ask for keys that are in the table's description; asking
/// for another key is a bug.
class StudySection {
 public:
  /// name: full name of the table; empty for the file as a whole. tables: must outlive this object.
  StudySection(const toml::table& table, std::string name, Place place, const StudyTables& tables);

  const Place& place() const { return place_; }   ///< The place where the table begins.
  bool empty() const { return table_->empty(); }  ///< Returns true if the table has no key.
  std::vector<std::string> keys() const;          ///< The keys that the file gives, sorted by their bytes.

  /// Throws InputError for a key that is not in the table's description (engine/schema/keys.h). Precondition: the
  /// description has no placeholder for names that the model gives.
  void allow() const;
  /// Throws InputError for a key that is not in `known`. what: noun for a key in messages, such as "joint".
  void allow(std::span<const std::string_view> known, std::string_view what) const;
  /// Throws InputError for a key that does not apply with this word of the table's chooser (StudyTable::chooser),
  /// unless the key is to be ignored (StudyKey::may_stay).
  void refuse_all_but_those_for(std::string_view word) const;
  /// Throws InputError if the table has this key. The message says that the key "does not belong to" `owner`.
  void refuse(std::string_view key, std::string_view owner) const;

  std::optional<StudyValue> find(std::string_view key) const;  ///< The value of a key; none if it is missing.
  /// The value of a key. Throws InputError if the key is missing, with this remedy or, if `remedy` is empty, with the
  /// remedy of the key's description.
  StudyValue require(std::string_view key, std::string_view remedy = {}) const;
  StudySection section(std::string_view key) const;  ///< The table at a key; an empty one if the key is missing.

 private:
  Place place_of_key(std::string_view key) const;
  std::string full_name(std::string_view key) const;
  std::string where() const;

  const toml::table* table_;
  std::string name_;
  Place place_;
  const StudyTables* tables_;
  const StudyTable* described_;
};

}  // namespace poesy
