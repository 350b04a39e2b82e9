#pragma once

#include <string>

namespace poesy {

/// Keeps other runs from the same result, and so from its checkpoints, while it lives: an advisory lock on
/// RESULT.h5.lock, which goes with the process however that ends. Where the file system knows no locks there is none.
class RunLock {
 public:
  /// Throws InputError when another run has it.
  explicit RunLock(const std::string& result_path);
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;
  ~RunLock();

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace poesy
