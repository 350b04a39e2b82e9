#include "engine/io/study_keys.h"

#include <algorithm>
#include <cctype>

#include "engine/base/contract.h"

namespace poesy {
namespace {

/// "groups" of "groups[0]".
std::string_view without_number(std::string_view name) { return name.substr(0, name.find('[')); }

bool stands_for_names(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](unsigned char letter) { return std::isupper(letter) != 0; });
}

/// Takes the first name of a path off it.
std::string_view first_name(std::string_view& path) {
  const std::size_t end = std::min(path.find('.'), path.size());
  const std::string_view name = path.substr(0, end);
  path.remove_prefix(std::min(end + 1, path.size()));
  return name;
}

bool fits(std::string_view described, std::string_view path) {
  while (!described.empty() && !path.empty()) {
    const std::string_view pattern = first_name(described);
    const std::string_view name = first_name(path);
    if (pattern != without_number(name) && !stands_for_names(pattern)) return false;
  }
  return described.empty() && path.empty();
}

std::string plain(std::string_view text) {
  std::string out(text);
  std::erase(out, '`');
  return out;
}

/// "required for interior, boundary, grid".
std::string condition(const StudyKey& key) {
  std::string text(key.required ? "required" : "");
  for (std::size_t w = 0; w < key.only_for.size(); ++w) {
    text += (w > 0 ? ", " : text.empty() ? "for " : " for ") + std::string(key.only_for[w]);
  }
  return text;
}

std::string as_sentence(std::string_view clause) {
  std::string text(clause);
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text + ".";
}

}  // namespace

const StudyKey* StudyTable::find(std::string_view key) const {
  const auto found = std::ranges::find(keys, key, &StudyKey::name);
  return found == keys.end() ? nullptr : &*found;
}

std::vector<std::string_view> StudyTable::names() const {
  std::vector<std::string_view> list;
  for (const StudyKey& key : keys) list.push_back(key.name);
  return list;
}

bool StudyTable::has_names_of_model() const { return std::ranges::any_of(keys, is_name_of_model); }

const StudyTable* find_study_table(std::string_view path) {
  for (const StudyTable& table : study_tables()) {
    for (const std::string_view described : table.paths) {
      if (fits(described, path)) return &table;
    }
  }
  return nullptr;
}

const StudyKey& study_key(std::string_view path, std::string_view key) {
  const StudyTable* table = find_study_table(path);
  POESY_EXPECTS(table != nullptr && table->find(key) != nullptr);
  return *table->find(key);
}

bool is_name_of_model(const StudyKey& key) { return stands_for_names(key.name); }

bool holds_for(const StudyKey& key, std::string_view word) {
  return key.only_for.empty() || std::ranges::find(key.only_for, word) != key.only_for.end();
}

std::string explanation(const StudyKey& key) {
  std::string text(key.meaning);
  if (!key.bounds.empty()) text += " " + as_sentence(key.bounds);
  if (key.required || !(key.only_for.empty() || key.may_stay)) text += " " + as_sentence(condition(key));
  if (!key.usual.empty()) text += " Default: " + plain(key.usual) + ".";
  return text;
}

}  // namespace poesy
