#include "engine/storage/h5.h"

#include <fmt/format.h>
#include <hdf5.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <functional>
#include <map>
#include <new>
#include <numeric>
#include <system_error>
#include <type_traits>
#include <utility>

#include "engine/base/address_space.h"
#include "engine/base/contract.h"
#include "engine/base/plain_file.h"
#include "engine/storage/h5_disk.h"

namespace poesy::h5 {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>, "File stores HDF5's ids as 64-bit integers");

// The innermost entry of HDF5's error stack states the reason; the outer entries only name the callers.
herr_t take_reason(unsigned depth, const H5E_error2_t* entry, void* reason) {
  if (depth == 0 && entry->desc != nullptr) *static_cast<std::string*>(reason) = entry->desc;
  return 0;
}

[[noreturn]] void fail(const char* action, const std::string& object) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_reason, &reason);
  throw Error(std::string("cannot ") + action + " " + object + (reason.empty() ? "" : " (" + reason + ")"));
}

template <class Result>
Result checked(Result result, const char* action, const std::string& object) {
  if (result < 0) fail(action, object);
  return result;
}

/// Owns an id of an HDF5 object, and closes the object.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle(hid_t id, Close close, const char* action, const std::string& object)
      : id_(checked(id, action, object)), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ != H5I_INVALID_HID) close_(id_);
  }

  hid_t get() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

std::string attribute_name(const std::string& path, const std::string& name) {
  return "attribute '" + name + "' of " + path;
}

Handle property_list(hid_t kind) { return {H5Pcreate(kind), H5Pclose, "make a property list for", "a new object"}; }

Handle open_object(hid_t file, const std::string& path) {
  return {H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, "open", path};
}

Handle open_dataset(hid_t file, const std::string& path) {
  return {H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, "open dataset", path};
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make", "the text type");
  checked(H5Tset_size(type.get(), H5T_VARIABLE), "size", "the text type");
  checked(H5Tset_cset(type.get(), H5T_CSET_UTF8), "set the encoding of", "the text type");
  return type;
}

template <class T>
Handle element_type() {
  if constexpr (std::is_same_v<T, std::string>) return text_type();
  hid_t type = H5T_IEEE_F64LE;
  if constexpr (std::is_same_v<T, std::int64_t>) type = H5T_STD_I64LE;
  if constexpr (std::is_same_v<T, std::uint64_t>) type = H5T_STD_U64LE;
  if constexpr (std::is_same_v<T, std::uint32_t>) type = H5T_STD_U32LE;
  if constexpr (std::is_same_v<T, std::uint8_t>) type = H5T_STD_U8LE;
  return {H5Tcopy(type), H5Tclose, "make", "a number type"};
}

Handle space_of(const Shape& shape) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose, "make", "a scalar space"};
  const std::vector<hsize_t> lengths(shape.begin(), shape.end());
  return {H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr), H5Sclose, "make", "a space"};
}

// The largest number of elements of a dataset or an attribute: 2^31, or 16 GiB of doubles.
constexpr hsize_t kMostElements = hsize_t{1} << 31U;
constexpr std::size_t kWidestNumber = 16;

Shape shape_of(hid_t space, const std::string& object) {
  const int rank = checked(H5Sget_simple_extent_ndims(space), "read the shape of", object);
  std::vector<hsize_t> lengths(static_cast<std::size_t>(rank));
  checked(H5Sget_simple_extent_dims(space, lengths.data(), nullptr), "read the shape of", object);
  hsize_t count = 1;
  for (const hsize_t length : lengths) {
    if (length > 0 && count > kMostElements / length) throw Error(object + " has more elements than any result");
    count *= length;
  }
  return {lengths.begin(), lengths.end()};
}

/// The size of the slices in which a dataset is written or read, in bytes. It is large enough for fast disk access, and
/// small compared with the memory for a whole result.
constexpr std::size_t kSlice = std::size_t{1} << 22U;

/// A rectangular range of a dataset, called a hyperslab in HDF5.
struct Box {
  std::vector<hsize_t> start;
  std::vector<hsize_t> count;

  hsize_t size() const { return std::accumulate(count.begin(), count.end(), hsize_t{1}, std::multiplies()); }
};

