#pragma once

#include <cstdint>
#include <memory>

namespace poesy {

class FileWriter;

namespace h5 {

/// A file driver for HDF5 that keeps a new file in what a FileWriter writes: no file is opened by its name, and HDF5
/// never meets an error of the disk. It could not get rid of a file then: what it cannot flush it does not close, and
/// it tries again when the program ends. FileWriter keeps the error (put()). One file at a time.
class Disk {
 public:
  explicit Disk(FileWriter& writer);  ///< Throws Error when HDF5 does not take the driver.
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;
  /// What HDF5 still writes goes nowhere from now on. Precondition: the file was closed, as far as HDF5 closes it.
  ~Disk();

  /// Lets files that are made with this access property list be here. Negative when HDF5 refuses.
  int choose_for(std::int64_t access) const;

 private:
  std::shared_ptr<FileWriter*> writer_;  // shared with the files that HDF5 has open
  std::int64_t driver_;
};

}  // namespace h5
}  // namespace poesy
