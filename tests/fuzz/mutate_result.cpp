// The mutator of result files for libFuzzer. It changes bytes, or replaces parts by something that poesy never writes:
// values or links in other files, cycles, other types, shapes, filters and places. HDF5 handles are never closed,
// because the child process that has them ends.
#include <fcntl.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "engine/base/address_space.h"
#include "tests/fuzz/other_file.h"
#include "tests/fuzz/target.h"

namespace poesy::fuzz {
namespace {

using Random = std::mt19937;
using Shape = std::vector<hsize_t>;

template <class Value, std::size_t N>
Value one_of(const Value (&values)[N], Random& random) {
  return values[random() % N];
}

struct Names {
  std::vector<std::string> groups;
  std::vector<std::string> datasets;
};

Names names_in(hid_t file) {
  Names names;
  const auto note = [](hid_t, const char* name, const auto* info, void* found) -> herr_t {
    auto& all = *static_cast<Names*>(found);
    if (info->type == H5O_TYPE_GROUP) all.groups.emplace_back(name);
    if (info->type == H5O_TYPE_DATASET) all.datasets.emplace_back(name);
    return 0;
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, note, &names, H5O_INFO_BASIC);
  return names;
}

std::vector<std::string> attributes_of(hid_t object) {
  std::vector<std::string> names;
  const auto note = [](hid_t, const char* name, const H5A_info_t*, void* found) -> herr_t {
    static_cast<std::vector<std::string>*>(found)->emplace_back(name);
    return 0;
  };
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, note, &names);
  return names;
}

Shape shape_of(hid_t file, const std::string& name) {
  const hid_t space = H5Dget_space(H5Dopen2(file, name.c_str(), H5P_DEFAULT));
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank <= 0) return {};
  Shape shape(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

hid_t space_of(const Shape& shape) {
  return shape.empty() ? H5Screate(H5S_SCALAR)
                       : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
}

hid_t strange_space(Random& random) {
  if (random() % 8 == 0) return H5Screate(H5S_NULL);
  Shape shape(random() % 4);
  for (hsize_t& extent : shape) {
    extent = one_of<hsize_t>({0, 1, 2, 3, 60, 65536, hsize_t{1} << 32U, (hsize_t{1} << 62U) + 1}, random);
  }
  return space_of(shape);
}

hid_t strange_type(Random& random) {
  switch (random() % 10) {
    case 0: {
      const hid_t text = H5Tcopy(H5T_C_S1);
      H5Tset_size(text, one_of<std::size_t>({1, 7, 70000, H5T_VARIABLE}, random));
      return text;
    }
    case 1:
      return H5Tvlen_create(H5T_NATIVE_DOUBLE);
    case 2: {
      const hid_t record = H5Tcreate(H5T_COMPOUND, 16);
      H5Tinsert(record, "value", 8, H5T_NATIVE_DOUBLE);
      return record;
    }
    case 3:
      return H5Tcreate(H5T_OPAQUE, 1 + random() % 100);
    case 4:
      return H5Tenum_create(H5T_NATIVE_INT8);
    case 5: {
      const hsize_t extents[] = {1 + random() % 5, 2};
      return H5Tarray_create2(H5T_NATIVE_DOUBLE, 2, extents);
    }
    default:
      return one_of({H5T_IEEE_F32BE, H5T_IEEE_F64BE, H5T_STD_I8LE, H5T_STD_U64LE, H5T_STD_B64LE, H5T_STD_REF_OBJ,
                     H5T_NATIVE_LDOUBLE, H5T_UNIX_D32LE},
                    random);
  }
}

/// Creation properties for the storage of a dataset: in an external file, in another dataset, in filtered chunks, or as
/// usual.
hid_t strange_storage(hid_t space, const Shape& shape, Random& random) {
  const hid_t storage = H5Pcreate(H5P_DATASET_CREATE);
  const Shape piece(shape.size(), 1 + random() % 3);
  switch (random() % 4) {
    case 0:
      H5Pset_external(storage, other_file().path().c_str(), 0, H5F_UNLIMITED);
      break;
    case 1:
      H5Pset_virtual(storage, space, random() % 2 == 0 ? other_file().path().c_str() : ".", "/run", space);
      break;
    case 2:
      if (!shape.empty()) H5Pset_chunk(storage, static_cast<int>(piece.size()), piece.data());
      H5Pset_filter(storage, static_cast<H5Z_filter_t>(random() % 8 * (random() % 2 == 0 ? 1 : 5000)),
                    H5Z_FLAG_OPTIONAL, 0, nullptr);
      break;
    default:
      break;
  }
  return storage;
}

void add_link(hid_t file, const std::string& to, const std::string& name, Random& random) {
  switch (random() % 3) {
    case 0:
      H5Lcreate_external(random() % 2 == 0 ? other_file().path().c_str() : ".", to.c_str(), file, name.c_str(),
                         H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 1:
      H5Lcreate_soft(to.c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    default:
      H5Lcreate_hard(file, to.c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }
}

void change_attribute(hid_t file, const std::string& of, Random& random) {
  const hid_t object = H5Oopen(file, of.c_str(), H5P_DEFAULT);
  const std::vector<std::string> names = attributes_of(object);
  if (names.empty()) return;
  const std::string& name = names[random() % names.size()];
  H5Adelete(object, name.c_str());
  if (random() % 4 == 0) return;
  const hid_t space = random() % 2 == 0 ? H5Screate(H5S_SCALAR) : strange_space(random);
  H5Acreate2(object, name.c_str(), strange_type(random), space, H5P_DEFAULT, H5P_DEFAULT);
}

void change(hid_t file, Random& random) {
  const Names names = names_in(file);
  if (names.groups.empty() || names.datasets.empty()) return;
  const std::string& dataset = names.datasets[random() % names.datasets.size()];
  const std::string& group = names.groups[random() % names.groups.size()];
  const std::string& part = random() % 4 == 0 ? group : dataset;
  const bool is_root = part == ".";
  if (is_root || random() % 4 == 0) return change_attribute(file, part, random);
  const Shape shape = shape_of(file, dataset);
  const hid_t type = H5Dget_type(H5Dopen2(file, dataset.c_str(), H5P_DEFAULT));
  const std::string to = random() % 2 == 0 ? group : names.datasets[random() % names.datasets.size()];
  H5Ldelete(file, part.c_str(), H5P_DEFAULT);
  switch (random() % 5) {
    case 0:
      return add_link(file, to, part, random);
    case 1:
      H5Gcreate2(file, part.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      return;
    case 2: {
      const hid_t space = space_of(shape);
      H5Dcreate2(file, part.c_str(), type, space, H5P_DEFAULT, strange_storage(space, shape, random), H5P_DEFAULT);
      return;
    }
    case 3:
      H5Dcreate2(file, part.c_str(), type, strange_space(random), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      return;
    default:
      H5Dcreate2(file, part.c_str(), strange_type(random), space_of(shape), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  }
}

void limit(int resource, rlim_t most) {
  const rlimit limits{.rlim_cur = most, .rlim_max = most};
  ::setrlimit(resource, &limits);
}

/// Changes the file and ends the process. It runs in a child process, because HDF5 may crash or hang on a damaged file.
[[noreturn]] void live_as_child(const std::string& path, std::uint32_t seed) {
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(nothing, STDERR_FILENO);
  limit(RLIMIT_FSIZE, 1 << 20);
  limit(RLIMIT_AS, address_space() + (256 << 20));
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  if (file < 0) ::_exit(1);
  Random random(seed);
  change(file, random);
  ::_exit(H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 ? 1 : 0);
}

/// The file with one part replaced. None if HDF5 cannot change the file, for example because it is damaged.
std::optional<std::vector<char>> with_strange_part(std::span<const std::uint8_t> file, std::uint32_t seed) {
  const MemoryFile changed(file);
  const pid_t child = ::fork();
  if (child == 0) live_as_child(changed.path(), seed);
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || status != 0) return std::nullopt;
  std::ifstream stream(changed.path(), std::ios::binary);
  return std::vector<char>(std::istreambuf_iterator<char>(stream), {});
}

}  // namespace
}  // namespace poesy::fuzz

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  if (seed % 2 == 0) {
    const auto changed = poesy::fuzz::with_strange_part(std::span(data, size), seed);
    if (changed && changed->size() <= most) {
      std::ranges::copy(*changed, data);
      return changed->size();
    }
  }
  return LLVMFuzzerMutate(data, size, most);
}