/// Divides a dataset into boxes of at most `most` elements, in row-major order, and calls use(box) for each.
/// Precondition: most > 0, and the dataset has more than `most` elements.
template <class Use>
void for_each_box(const Shape& shape, std::size_t most, const Use& use) {
  // A box has a range of indices on the axis `cut`, one index on each axis before it, and all indices on each axis
  // after it.
  std::size_t cut = shape.size() - 1;
  std::size_t inner = 1;
  while (inner * shape[cut] <= most) inner *= shape[cut--];
  Box box{std::vector<hsize_t>(shape.size(), 0), {shape.begin(), shape.end()}};
  std::fill_n(box.count.begin(), cut, 1);
  for (;;) {
    box.count[cut] = std::min<hsize_t>(most / inner, shape[cut] - box.start[cut]);
    use(std::as_const(box));
    box.start[cut] += box.count[cut];
    for (std::size_t carry = cut; box.start[carry] == shape[carry]; ++box.start[carry]) {
      if (carry == 0) return;
      box.start[carry--] = 0;
    }
  }
}

void select(hid_t space, const Box& box, const std::string& name) {
  checked(H5Sselect_hyperslab(space, H5S_SELECT_SET, box.start.data(), nullptr, box.count.data(), nullptr),
          "take a part of", name);
}

/// The values in the form that HDF5 needs for writing: numbers as they are, texts as a list of pointers.
template <class T>
auto elements(std::span<const T> values) {
  if constexpr (std::is_same_v<T, std::string>) {
    std::vector<const char*> pointers;
    for (const std::string& text : values) pointers.push_back(text.c_str());
    return pointers;
  } else {
    return values;
  }
}

/// An open dataset or attribute.
struct Source {
  std::string name;
  bool is_attribute;
  Handle object;
  Handle type{is_attribute ? H5Aget_type(object.get()) : H5Dget_type(object.get()), H5Tclose, "read the type of", name};
  Handle space{is_attribute ? H5Aget_space(object.get()) : H5Dget_space(object.get()), H5Sclose, "read the shape of",
               name};

  Shape shape() const { return shape_of(space.get(), name); }
  void read(hid_t memory_type, void* to) const {
    checked(is_attribute ? H5Aread(object.get(), memory_type, to)
                         : H5Dread(object.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to),
            "read", name);
  }
  /// Reads a part of a dataset.
  void read(const Box& box, hid_t memory_type, void* to) const {
    select(space.get(), box, name);
    const Handle memory = space_of({box.size()});
    checked(H5Dread(object.get(), memory_type, memory.get(), space.get(), H5P_DEFAULT, to), "read", name);
  }
};

/// Returns true if the dataset is stored as one contiguous piece of this number of bytes.
bool is_in_one_piece(const Source& dataset, std::size_t bytes) {
  const Handle storage(H5Dget_create_plist(dataset.object.get()), H5Pclose, "read the storage of", dataset.name);
  return H5Pget_layout(storage.get()) == H5D_CONTIGUOUS && H5Dget_storage_size(dataset.object.get()) == bytes;
}

Source dataset_at(hid_t file, const std::string& path) {
  return {.name = path, .is_attribute = false, .object = open_dataset(file, path)};
}

Source attribute_at(hid_t file, const std::string& path, const std::string& name) {
  const std::string object = attribute_name(path, name);
  return {.name = object,
          .is_attribute = true,
          .object = {H5Aopen_by_name(file, path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "open",
                     object}};
}

/// Pointers to texts that HDF5 allocated when it read them. The destructor frees these texts.
struct TextBuffer {
  std::vector<char*> pointers;
  hid_t type;
  hid_t space;

  ~TextBuffer() { H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data()); }
};

std::vector<std::string> read_texts(const Source& source) {
  if (H5Tis_variable_str(source.type.get()) <= 0) throw Error(source.name + " is not text of variable length");
  const Handle type = text_type();
  // Texts are read in the encoding that the file states, because HDF5 does not convert between encodings.
  checked(H5Tset_cset(type.get(), H5Tget_cset(source.type.get())), "set the encoding of", source.name);
  TextBuffer buffer{std::vector<char*>(size(source.shape()), nullptr), type.get(), source.space.get()};
  source.read(type.get(), buffer.pointers.data());
  std::vector<std::string> list;
  for (const char* text : buffer.pointers) list.emplace_back(text == nullptr ? "" : text);
  return list;
}

template <class T>
std::vector<T> read_all(const Source& source) {
  if constexpr (std::is_same_v<T, std::string>) {
    return read_texts(source);
  } else {
    const Handle type = element_type<T>();
    std::vector<T> values(size(source.shape()));
    source.read(type.get(), values.data());
    return values;
  }
}

