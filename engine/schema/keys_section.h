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

/// One value of a study file. Every function throws InputError at the value's place when the value is not what is
/// asked for. Refers to the parsed file, which must outlive it.
class StudyValue {
 public:
  /// `name` is the value's full name for messages: "errors.linear.sigma".
  StudyValue(const toml::node& node, std::string name, const Place& section, const StudyTables& tables);

  const std::string& full_name() const { return name_; }  ///< For messages.
  const Place& place() const { return place_; }           ///< Where it stands.
  bool is_text() const { return node_->is_string(); }     ///< Whether it is a text in quotes.
  bool is_section() const { return node_->is_table(); }   ///< Whether it is a table.
  bool is_list() const { return node_->is_array(); }      ///< Whether it is a list.
  /// Whether it is true or false; empty for any other value.
  std::optional<bool> boolean() const { return node_->value_exact<bool>(); }

  bool yes_or_no() const;    ///< True or false.
  std::string text() const;  ///< A text in quotes.
  /// An integer within these bounds, both included.
  std::int64_t whole_number(std::int64_t least, std::int64_t most = std::numeric_limits<std::int64_t>::max()) const;
  double number() const;                       ///< A finite number without a unit.
  double quantity(Dimension dimension) const;  ///< SI.
  /// Whether it is the number 0, which needs no unit.
  bool is_zero() const;
  double positive_quantity(Dimension dimension) const;              ///< SI, above zero.
  double half_width(Dimension dimension) const;                     ///< The same, perhaps as on a drawing: "+-0.02 mm".
  double percent() const;                                           ///< A share, from a text such as "99.73 %".
  std::size_t word(std::span<const std::string_view> words) const;  ///< The position among these words.
  StudySection section() const;                                     ///< A table.
  /// The elements of a list, named with their positions.
  std::vector<StudyValue> list() const;
  /// The same; throws with this remedy when there are not so many.
  std::vector<StudyValue> list(std::size_t size, std::string_view remedy) const;

  /// "NAME PROBLEM; REMEDY" at the value's place.
  [[noreturn]] void fail(std::string_view problem, std::string_view remedy) const;

 private:
  [[noreturn]] void wrong_type(std::string_view remedy) const;
  double quantity_of(const std::string& written, Dimension dimension) const;
  double positive(double value) const;

  const toml::node* node_;
  std::string name_;
  Place place_;
  const StudyTables* tables_;
};

/// A table of a study file, in the same way. A key must be described where it stands, or asking for it is a bug.
class StudySection {
 public:
  /// `name` is empty for the file as a whole. The tables must outlive it.
  StudySection(const toml::table& table, std::string name, Place place, const StudyTables& tables);

  const Place& place() const { return place_; }   ///< Where it begins.
  bool empty() const { return table_->empty(); }  ///< Whether it has no key.
  std::vector<std::string> keys() const;          ///< The keys that the file gives, in the order of their bytes.

  /// Throws for a key that is not described (engine/schema/keys.h). For sections whose keys are all fixed.
  void allow() const;
  /// Throws for a key that is not one of these; `what` says what the keys of this section are.
  void allow(std::span<const std::string_view> known, std::string_view what) const;
  /// Throws for a key that does not hold where the section's chooser is this word.
  void refuse_all_but_those_for(std::string_view word) const;
  /// Throws when the key is there: it "does not belong to OWNER".
  void refuse(std::string_view key, std::string_view owner) const;

  std::optional<StudyValue> find(std::string_view key) const;  ///< Empty when it is missing.
  /// Throws when it is missing; the remedy is that of its description, unless another is given.
  StudyValue require(std::string_view key, std::string_view remedy = {}) const;
  StudySection section(std::string_view key) const;  ///< Empty when it is missing.

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
