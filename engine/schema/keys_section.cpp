#include "engine/schema/keys_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/ratio.h"
#include "engine/base/text.h"
#include "engine/schema/keys.h"

namespace poesy {
namespace {

Place place_in(const Place& section, const toml::source_region& region) {
  if (region.begin.line == 0) return section;
  return {section.file, region.begin.line, region.begin.column};
}

/// A clause that says what a TOML value is, with the value itself if it is short: "the number 0.5".
std::string described(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "the text '" + printable(node.as_string()->get()) + "'";
    case toml::node_type::integer:
      return "the whole number " + std::to_string(node.as_integer()->get());
    case toml::node_type::floating_point:
      return "the number " + shortest(node.as_floating_point()->get());
    case toml::node_type::boolean:
      return node.as_boolean()->get() ? "true" : "false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a section";
    default:
      return "a date or time";
  }
}

/// The plus-minus sign ("+-", "+/-" or its Unicode character) at the beginning of a text; empty if there is none.
std::string_view range_sign(std::string_view written) {
  for (const std::string_view sign : {"+-", "+/-", "\xC2\xB1"}) {
    if (written.starts_with(sign)) return sign;
  }
  return {};
}

std::string example(Dimension dimension) { return "\"1 " + std::string(display_unit(dimension).name) + "\""; }

/// The unit in lower case without blanks, so that "n m" equals "Nm".
std::string plain_unit(std::string_view written) {
  std::string plain = lower_case(written);
  std::erase(plain, ' ');
  return plain;
}

/// The unit that the user probably meant; null if none is probable. A unit is probable if its name differs from the
/// written text only in capitals and blanks, or if the text begins with the name of a unit of three or more letters, as
/// "degrees" begins with "deg". Other similar names do not count, because one letter at the beginning changes the unit:
/// nm and mm, deg and mdeg.
const Unit* meant_unit(std::string_view written, Dimension dimension) {
  constexpr std::size_t kTelling = 3;
  const std::string plain = plain_unit(written);
  for (const Unit& unit : units()) {
    const std::string name = plain_unit(unit.name);
    const bool begins = name.size() >= kTelling && plain.starts_with(name);
    if (unit.dimension == dimension && (plain == name || begins)) return &unit;
  }
  return nullptr;
}

std::string unit_remedy(std::string_view text, Dimension dimension) {
  const std::string_view written = trimmed(text.substr(text.find_last_of("0123456789.") + 1));
  const Unit* meant = find_unit(written) == nullptr ? meant_unit(written, dimension) : nullptr;
  if (meant != nullptr) return "did you mean '" + std::string(meant->name) + "'?";
  return "write a number and a unit, e.g. " + example(dimension);
}

/// The advice about the key `refused`, which does not apply with this word of the chooser (StudyTable::chooser): to
/// remove it. But if a key that is required with this word is missing, and `refused` is required with another word that
/// leaves no key missing: to write the missing key instead, or the other word. has(name): returns true if the table in
/// the file has this key.
template <class Has>
std::string remedy_for(const StudyTable& table, const StudyKey& refused, std::string_view word, const Has& has) {
  const auto lacking = [&](std::string_view chosen) {
    return std::ranges::find_if(table.keys, [&](const StudyKey& key) {
      return key.required && holds_for(key.only_for, chosen) && !has(key.name);
    });
  };
  const auto none = table.keys.end();
  const auto missing = lacking(word);
  const auto fitting = std::ranges::find_if(refused.only_for, [&](auto other) { return lacking(other) == none; });
  if (missing == none || !refused.required || fitting == refused.only_for.end()) return "remove it";
  return "write " + std::string(missing->name) + " = ... instead, or " + std::string(table.chooser) + " = \"" +
         std::string(*fitting) + "\"";
}

/// A key that users write in a table although the table has no such key.
struct ExpectedKey {
  std::string_view table;   ///< name of the table
  std::string_view key;     ///< name of the key
  std::string_view beside;  ///< key that tells this table from tables with the same name in other kinds of files
  std::string_view remedy;  ///< what to write instead
};

constexpr std::array kExpectedKeys{
    ExpectedKey{
        "errors", "tolerance", "linear",
        "write linear = { distribution = \"uniform\", half_width = \"0.02 mm\" }, and angular = { distribution = "
        "\"uniform\", half_width = \"0.02 deg\" }"},
    ExpectedKey{"run", "threads", "seed", "give it on the command line: --threads N"}};

/// The path of the only top-level table (not a list of tables) that has this key; empty if none or several have it.
std::string_view table_with(std::string_view key, const StudyTables& tables) {
  std::string_view found;
  for (const StudyTable& table : tables) {
    const std::string_view path = table.paths.front();
    if (path.empty() || path.find_first_of(".[") != std::string_view::npos || table.find(key) == nullptr) continue;
    if (!found.empty()) return {};
    found = path;
  }
  return found;
}

/// What to write instead of an unknown key of a table. what: "key", or the noun for names of the model.
std::string remedy_for_unknown(std::string_view what, std::string_view table, std::string_view key,
                               std::span<const std::string_view> known, const StudyTables& tables) {
  const auto expected = std::ranges::find_if(kExpectedKeys, [&](const ExpectedKey& one) {
    return one.table == table && one.key == key && std::ranges::find(known, one.beside) != known.end();
  });
  if (expected != kExpectedKeys.end()) return std::string(expected->remedy);
  const bool may_be_misplaced = what == "key" && nearest(key, known).empty();
  const std::string_view owner = may_be_misplaced ? table_with(key, tables) : std::string_view();
  return owner.empty() ? suggestion(key, known) : fmt::format("it is a key of [{}]", owner);
}

}  // namespace

