#include "engine/report/limb_names.h"

#include <map>
#include <set>

namespace poesy {

std::string_view stem_of(std::string_view name) {
  const std::size_t end = name.find_last_not_of("0123456789");
  const bool is_numbered = end != std::string_view::npos && end > 0 && end + 1 < name.size() && name[end] == '_';
  return is_numbered ? name.substr(0, end) : name;
}

void join_limbs(std::vector<std::string>& names) {
  std::map<std::string, std::set<std::string>> names_of_stem;
  for (const std::string& name : names) names_of_stem[std::string(stem_of(name))].insert(name);
  for (std::string& name : names) {
    const std::string stem(stem_of(name));
    if (names_of_stem[stem].size() > 1) name = stem + "_*";
  }
}

}  // namespace poesy