Value head_of(const Source& source) {
  Value value;
  value.shape = source.shape();
  const H5T_class_t kind = H5Tget_class(source.type.get());
  if (kind == H5T_STRING) return value;
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) throw Error(source.name + " is neither numbers nor text");
  value.type = kind == H5T_FLOAT                                ? Value::Type::floating
               : H5Tget_sign(source.type.get()) == H5T_SGN_NONE ? Value::Type::unsigned_integer
                                                                : Value::Type::signed_integer;
  value.width = H5Tget_size(source.type.get());
  if (value.width > kWidestNumber) {
    throw Error(source.name + " has numbers of " + std::to_string(value.width) + " bytes");
  }
  return value;
}

/// The number type of the dataset or attribute, but little-endian.
Handle plain_type(const Source& source) {
  Handle type(H5Tcopy(source.type.get()), H5Tclose, "copy the type of", source.name);
  checked(H5Tset_order(type.get(), H5T_ORDER_LE), "set the byte order of", source.name);
  return type;
}

Value read_value(const Source& source) {
  Value value = head_of(source);
  if (value.type == Value::Type::text) {
    value.strings = read_texts(source);
    return value;
  }
  value.numbers.resize(size(value.shape) * value.width);
  source.read(plain_type(source).get(), value.numbers.data());
  return value;
}

