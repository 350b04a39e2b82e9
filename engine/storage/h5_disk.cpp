#include "engine/storage/h5_disk.h"

#include <hdf5.h>
#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>  // has the declarations for drivers since HDF5 1.13
#endif

#include <algorithm>
#include <cstddef>
#include <new>
#include <span>

#include "engine/storage/file_writer.h"
#include "engine/storage/h5.h"

namespace poesy::h5 {
namespace {

/// The data of this driver for one file that HDF5 has open.
struct OpenFile : H5FD_t {
  std::shared_ptr<FileWriter*> writer;
  haddr_t allocated = 0;  ///< HDF5's "end of allocation": final length of the file, bytes
  haddr_t end = 0;        ///< length of the file so far, bytes
};

/// The data of this driver that HDF5 stores in access properties, and passes to open_file().
struct Properties {
  const std::shared_ptr<FileWriter*>* writer;
};

OpenFile& mine(H5FD_t* file) { return *static_cast<OpenFile*>(file); }
const OpenFile& mine(const H5FD_t* file) { return *static_cast<const OpenFile*>(file); }

H5FD_t* open_file(const char*, unsigned, hid_t access, haddr_t) {
  const auto* properties = static_cast<const Properties*>(H5Pget_driver_info(access));
  if (properties == nullptr) return nullptr;
  auto* file = new (std::nothrow) OpenFile{};
  if (file != nullptr) file->writer = *properties->writer;
  return file;
}

herr_t close_file(H5FD_t* file) {
  delete &mine(file);
  return 0;
}

/// Declares the features of this driver. They are those features of HDF5's own drivers for memory and disk that
/// influence which bytes are written, so that all drivers write the same bytes.
herr_t features(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t allocated(const H5FD_t* file, H5FD_mem_t) { return mine(file).allocated; }

herr_t set_allocated(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  mine(file).allocated = end;
  return 0;
}

haddr_t end(const H5FD_t* file, H5FD_mem_t) { return mine(file).end; }

herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t bytes, void* to) {
  FileWriter* writer = *mine(file).writer;
  return writer != nullptr && writer->get(at, {static_cast<std::byte*>(to), bytes}) ? 0 : -1;
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t bytes, const void* from) {
  OpenFile& open = mine(file);
  if (FileWriter* writer = *open.writer) writer->put(at, {static_cast<const std::byte*>(from), bytes});
  open.end = std::max(open.end, at + bytes);
  return 0;
}

herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  OpenFile& open = mine(file);
  if (FileWriter* writer = *open.writer) writer->end_at(open.allocated);
  open.end = open.allocated;
  return 0;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(H5_VFD_RESERVED + 1);
#endif
  driver.name = "poesy";
  driver.maxaddr = (haddr_t{1} << 63U) - 1;  // the largest off_t
  driver.fc_degree = H5F_CLOSE_STRONG;       // closing the file closes its objects too
  driver.fapl_size = sizeof(Properties);
  driver.open = open_file;
  driver.close = close_file;
  driver.query = features;
  driver.get_eoa = allocated;
  driver.set_eoa = set_allocated;
  driver.get_eof = end;
  driver.read = read;
  driver.write = write;
  driver.truncate = truncate;
  constexpr H5FD_mem_t kPools[] = H5FD_FLMAP_DICHOTOMY;
  std::ranges::copy(kPools, driver.fl_map);
  return driver;
}

}  // namespace

Disk::Disk(FileWriter& writer) : writer_(std::make_shared<FileWriter*>(&writer)) {
  const H5FD_class_t driver = driver_class();
  driver_ = H5FDregister(&driver);
  if (driver_ < 0) throw Error("cannot make a file driver");
}

Disk::~Disk() {
  *writer_ = nullptr;
  H5FDunregister(driver_);
}

int Disk::choose_for(std::int64_t access) const {
  const Properties properties{&writer_};
  return H5Pset_driver(access, driver_, &properties);
}

}  // namespace poesy::h5
