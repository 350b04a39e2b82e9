#pragma once

#include <string>

#include "tests/support/temp_folder.h"

namespace poesy::fuzz {

/// A file in a separate folder that no reader may read (fuzz_result.cpp). Changed results refer to it in every way that
/// HDF5 knows (mutate_result.cpp).
class OtherFile {
 public:
  OtherFile();
  OtherFile(const OtherFile&) = delete;
  OtherFile& operator=(const OtherFile&) = delete;
  ~OtherFile();
  const std::string& path() const { return path_; }
  /// Whether any process has read the file since the last call. Always false if the system cannot watch files, which
  /// the constructor reports.
  bool was_read() const;

 private:
  test::TempFolder folder_;
  std::string path_;
  int events_ = -1;
};

const OtherFile& other_file();  ///< The only OtherFile, created at the first call.

}  // namespace poesy::fuzz