StudyValue::StudyValue(const toml::node& node, std::string name, const Place& section, const StudyTables& tables)
    : node_(&node), name_(std::move(name)), place_(place_in(section, node.source())), tables_(&tables) {}

void StudyValue::fail(std::string_view problem, std::string_view remedy) const {
  throw InputError(place_, name_ + " " + std::string(problem), remedy);
}

void StudyValue::wrong_type(std::string_view remedy) const { fail("is " + described(*node_), remedy); }

bool StudyValue::yes_or_no() const {
  if (const auto answer = boolean()) return *answer;
  wrong_type("write true or false, without quotes");
}

std::string StudyValue::text() const {
  const auto* text = node_->as_string();
  if (text == nullptr) wrong_type("write a text in quotes");
  // If the text is a file name, the operating system would end it at the NUL and open another file.
  if (text->get().find('\0') != std::string::npos) fail("holds a NUL character", "remove it");
  return text->get();
}

std::int64_t StudyValue::whole_number(std::int64_t least, std::int64_t most) const {
  const auto* number = node_->as_integer();
  if (number == nullptr) {
    constexpr double kExact = 9007199254740992.0;  // 2^53: below it doubles have all whole numbers
    const double real = node_->value<double>().value_or(std::nan(""));
    const bool is_whole = std::abs(real) < kExact && real == std::round(real);
    wrong_type(is_whole ? fmt::format("write it without point and exponent: {:.0f}", real) : "write a whole number");
  }
  const std::int64_t value = number->get();
  if (value < least) fail("is " + std::to_string(value), "it must be at least " + std::to_string(least));
  if (value > most) fail("is " + std::to_string(value), "it must be at most " + std::to_string(most));
  return value;
}

double StudyValue::number() const {
  if (!node_->is_number()) wrong_type("write a number without a unit");
  const double number = node_->value<double>().value_or(std::nan(""));
  if (!std::isfinite(number)) fail("is not finite", "write a finite number");
  return number;
}

double StudyValue::percent() const {
  const std::string written(trimmed(printable(text())));
  // The percentage is read with the exponent e-2, because a division would round: 99.73 % is the double nearest to
  // 0.9973.
  const auto share = written.ends_with('%')
                         ? parse_number(std::string(trimmed(written.substr(0, written.size() - 1))) + "e-2")
                         : std::nullopt;
  if (!share) wrong_type("write a number, or a text in percent: \"95 %\"");
  return *share;
}

double StudyValue::quantity(Dimension dimension) const {
  if (dimension == Dimension::number) return is_text() ? quantity_of(printable(text()), dimension) : number();
  if (node_->is_number())
    fail("is the bare number " + shortest(number()), "write it with a unit, e.g. " + example(dimension));
  if (!is_text()) wrong_type("write a number and a unit in quotes, e.g. " + example(dimension));
  return quantity_of(printable(text()), dimension);
}

double StudyValue::quantity_of(const std::string& written, Dimension dimension) const {
  if (dimension == Dimension::number) {
    if (const auto share = parse_ratio(written)) return *share;
    if (const auto bare = parse_number(written)) return *bare;
    fail("is '" + written + "', but must be a number", "write it without a unit, or like \"0.1 %\" or \"50 um/m\"");
  }
  try {
    const Quantity quantity = parse_quantity(written, dimension);
    if (quantity.dimension == dimension) return quantity.si;
  } catch (const QuantityError& reason) {
    if (!range_sign(written).empty())
      fail("is the range '" + written + "'",
           "write one number; a distribution takes the +- of a drawing as half_width");
    fail(std::string("cannot be read: ") + reason.what(), unit_remedy(written, dimension));
  }
  fail("is '" + written + "', but must be " + with_article(dimension), "write it like " + example(dimension));
}

