#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace poesy {
class FileWriter;
}

/// The functions of HDF5 that result files need. Every call is checked, and every id is closed. Objects are named by
/// their absolute path. Only this header, h5.cpp and h5_disk.cpp use HDF5. Opening a File turns off HDF5's own error
/// messages.
namespace poesy::h5 {

class Disk;

/// The exception for a failed call of HDF5. what() is a clause with the operation, the object, and HDF5's reason.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The exception for a file with a structure that poesy never writes: references to bytes outside the file, or links
/// that do not form a tree. what() is a clause that names the object. This name comes from the file, so it may contain
/// anything, such as control characters.
class StrangeFile : public Error {
 public:
  using Error::Error;
};

template <class T>
concept Element = std::same_as<T, double> || std::same_as<T, std::int64_t> || std::same_as<T, std::uint64_t> ||
    std::same_as<T, std::uint32_t> || std::same_as<T, std::uint8_t> || std::same_as<T, std::string>;

/// The types of numbers that a dataset may have.
template <class T>
concept Number = Element<T> && !std::same_as<T, std::string>;

/// The length of each axis; empty for a scalar.
using Shape = std::vector<std::size_t>;

std::size_t size(const Shape& shape);  ///< The number of elements.

/// The value of a dataset or attribute of any type, as it is stored.
struct Value {
  /// The type of the elements. content_hash.cpp has a list of names in this order.
  enum class Type { floating, signed_integer, unsigned_integer, text };

  Type type = Type::text;            ///< type of the elements; they are in `strings` for text, otherwise in `numbers`
  std::size_t width = 0;             ///< bytes of each number; 0 for text
  Shape shape;                       ///< length of each axis; elements are row-major
  std::vector<std::byte> numbers;    ///< [size(shape) * width] bytes of the numbers, little-endian
  std::vector<std::string> strings;  ///< [size(shape)] the texts
};

/// An HDF5 file. Numbers are stored little-endian in the width of T, and strings with variable length in UTF-8. The
/// order in which objects were created is stored, but not the time. Every member throws Error if a call of HDF5 fails.
class File {
 public:
  static File in_memory();  ///< An empty file in memory.
  /// An empty file that `disk` writes. `disk` must outlive the file, and the caller must call its commit() after
  /// close(). FileWriter keeps errors of the disk for FileWriter::check(). HDF5 itself sees an error only if it reads
  /// back from the disk.
  static File on_disk(FileWriter& disk);
  /// An existing plain file, read-only. Throws Error at once for a folder, a FIFO, a device or a socket.
  static File open(const std::string& path);

  File(File&& other) noexcept;  ///< Afterwards `other` may only be destroyed.
  File& operator=(File&&) = delete;
  ~File();

  void close();  ///< Writes all remaining data. Afterwards the object may only be destroyed.

  void make_group(const std::string& path);  ///< Creates a group. Its parent groups must exist.
  /// Creates a dataset. Precondition: values.size() == size(shape).
  template <Element T>
  void write(const std::string& path, const Shape& shape, std::span<const T> values);
  /// Creates a dataset in slices, so that its numbers need not be in memory all at once. fill(first, to) sets `to` to
  /// the elements from the row-major index `first` on. It is called for one slice after the other.
  template <Number T>
  void write_slices(const std::string& path, const Shape& shape,
                    const std::function<void(std::size_t first, std::span<T> to)>& fill);
  /// Creates a scalar attribute of the object at `path`.
  template <Element T>
  void set_attribute(const std::string& path, const std::string& name, const T& value);
  /// Creates an attribute of the object at `path` with a list of values.
  template <Element T>
  void set_attribute(const std::string& path, const std::string& name, std::span<const T> values);
  void make_scale(const std::string& path);  ///< Turns a one-dimensional dataset into a dimension scale.
  /// Attaches a dimension scale to one axis (from 0) of a dataset.
  void attach_scale(const std::string& dataset, std::size_t axis, const std::string& scale);
  void link(const std::string& existing, const std::string& second);  ///< Gives an object a second name (hard link).

  /// Throws StrangeFile unless everything that can be reached from the root is in this file. The links must be hard
  /// links. Values must not be in other files or be views of other datasets, and must need only HDF5's own filters.
  /// Groups must form a tree of limited depth, so that a program that follows links comes to an end. The function reads
  /// no values. Call this function before anything except attributes of the root is read from a file of an unknown
  /// source.
  void expect_plain_tree() const;

  bool exists(const std::string& path) const;    ///< Returns true if there is an object at this path.
  bool is_group(const std::string& path) const;  ///< Returns true if the object at this path is a group.
  /// Names of the links in a group, sorted by bytes.
  std::vector<std::string> children(const std::string& path) const;
  /// Names of the attributes of an object, sorted by bytes.
  std::vector<std::string> attributes(const std::string& path) const;
  /// Returns true if the object has this attribute.
  bool has_attribute(const std::string& path, const std::string& name) const;

  Shape shape(const std::string& path) const;  ///< The shape of a dataset; empty for a scalar.
  /// All elements of a dataset, row-major; numbers are converted to T.
  template <Element T>
  std::vector<T> read(const std::string& path) const;
  /// All elements of an attribute, row-major; numbers are converted to T.
  template <Element T>
  std::vector<T> attribute(const std::string& path, const std::string& name) const;
  Value value(const std::string& path) const;  ///< A dataset as it is stored.
  Value head(const std::string& path) const;   ///< Like value(), but without the elements.
  /// Passes the bytes of a dataset's numbers (Value::numbers) to take(), slice by slice. A slice has at most 4 MiB if
  /// the dataset is contiguous in the file; otherwise the whole dataset is one slice. Precondition: the dataset has
  /// numbers.
  void read_slices(const std::string& path, const std::function<void(std::span<std::byte>)>& take) const;
  Value attribute_value(const std::string& path, const std::string& name) const;  ///< An attribute as it is stored.

 private:
  explicit File(std::int64_t id);

  std::unique_ptr<Disk> disk_;  // null for a file in memory or an existing file
  std::int64_t id_;
};

/// Lets HDF5 free its memory, as at the end of the program. Precondition: there is no File.
void close_library();

std::string library_version();  ///< The version of the HDF5 library in use, such as "1.10.8".

}  // namespace poesy::h5
