#pragma once

#include <cstdint>
#include <memory>

namespace poesy {

class FileWriter;

namespace h5 {

/// A file driver for HDF5 that writes a new file through a FileWriter, without opening a file by name. HDF5 does not
/// learn of disk errors, because it would not close a file that it failed to flush, and would try again when the
/// program ends. FileWriter keeps the error instead (put()). A Disk has one file at a time.
class Disk {
 public:
  explicit Disk(FileWriter& writer);  ///< Throws Error if HDF5 does not accept the driver.
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;
  /// Discards everything that HDF5 still writes to the file. Precondition: File::close() was called, even if it failed.
  ~Disk();

  /// Selects this driver in the access property list of a new file. Negative if HDF5 refuses.
  int choose_for(std::int64_t access) const;

 private:
  std::shared_ptr<FileWriter*> writer_;  // shared with the files that HDF5 has open
  std::int64_t driver_;
};

}  // namespace h5
}  // namespace poesy