template <class T>
void create_attribute(hid_t file, const std::string& path, const std::string& name, const Shape& shape,
                      std::span<const T> values) {
  const std::string object = attribute_name(path, name);
  const Handle type = element_type<T>();
  const Handle space = space_of(shape);
  const Handle owner = open_object(file, path);
  const Handle attribute(H5Acreate2(owner.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, "make", object);
  checked(H5Awrite(attribute.get(), type.get(), elements(values).data()), "write", object);
}

/// Adds a name to the list `names`. HDF5 calls this function for each link of a group or each attribute of an object.
template <class Info>
herr_t add_name(hid_t, const char* name, const Info*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

struct Link {
  std::string name;
  H5L_type_t type;
};

herr_t add_link(hid_t, const char* name, const H5L_info_t* info, void* links) {
  static_cast<std::vector<Link>*>(links)->push_back({name, info->type});
  return 0;
}

std::vector<Link> links_in(hid_t file, const std::string& path) {
  const Handle group = open_object(file, path);
  std::vector<Link> links;
  checked(H5Literate(group.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add_link, &links), "list", path);
  return links;
}

void expect_hard(const Link& link, const std::string& path) {
  if (link.type == H5L_TYPE_SOFT) throw StrangeFile(path + " is a soft link");
  if (link.type == H5L_TYPE_EXTERNAL) throw StrangeFile(path + " is a link to another file");
  if (link.type != H5L_TYPE_HARD) throw StrangeFile(path + " is a link of another program's own kind");
  // HDF5 would split a name with slashes, and follow links that have not been checked.
  if (link.name.find('/') != std::string::npos || link.name == ".") throw StrangeFile(path + " has no name of its own");
}

void expect_own_storage(hid_t dataset, const std::string& path) {
  const Handle storage(H5Dget_create_plist(dataset), H5Pclose, "read the storage of", path);
  if (checked(H5Pget_layout(storage.get()), "read the layout of", path) == H5D_VIRTUAL) {
    throw StrangeFile(path + " is a virtual dataset, whose values are elsewhere");
  }
  if (checked(H5Pget_external_count(storage.get()), "read the storage of", path) > 0) {
    throw StrangeFile(path + " has its values in other files (external storage)");
  }
  const int filters = checked(H5Pget_nfilters(storage.get()), "read the filters of", path);
  for (int k = 0; k < filters; ++k) {
    std::size_t no_values = 0;
    const H5Z_filter_t filter = checked(
        H5Pget_filter2(storage.get(), static_cast<unsigned>(k), nullptr, &no_values, nullptr, 0, nullptr, nullptr),
        "read the filters of", path);
    // HDF5 would search this computer for a plugin with this filter, and execute it.
    if (filter > H5Z_FILTER_SCALEOFFSET) throw StrangeFile(fmt::format("{} needs the filter {}", path, filter));
  }
}

/// The address of an object in the file. get: H5Oget_info2, from which the type `Info` is deduced; the name of this
/// type changed in HDF5 1.12.
template <class Info>
haddr_t address_of(hid_t object, const std::string& path, herr_t (*get)(hid_t, Info*, unsigned)) {
  Info info{};
  checked(get(object, &info, H5O_INFO_BASIC), "look at", path);
  return info.addr;
}

// netCDF readers need the order in which objects were created.
constexpr unsigned kCreationOrder = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
// Links and attributes stay in the object's header, which has a checksum, instead of moving to a heap when there are
// many: HDF5 1.10 frees memory that it never allocated when it reads a damaged heap.
constexpr unsigned kMostInHeader = 1000;

/// The properties of a new object. Times are not stored, so that the same content gives the same bytes.
Handle object_properties(hid_t kind) {
  Handle properties = property_list(kind);
  checked(H5Pset_obj_track_times(properties.get(), false), "drop the times of", "a new object");
  checked(H5Pset_attr_creation_order(properties.get(), kCreationOrder), "order the attributes of", "a new object");
  checked(H5Pset_attr_phase_change(properties.get(), kMostInHeader, 0), "place the attributes of", "a new object");
  return properties;
}

Handle group_properties(hid_t kind) {
  Handle properties = object_properties(kind);
  checked(H5Pset_link_creation_order(properties.get(), kCreationOrder), "order the links of", "a group");
  checked(H5Pset_link_phase_change(properties.get(), kMostInHeader, 0), "place the links of", "a group");
  return properties;
}

/// Throws std::bad_alloc if less than kRoom of address space is left, because HDF5 1.10 may crash when it creates a
/// file without enough memory. HDF5 needs half of kRoom.
void expect_room_for_file() {
  constexpr std::size_t kRoom = std::size_t{8} << 20U;
  if (!has_address_space(kRoom)) throw std::bad_alloc();
}

hid_t make_file(hid_t access) {
  expect_room_for_file();
  const Handle creation = group_properties(H5P_FILE_CREATE);
  const hid_t id = checked(H5Fcreate("new", H5F_ACC_TRUNC, creation.get(), access), "make", "a file");
  // From version 1.8 of the format on, metadata has checksums. The version is set after the file is created, so that
  // the superblock is of the older kind, as in all files of poesy.
  checked(H5Fset_libver_bounds(id, H5F_LIBVER_V18, H5F_LIBVER_V18), "choose the version of", "the file");
  return id;
}

Handle make_dataset(hid_t file, const std::string& path, const Shape& shape, const Handle& type,
                    const Handle& creation) {
  const Handle space = space_of(shape);
  return {H5Dcreate2(file, path.c_str(), type.get(), space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Dclose,
          "make dataset", path};
}

}  // namespace

std::size_t size(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies());
}

File::File(std::int64_t id) : id_(id) {}

File File::in_memory() {
  silence();
  constexpr std::size_t kGrowth = 1 << 20;
  const Handle access = property_list(H5P_FILE_ACCESS);
  checked(H5Pset_fapl_core(access.get(), kGrowth, 0), "prepare", "a file in memory");
  return File(make_file(access.get()));
}

File File::on_disk(FileWriter& disk) {
  silence();
  auto driver = std::make_unique<Disk>(disk);
  const Handle access = property_list(H5P_FILE_ACCESS);
  checked(driver->choose_for(access.get()), "prepare", "a file on a disk");
  File file(make_file(access.get()));
  file.disk_ = std::move(driver);
  return file;
}

File File::open(const std::string& path) {
  silence();
  if (const PlainFile plain(path); !plain.is_open()) {
    const std::string reason = std::generic_category().message(plain.error());
    throw Error("cannot open " + path + " (" + (plain.other().empty() ? reason : "is " + std::string(plain.other())) +
                ")");
  }
  const Handle access = property_list(H5P_FILE_ACCESS);
  // No lock is needed, because result files are replaced and never changed in place; and some file systems have no
  // locks.
  checked(H5Pset_file_locking(access.get(), false, true), "prepare", path);
  checked(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG), "prepare", path);
  return File(checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), "open", path));
}

File::File(File&& other) noexcept : disk_(std::move(other.disk_)), id_(std::exchange(other.id_, H5I_INVALID_HID)) {}

File::~File() {
  if (id_ != H5I_INVALID_HID) H5Fclose(id_);
}

void File::close() {
  checked(H5Fclose(std::exchange(id_, H5I_INVALID_HID)), "close", "the file");
  disk_.reset();
}

