#pragma once

#include <string>

#include "tests/support/temp_folder.h"

namespace poesy::fuzz {

/// A file of this process in a folder of its own, which changed results name in every way that HDF5 knows
/// (mutate_result.cpp), and that no reader may read (fuzz_result.cpp).
class OtherFile {
 public:
  OtherFile();
  OtherFile(const OtherFile&) = delete;
  OtherFile& operator=(const OtherFile&) = delete;
  ~OtherFile();
  const std::string& path() const { return path_; }
  /// Whether it was read since this was asked last, by this process or another. No where the system watches no files,
  /// which is said once.
  bool was_read() const;

 private:
  test::TempFolder folder_;
  std::string path_;
  int events_ = -1;
};

const OtherFile& other_file();  ///< The only one, made when first asked for.

}  // namespace poesy::fuzz
