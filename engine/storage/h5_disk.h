#pragma once

#include <cstdint>
#include <memory>

namespace poesy {

class FileWriter;

namespace h5 {

/// A file driver for HDF5 that writes a new file through a FileWriter, without opening a file by name. Write errors of
/// the disk are not reported to HDF5, because HDF5 would not close a file that it failed to flush, and would try again
/// when the program ends. FileWriter keeps them instead (FileWriter::put). A Disk serves one file.
class Disk {
 public:
  explicit Disk(FileWriter& writer);  ///< Throws Error if HDF5 does not accept the driver.
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;
  /// From now on, everything that HDF5 still writes to the file is discarded. Precondition: File::close() was called,
  /// even if it failed.
  ~Disk();

  /// Selects this driver in the access property list of a new file. Returns a negative number if HDF5 refuses.
  int choose_for(std::int64_t access) const;

 private:
  std::shared_ptr<FileWriter*> writer_;  // shared with the file that HDF5 has open; null after ~Disk()
  std::int64_t driver_;
};

}  // namespace h5
}  // namespace poesy
