#include "engine/io/second_name.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "engine/base/error.h"

namespace poesy {

namespace fs = std::filesystem;

void put_at_second_name(const std::string& path, const std::string& second, LinkFile link_file) {
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