void File::make_group(const std::string& path) {
  const Handle creation = group_properties(H5P_GROUP_CREATE);
  const Handle group(H5Gcreate2(id_, path.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Gclose, "make group",
                     path);
}

template <Element T>
void File::write(const std::string& path, const Shape& shape, std::span<const T> values) {
  POESY_EXPECTS(values.size() == size(shape));
  const Handle creation = object_properties(H5P_DATASET_CREATE);
  // HDF5 stores texts in a heap, and in the dataset only references to them. In a compact dataset these references are
  // in the object's header, which has a checksum. The header has room for this number of references.
  constexpr std::size_t kHeaderRoom = 2000;
  if (std::is_same_v<T, std::string> && values.size() <= kHeaderRoom) {
    checked(H5Pset_layout(creation.get(), H5D_COMPACT), "choose the layout of", path);
  }
  const Handle type = element_type<T>();
  const Handle dataset = make_dataset(id_, path, shape, type, creation);
  checked(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, elements(values).data()), "write", path);
}

template <Number T>
void File::write_slices(const std::string& path, const Shape& shape,
                        const std::function<void(std::size_t, std::span<T>)>& fill) {
  constexpr std::size_t kMost = kSlice / sizeof(T);
  std::vector<T> slice(std::min(size(shape), kMost));
  if (size(shape) <= kMost) {
    fill(0, slice);
    write<T>(path, shape, slice);
    return;
  }
  const Handle type = element_type<T>();
  const Handle dataset = make_dataset(id_, path, shape, type, object_properties(H5P_DATASET_CREATE));
  const Handle space = space_of(shape);
  std::size_t first = 0;
  for_each_box(shape, kMost, [&](const Box& box) {
    fill(first, std::span(slice).first(box.size()));
    first += box.size();
    select(space.get(), box, path);
    const Handle memory = space_of({box.size()});
    checked(H5Dwrite(dataset.get(), type.get(), memory.get(), space.get(), H5P_DEFAULT, slice.data()), "write", path);
  });
}

template <Element T>
void File::set_attribute(const std::string& path, const std::string& name, const T& value) {
  create_attribute<T>(id_, path, name, {}, std::span(&value, 1));
}

template <Element T>
void File::set_attribute(const std::string& path, const std::string& name, std::span<const T> values) {
  create_attribute<T>(id_, path, name, {values.size()}, values);
}

void File::make_scale(const std::string& path) {
  const Handle dataset = open_dataset(id_, path);
  const std::string name = path.substr(path.rfind('/') + 1);
  checked(H5DSset_scale(dataset.get(), name.c_str()), "make a dimension scale of", path);
}

void File::attach_scale(const std::string& dataset, std::size_t axis, const std::string& scale) {
  const Handle labelled = open_dataset(id_, dataset);
  const Handle labels = open_dataset(id_, scale);
  checked(H5DSattach_scale(labelled.get(), labels.get(), static_cast<unsigned>(axis)), "attach a dimension scale to",
          dataset);
}

void File::link(const std::string& existing, const std::string& second) {
  checked(H5Lcreate_hard(id_, existing.c_str(), id_, second.c_str(), H5P_DEFAULT, H5P_DEFAULT), "link", second);
}

void File::expect_plain_tree() const {
  constexpr int kDeepest = 16;    // largest depth of groups; results have three levels
  constexpr int kMostNames = 16;  // names (links) of one dataset, which is read once for each; results have seven
  struct Group {
    std::string path;
    int depth;
  };
  std::map<haddr_t, int> seen{{address_of(open_object(id_, "/").get(), "/", H5Oget_info2), 1}};
  for (std::vector<Group> groups{{"/", 0}}; !groups.empty();) {
    const Group group = std::move(groups.back());
    groups.pop_back();
    for (const Link& link : links_in(id_, group.path)) {
      const std::string path = (group.depth == 0 ? "" : group.path) + "/" + link.name;
      expect_hard(link, path);
      const Handle object = open_object(id_, path);
      const H5I_type_t type = H5Iget_type(object.get());
      const int names = ++seen[address_of(object.get(), path, H5Oget_info2)];
      if (type == H5I_DATASET) {
        if (names > kMostNames) throw StrangeFile(path + " has too many names");
        expect_own_storage(object.get(), path);
        continue;
      }
      if (type != H5I_GROUP) throw StrangeFile(path + " is neither a group nor a dataset");
      if (names > 1) throw StrangeFile(path + " is a group that has two names, or is in itself");
      if (group.depth == kDeepest) throw StrangeFile(path + " is too deep");
      groups.push_back({path, group.depth + 1});
    }
  }
}

