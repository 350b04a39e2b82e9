#include "engine/files/run_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "engine/base/error.h"

namespace poesy {

RunLock::RunLock(const std::string& result_path) : path_(result_path + ".lock") {
  for (;;) {
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) return;
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const bool taken = errno == EWOULDBLOCK;
      ::close(std::exchange(descriptor_, -1));
      if (!taken) return;
      throw InputError({.file = result_path}, "another run is computing this result",
                       "wait for it, or give each run its own -o");
    }
    struct stat file {};
    // A run that ended in between has removed the file: a lock on that keeps nobody away.
    if (::fstat(descriptor_, &file) == 0 && file.st_nlink > 0) return;
    ::close(std::exchange(descriptor_, -1));
  }
}

RunLock::~RunLock() {
  if (descriptor_ < 0) return;
  ::unlink(path_.c_str());
  ::close(descriptor_);
}

}  // namespace poesy
