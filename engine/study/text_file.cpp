#include "engine/study/text_file.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "engine/base/error.h"

namespace poesy {
namespace {

[[noreturn]] void unreadable(const std::string& path, int reason) {
  throw FileError(path, "cannot be read: " + std::generic_category().message(reason),
                  "check the path and its permissions");
}

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

std::string read_text(const std::string& path, std::string_view what, std::size_t most_bytes) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError({path}, "is a folder, not a " + std::string(what), "name a file");
  }
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
  if (!file) unreadable(path, errno);
  std::string text;
  std::array<char, 65536> part{};
  while (const std::size_t bytes = std::fread(part.data(), 1, part.size(), file.get())) {
    text.append(part.data(), bytes);
    if (text.size() > most_bytes) {
      throw InputError(
          {path}, "has more than the " + std::to_string(most_bytes) + " bytes a " + std::string(what) + " may have",
          "name another file");
    }
  }
  if (std::ferror(file.get()) != 0) unreadable(path, errno);
  return text;
}

void put_at_second_name(const std::string& path, const std::string& second, LinkFile link_file) {
  namespace fs = std::filesystem;
  const std::string temporary = second + ".tmp";
  std::error_code error;
  std::error_code ignored;
  fs::remove(temporary, ignored);
  if (link_file(path.c_str(), temporary.c_str()) != 0) {
    fs::copy_file(path, temporary, fs::copy_options::overwrite_existing, error);
  }
  if (!error) fs::rename(temporary, second, error);
  // Between two names of one file a rename does nothing, and a copy may have failed halfway.
  fs::remove(temporary, ignored);
  if (error) throw FileError(second, "cannot be put in place (" + error.message() + ")", "check the folder");
}

void put_at_second_name(const std::string& path, const std::string& second) {
  put_at_second_name(path, second, ::link);
}

}  // namespace poesy
