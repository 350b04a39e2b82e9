#include "engine/study/study_kind.h"

#include <algorithm>
#include <utility>

namespace poesy {

bool StudyKind::has_key(std::string_view key) const { return std::ranges::find(keys, key) != keys.end(); }

StudyKinds study_kinds_of(std::vector<const StudyKind*> all, std::span<const std::string_view> order) {
  StudyKinds kinds{std::move(all), {described(file_keys())}};
  const auto analysis = std::ranges::find(kinds.tables.front().keys, "analysis", &StudyKey::name);
  analysis->usual = "a " + std::string(kinds.all.front()->name) + " study";
  for (const StudyTables& more :
       {mechanism_tables(), poses_tables(), errors_tables(), analysis_tables(kinds.all, order),
        StudyTables{described(solver_keys()), described(run_keys())}}) {
    kinds.tables.insert(kinds.tables.end(), more.begin(), more.end());
  }
  return kinds;
}

const StudyKind* find(const StudyKinds& kinds, std::string_view name) {
  const auto found = std::ranges::find(kinds.all, name, [](const StudyKind* kind) { return kind->name; });
  return found == kinds.all.end() ? nullptr : *found;
}

std::vector<std::string_view> names(const StudyKinds& kinds) {
  std::vector<std::string_view> list;
  for (const StudyKind* kind : kinds.all) list.push_back(kind->name);
  return list;
}

}  // namespace poesy
