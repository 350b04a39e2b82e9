#include "engine/files/output_path.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "engine/base/error.h"

namespace poesy {
namespace {

namespace fs = std::filesystem;

/// What stands at the path must not be lost.
void check_present(const std::string& path, const OutputKind& kind, std::span<const std::string> inputs) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  if (!fs::is_regular_file(path, ignored)) {
    throw InputError({.file = path}, fs::is_directory(path, ignored) ? "is a folder" : "is not a plain file",
                     fmt::format("name a file for the {}", kind.name));
  }
  for (const std::string& input : inputs) {
    if (!fs::equivalent(path, input, ignored)) continue;
    throw InputError({.file = path}, fmt::format("is also an input, which the {} would replace", kind.name),
                     "name another file with -o");
  }
  if (kind.may_be_replaced(path)) return;
  throw InputError({.file = path}, fmt::format("exists and is no {} of poesy, and it would be lost", kind.name),
                   "name another file with -o, or remove it");
}

}  // namespace

bool is_marked(const std::string& path, std::string_view mark) {
  constexpr std::size_t kHead = 1024;
  std::string head(kHead, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file) return false;
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head.empty() || head.find(mark) != std::string::npos;
}

void check_output_path(const std::string& path, const OutputKind& kind, std::span<const std::string> inputs) {
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  check_present(path, kind, inputs);
  if (std::error_code ignored; !fs::is_directory(folder, ignored)) {
    throw InputError({.file = path}, "its folder " + folder.string() + " does not exist", "make it or choose another");
  }
  if (!fs::path(path).has_filename()) {
    throw InputError({.file = path}, "names no file", fmt::format("name a file for the {}", kind.name));
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    const std::string reason = std::generic_category().message(errno);
    throw FileError(path, "cannot be written into its folder (" + reason + ")", "choose another folder");
  }
}

}  // namespace poesy