bool File::exists(const std::string& path) const {
  // HDF5 checks only the last name of a path, so each name is checked here, from the root on.
  for (std::size_t slash = path.find('/', 1);; slash = path.find('/', slash + 1)) {
    const std::string part = path.substr(0, slash);
    if (checked(H5Lexists(id_, part.c_str(), H5P_DEFAULT), "look for", part) == 0) return false;
    if (slash == std::string::npos) return true;
  }
}

bool File::is_group(const std::string& path) const { return H5Iget_type(open_object(id_, path).get()) == H5I_GROUP; }

std::vector<std::string> File::children(const std::string& path) const {
  const Handle group = open_object(id_, path);
  std::vector<std::string> names;
  checked(H5Literate(group.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name<H5L_info_t>, &names), "list", path);
  std::ranges::sort(names);
  return names;
}

std::vector<std::string> File::attributes(const std::string& path) const {
  const Handle object = open_object(id_, path);
  std::vector<std::string> names;
  checked(H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name<H5A_info_t>, &names),
          "list the attributes of", path);
  std::ranges::sort(names);
  return names;
}

bool File::has_attribute(const std::string& path, const std::string& name) const {
  return checked(H5Aexists_by_name(id_, path.c_str(), name.c_str(), H5P_DEFAULT), "look for",
                 attribute_name(path, name)) > 0;
}

Shape File::shape(const std::string& path) const { return dataset_at(id_, path).shape(); }

template <Element T>
std::vector<T> File::read(const std::string& path) const {
  return read_all<T>(dataset_at(id_, path));
}

template <Element T>
std::vector<T> File::attribute(const std::string& path, const std::string& name) const {
  return read_all<T>(attribute_at(id_, path, name));
}

Value File::value(const std::string& path) const { return read_value(dataset_at(id_, path)); }

Value File::head(const std::string& path) const { return head_of(dataset_at(id_, path)); }

void File::read_slices(const std::string& path, const std::function<void(std::span<std::byte>)>& take) const {
  const Source source = dataset_at(id_, path);
  const Value head = head_of(source);
  POESY_EXPECTS(head.type != Value::Type::text);
  const std::size_t bytes = size(head.shape) * head.width;
  if (bytes <= kSlice || !is_in_one_piece(source, bytes)) {
    Value whole = read_value(source);
    take(whole.numbers);
    return;
  }
  const Handle type = plain_type(source);
  std::vector<std::byte> slice(kSlice);
  for_each_box(head.shape, kSlice / head.width, [&](const Box& box) {
    source.read(box, type.get(), slice.data());
    take(std::span(slice).first(box.size() * head.width));
  });
}

Value File::attribute_value(const std::string& path, const std::string& name) const {
  return read_value(attribute_at(id_, path, name));
}

#define POESY_H5_ELEMENT(T)                                                                         \
  template void File::write<T>(const std::string&, const Shape&, std::span<const T>);               \
  template void File::set_attribute<T>(const std::string&, const std::string&, const T&);           \
  template void File::set_attribute<T>(const std::string&, const std::string&, std::span<const T>); \
  template std::vector<T> File::read<T>(const std::string&) const;                                  \
  template std::vector<T> File::attribute<T>(const std::string&, const std::string&) const;
POESY_H5_ELEMENT(double)
POESY_H5_ELEMENT(std::int64_t)
POESY_H5_ELEMENT(std::uint64_t)
POESY_H5_ELEMENT(std::uint32_t)
POESY_H5_ELEMENT(std::uint8_t)
POESY_H5_ELEMENT(std::string)
#undef POESY_H5_ELEMENT
#define POESY_H5_NUMBER(T)                                              \
  template void File::write_slices<T>(const std::string&, const Shape&, \
                                      const std::function<void(std::size_t, std::span<T>)>&);
POESY_H5_NUMBER(double)
POESY_H5_NUMBER(std::int64_t)
POESY_H5_NUMBER(std::uint64_t)
POESY_H5_NUMBER(std::uint32_t)
POESY_H5_NUMBER(std::uint8_t)
#undef POESY_H5_NUMBER

void close_library() { checked(H5close(), "close", "HDF5"); }

std::string library_version() {
  unsigned major = 0;
  unsigned minor = 0;
  unsigned release = 0;
  checked(H5get_libversion(&major, &minor, &release), "ask for the version of", "HDF5");
  return fmt::format("{}.{}.{}", major, minor, release);
}

}  // namespace poesy::h5