bool StudyValue::is_zero() const { return node_->is_number() && number() == 0.0; }

double StudyValue::half_width(Dimension dimension) const {
  if (!is_text()) return positive_quantity(dimension);
  const std::string written = printable(text());
  const std::size_t sign = range_sign(written).size();
  return sign == 0 ? positive_quantity(dimension) : positive(quantity_of(written.substr(sign), dimension));
}

double StudyValue::positive_quantity(Dimension dimension) const { return positive(quantity(dimension)); }

double StudyValue::positive(double value) const {
  if (value > 0.0) return value;
  fail(is_text() ? "is '" + printable(text()) + "'" : "is " + described(*node_), "it must be greater than zero");
}

std::size_t StudyValue::word(std::span<const std::string_view> words) const {
  const std::string written = text();
  const auto found = std::find(words.begin(), words.end(), written);
  if (found == words.end()) fail("is '" + printable(written) + "', which is unknown", suggestion(written, words));
  return static_cast<std::size_t>(found - words.begin());
}

StudySection StudyValue::section() const {
  const auto* table = node_->as_table();
  if (table == nullptr) wrong_type("write a section [" + name_ + "] or { key = value }");
  return StudySection(*table, name_, place_, *tables_);
}

std::vector<StudyValue> StudyValue::list() const {
  const auto* array = node_->as_array();
  if (array == nullptr) wrong_type("write a list in [ ]");
  std::vector<StudyValue> values;
  for (const toml::node& element : *array) {
    values.emplace_back(element, name_ + "[" + std::to_string(values.size()) + "]", place_, *tables_);
  }
  return values;
}

std::vector<StudyValue> StudyValue::list(std::size_t size, std::string_view remedy) const {
  std::vector<StudyValue> values = list();
  if (values.size() != size) fail("has " + std::to_string(values.size()) + " values", remedy);
  return values;
}

StudySection::StudySection(const toml::table& table, std::string name, Place place, const StudyTables& tables)
    : table_(&table),
      name_(std::move(name)),
      place_(std::move(place)),
      tables_(&tables),
      described_(find_table(tables, name_)) {}

std::vector<std::string> StudySection::keys() const {
  std::vector<std::string> list;
  for (const auto& [key, value] : *table_) list.emplace_back(key.str());
  return list;
}

void StudySection::allow() const {
  POESY_EXPECTS(described_ != nullptr && !described_->has_names_of_model());
  allow(described_->names(), "key");
}

void StudySection::allow(std::span<const std::string_view> known, std::string_view what) const {
  for (const std::string& key : keys()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw InputError(place_of_key(key), "unknown " + std::string(what) + " '" + printable(key) + "'" + where(),
                     remedy_for_unknown(what, name_, key, known, *tables_));
  }
}

void StudySection::refuse_all_but_those_for(std::string_view word) const {
  POESY_EXPECTS(described_ != nullptr && !described_->chooser.empty());
  for (const StudyKey& key : described_->keys) {
    const StudyKey& chosen = *described_->find(key.name, word);
    if (holds_for(chosen.only_for, word) || chosen.may_stay) continue;
    if (!find(key.name)) continue;
    const auto has = [&](std::string_view name) { return table_->contains(name); };
    throw InputError(place_of_key(key.name), full_name(key.name) + " does not belong to " + described_->owner_of(word),
                     remedy_for(*described_, chosen, word, has));
  }
}

void StudySection::refuse(std::string_view key, std::string_view owner) const {
  if (!find(key)) return;
  throw InputError(place_of_key(key), full_name(key) + " does not belong to " + std::string(owner), "remove it");
}

std::optional<StudyValue> StudySection::find(std::string_view key) const {
  POESY_EXPECTS(described_ != nullptr && (described_->has_names_of_model() || described_->find(key) != nullptr));
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  return StudyValue(*node, full_name(key), place_, *tables_);
}

StudyValue StudySection::require(std::string_view key, std::string_view remedy) const {
  if (auto value = find(key)) return *std::move(value);
  throw InputError(place_, "key '" + std::string(key) + "' is missing" + where(),
                   remedy.empty() ? described_->remedy(key) : remedy);
}

StudySection StudySection::section(std::string_view key) const {
  static const toml::table kNothing;
  const auto value = find(key);
  return value ? value->section() : StudySection(kNothing, full_name(key), place_, *tables_);
}

Place StudySection::place_of_key(std::string_view key) const {
  const auto entry = table_->find(key);
  return entry == table_->end() ? place_ : place_in(place_, entry->first.source());
}

std::string StudySection::full_name(std::string_view key) const {
  return name_.empty() ? printable(key) : name_ + "." + printable(key);
}

std::string StudySection::where() const { return name_.empty() ? std::string() : " in [" + name_ + "]"; }

}  // namespace poesy
