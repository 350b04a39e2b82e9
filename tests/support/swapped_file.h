#pragma once

#include <sys/stat.h>

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/support/temp_folder.h"

namespace poesy::test {

/// A thread that puts a FIFO and a plain file at one path in turn, until this object is destroyed. Code that checks the
/// path and then opens it by name waits here for a writer of the FIFO, after some hundred tries.
class SwappedFile {
 public:
  /// path: of an existing plain file. `folder` takes the FIFO and the links that are put at the path.
  SwappedFile(const TempFolder& folder, const std::string& path)
      : path_(path), plain_(folder / "plain"), fifo_(folder / "fifo"), next_(folder / "next") {
    std::filesystem::create_hard_link(path_, plain_);
    if (::mkfifo(fifo_.c_str(), S_IRUSR | S_IWUSR) != 0) throw std::runtime_error("cannot make " + fifo_);
    thread_ = std::thread([this] {
      for (std::size_t n = 0; !done_; ++n) put(n % 2 == 0 ? fifo_ : plain_);
    });
  }
  SwappedFile(const SwappedFile&) = delete;
  SwappedFile& operator=(const SwappedFile&) = delete;
  ~SwappedFile() {
    done_ = true;
    thread_.join();
  }

 private:
  void put(const std::string& file) const {
    std::filesystem::create_hard_link(file, next_);
    std::filesystem::rename(next_, path_);
  }

  std::string path_;
  std::string plain_;
  std::string fifo_;
  std::string next_;
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

}  // namespace poesy::test
