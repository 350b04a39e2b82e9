#include "engine/storage/h5_disk.h"

#include <hdf5.h>
#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>  // where HDF5 declares drivers from 1.13 on
#endif

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <new>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include "engine/base/contract.h"
#include "engine/storage/file_writer.h"
#include "engine/storage/h5.h"

namespace poesy::h5 {
namespace {

using Writer = std::shared_ptr<FileWriter*>;
using Reader = std::shared_ptr<const PlainFile>;

/// A file that HDF5 has open; Of: what its bytes are in.
template <class Of>
struct OpenFile : H5FD_t {
  Of of;
  haddr_t allocated = 0;  ///< "end of allocation": where HDF5's file is going to end
  haddr_t end = 0;        ///< of what there is
};

/// What HDF5 hands from the properties to open_file().
template <class Of>
struct Properties {
  const Of* of;
};

template <class Of>
OpenFile<Of>& mine(H5FD_t* file) {
  return *static_cast<OpenFile<Of>*>(file);
}
template <class Of>
const OpenFile<Of>& mine(const H5FD_t* file) {
  return *static_cast<const OpenFile<Of>*>(file);
}

haddr_t end_of(const Writer&) { return 0; }
haddr_t end_of(const Reader& file) { return file->size(); }

template <class Of>
H5FD_t* open_file(const char*, unsigned, hid_t access, haddr_t) {
  const auto* properties = static_cast<const Properties<Of>*>(H5Pget_driver_info(access));
  if (properties == nullptr) return nullptr;
  auto* file = new (std::nothrow) OpenFile<Of>{};
  if (file == nullptr) return nullptr;
  file->of = *properties->of;
  file->end = end_of(file->of);
  return file;
}

template <class Of>
herr_t close_file(H5FD_t* file) {
  delete &mine<Of>(file);
  return 0;
}

/// Those of HDF5's drivers for a file in memory and for one on a disk: the same bytes from all.
herr_t features(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

template <class Of>
haddr_t allocated(const H5FD_t* file, H5FD_mem_t) {
  return mine<Of>(file).allocated;
}

template <class Of>
herr_t set_allocated(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  mine<Of>(file).allocated = end;
  return 0;
}

template <class Of>
haddr_t end(const H5FD_t* file, H5FD_mem_t) {
  return mine<Of>(file).end;
}

herr_t read_back(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t bytes, void* to) {
  FileWriter* writer = *mine<Writer>(file).of;
  return writer != nullptr && writer->get(at, {static_cast<std::byte*>(to), bytes}) ? 0 : -1;
}

/// Behind the end are zeros, as with HDF5's own driver.
herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t bytes, void* to) noexcept {
  const std::span all(static_cast<std::byte*>(to), bytes);
  const auto there = mine<Reader>(file).of->read(at, all);
  if (!there) {
    const std::string reason = std::generic_category().message(errno);
    H5Epush2(H5E_DEFAULT, __FILE__, "read", __LINE__, H5E_ERR_CLS, H5E_IO, H5E_READERROR, "%s", reason.c_str());
    return -1;
  }
  std::ranges::fill(all.subspan(*there), std::byte{0});
  return 0;
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t bytes, const void* from) {
  OpenFile<Writer>& open = mine<Writer>(file);
  if (FileWriter* writer = *open.of) writer->put(at, {static_cast<const std::byte*>(from), bytes});
  open.end = std::max(open.end, at + bytes);
  return 0;
}

/// HDF5 requires this callback of every driver.
herr_t write_nothing(H5FD_t*, H5FD_mem_t, hid_t, haddr_t, std::size_t, const void*) { return -1; }

herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  OpenFile<Writer>& open = mine<Writer>(file);
  if (FileWriter* writer = *open.of) writer->end_at(open.allocated);
  open.end = open.allocated;
  return 0;
}

/// What both drivers have in common. number: one of its own for each driver.
template <class Of>
H5FD_class_t driver_class([[maybe_unused]] int number, const char* name) {
  H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(H5_VFD_RESERVED + number);
#endif
  driver.name = name;
  driver.maxaddr = (haddr_t{1} << 63U) - 1;  // of off_t
  driver.fc_degree = H5F_CLOSE_STRONG;       // closing the file closes its objects too
  driver.fapl_size = sizeof(Properties<Of>);
  driver.open = open_file<Of>;
  driver.close = close_file<Of>;
  driver.query = features;
  driver.get_eoa = allocated<Of>;
  driver.set_eoa = set_allocated<Of>;
  driver.get_eof = end<Of>;
  constexpr H5FD_mem_t kPools[] = H5FD_FLMAP_DICHOTOMY;
  std::ranges::copy(kPools, driver.fl_map);
  return driver;
}

/// Its id.
std::int64_t registered(const H5FD_class_t& driver) {
  const hid_t id = H5FDregister(&driver);
  if (id < 0) throw Error("cannot make a file driver");
  return id;
}

}  // namespace

Disk::Disk(FileWriter& writer) : writer_(std::make_shared<FileWriter*>(&writer)) {
  H5FD_class_t driver = driver_class<Writer>(1, "poesy");
  driver.read = read_back;
  driver.write = write;
  driver.truncate = truncate;
  driver_ = registered(driver);
}

Disk::~Disk() {
  *writer_ = nullptr;
  H5FDunregister(driver_);
}

int Disk::choose_for(std::int64_t access) const {
  const Properties<Writer> properties{&writer_};
  return H5Pset_driver(access, driver_, &properties);
}

Input::Input(PlainFile file) : file_(std::make_shared<PlainFile>(std::move(file))) {
  POESY_EXPECTS(file_->is_open());
  H5FD_class_t driver = driver_class<Reader>(2, "poesy input");
  driver.read = read;
  driver.write = write_nothing;
  driver_ = registered(driver);
}

Input::~Input() { H5FDunregister(driver_); }

int Input::choose_for(std::int64_t access) const {
  const Properties<Reader> properties{&file_};
  return H5Pset_driver(access, driver_, &properties);
}

}  // namespace poesy::h5
