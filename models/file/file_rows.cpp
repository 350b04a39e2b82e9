#include "models/file/file_rows.h"

#include <algorithm>
#include <cctype>
#include <tuple>

namespace poesy::file {
namespace {

constexpr std::int64_t kMostCopies = 100;

/// The largest length of a name, so that messages and tables show it in full with its suffixes.
constexpr std::size_t kLongestName = 48;

const Keys<Copies, Nothing>& copies_keys() {
  const auto axis = [](const StudyValue& value) { return value.word(kAxes); };
  static const Keys<Copies, Nothing> keys{
      .paths = {"limb.copies", "body.copies"},
      .meaning = "Limbs or bodies alike: the k-th of them is the first turned by (k - 1) 360 deg / count.",
      .rows = {needed("count", whole_at(1, kMostCopies, &Copies::count), "3", "How many there are."),
               needed("about", kept("text", axis, &Copies::about), "\"z\"",
                      "About which axis of the base they are turned: x, y or z.")}};
  return keys;
}

}  // namespace

Expression expression(const StudyValue& value) {
  if (value.is_text()) return {value.text(), value.full_name(), value.place(), true};
  return {shortest(value.number()), value.full_name(), value.place(), false};
}

Triple point(const StudyValue& value) {
  const std::vector<StudyValue> list = value.list();
  if (list.size() != 3) {
    value.fail("has " + std::to_string(list.size()) + " values", "write three, e.g. [\"60 mm\", 0, 0]");
  }
  return {{expression(list[0]), expression(list[1]), expression(list[2])}, value.full_name(), value.place()};
}

Triple direction(const StudyValue& value) {
  if (!value.is_text()) {
    const std::vector<StudyValue> list = value.list();
    if (list.size() == 2 && list[0].is_text() && list[1].is_text()) {
      value.fail("has 2 values", "write one direction, e.g. \"x\"; the second axis of a U joint is its key axis2");
    }
    return point(value);
  }
  std::string word = value.text();
  const bool back = word.starts_with('-');
  if (back) word.erase(0, 1);
  const auto axis = std::ranges::find(kAxes, word);
  if (axis == kAxes.end()) {
    value.fail("is '" + printable(value.text()) + "'",
               "write \"x\", \"y\", \"z\", a minus before it, or [x, y, z] for a direction");
  }
  Triple triple{{}, value.full_name(), value.place()};
  triple.entries.fill({"0", value.full_name(), value.place(), false});
  triple.entries[static_cast<std::size_t>(axis - kAxes.begin())].text = back ? "-1" : "1";
  return triple;
}

Reference reference(const StudyValue& value) { return {value.text(), value.full_name(), value.place()}; }

std::vector<Reference> references(const StudyValue& value) {
  if (value.is_text()) return {reference(value)};
  std::vector<Reference> list;
  for (const StudyValue& element : value.list()) list.push_back(reference(element));
  return list;
}

void check_name(const Reference& reference) {
  const auto allowed = [](unsigned char c) { return c < 0x80 && (std::isalnum(c) != 0 || c == '_' || c == '-'); };
  if (reference.name.size() > kLongestName) {
    throw InputError(reference.place, reference.key + " '" + printable(reference.name) + "' is too long",
                     "write at most " + std::to_string(kLongestName) + " letters");
  }
  if (!reference.name.empty() && !reference.name.starts_with('-') && std::ranges::all_of(reference.name, allowed)) {
    return;
  }
  throw InputError(reference.place, reference.key + " '" + printable(reference.name) + "' is not a name",
                   "write letters, digits, _ and -, and do not begin with -");
}

void add_name(const Reference& reference, std::unordered_set<std::string>& taken, std::string_view whose) {
  check_name(reference);
  if (taken.insert(reference.name).second) return;
  throw InputError(reference.place,
                   reference.key + " '" + reference.name + "' is the name of another " + std::string(whose),
                   "give it a name of its own");
}

std::string read_name(const StudyValue& value) {
  check_name(reference(value));
  return value.text();
}

std::vector<Reference> keys_in_order(const StudySection& section) {
  std::vector<Reference> list;
  for (const std::string& key : section.keys()) {
    const StudyValue value = *section.find(key);
    list.push_back({key, value.full_name(), value.place()});
    check_name(list.back());
  }
  std::ranges::sort(list, {}, [](const Reference& at) { return std::tuple(at.place.line, at.place.column); });
  return list;
}

std::vector<StudyValue> tables(const StudyValue& value) {
  if (value.is_section()) value.fail("is one table", "write double brackets: [[" + value.full_name() + "]]");
  return value.list();
}

Copies read_copies(const StudyValue& value) {
  Copies copies;
  read_keys(copies_keys(), value.section(), copies, Nothing{});
  return copies;
}

StudyTable copies_table() { return described(copies_keys()); }

}  // namespace poesy::file
