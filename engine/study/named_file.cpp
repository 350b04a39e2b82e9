#include <filesystem>
#include <system_error>

#include "engine/base/plain_file.h"
#include "engine/base/text.h"
#include "engine/study/study_kind.h"

namespace poesy {

std::string beside_study(const Place& place, const std::string& file) {
  return (std::filesystem::path(place.file).parent_path() / file).string();
}

std::string named_file(const StudyValue& value) {
  const std::string name = value.text();
  std::string path = beside_study(value.place(), name);
  const PlainFile file(path);
  if (file.is_open()) return path;
  if (!file.other().empty()) {
    value.fail("names '" + printable(path) + "', which is " + std::string(file.other()), "name a file");
  }
  // False if the value comes from a caller of the library instead of a study file; there is then no study's folder.
  const bool is_in_file = !value.place().file.empty();
  throw FileError(to_string(value.place()),
                  value.full_name() + " names '" + printable(path) +
                      "', which cannot be read: " + std::generic_category().message(file.error()),
                  is_in_file ? "check the path, which is relative to the study's folder, and its permissions"
                             : "check the path and its permissions");
}

}  // namespace poesy
