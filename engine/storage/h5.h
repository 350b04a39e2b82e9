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

/// The part of HDF5 that result files use: objects are named by their absolute path, every call is checked, every id is
/// closed. HDF5 is behind this header, h5.cpp and h5_disk.cpp; opening a File turns off HDF5's own printing of errors.
namespace poesy::h5 {

class Disk;

/// A call into HDF5 failed. what() is a clause: what was tried on which object, and HDF5's own reason.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file holds what no file of poesy does: more than its own bytes to be read, or a shape that is not a tree. what()
/// is a clause that names the object, which a stranger may have named.
class StrangeFile : public Error {
 public:
  using Error::Error;
};

template <class T>
concept Element = std::same_as<T, double> || std::same_as<T, std::int64_t> || std::same_as<T, std::uint64_t> ||
    std::same_as<T, std::uint32_t> || std::same_as<T, std::uint8_t> || std::same_as<T, std::string>;

/// Numbers only.
template <class T>
concept Number = Element<T> && !std::same_as<T, std::string>;

/// Length of each axis; empty for a scalar.
using Shape = std::vector<std::size_t>;

std::size_t size(const Shape& shape);  ///< Number of elements.

/// The value of a dataset or attribute as it is stored, whatever its type.
struct Value {
  /// Kinds of numbers, and text; content_hash.cpp names them in this order.
  enum class Type { floating, signed_integer, unsigned_integer, text };

  Type type = Type::text;            ///< decides which of the members below hold the elements
  std::size_t width = 0;             ///< bytes per number; 0 for text
  Shape shape;                       ///< row-major
  std::vector<std::byte> numbers;    ///< [size(shape) * width], little-endian
  std::vector<std::string> strings;  ///< [size(shape)], for text
};

/// An HDF5 file. Numbers are stored little-endian in the width of T, strings with variable length in UTF-8, objects
/// without times and with their order of creation. Every member throws Error when HDF5 refuses.
class File {
 public:
  static File in_memory();  ///< An empty file that lives in memory only.
  /// An empty file in what `disk` writes, which must live as long and be committed after close(). An error of the disk
  /// is kept there (FileWriter::check) and is none of HDF5's, unless it is to read back what was not written.
  static File on_disk(FileWriter& disk);
  /// An existing plain file, read-only. Throws Error at once for a folder, a FIFO, a device or a socket.
  static File open(const std::string& path);

  File(File&& other) noexcept;  ///< Leaves a file that may only be destroyed.
  File& operator=(File&&) = delete;
  ~File();

  void close();  ///< Brings what HDF5 still has of it to the disk. The file may only be destroyed afterwards.

  void make_group(const std::string& path);  ///< Those above it must exist.
  /// Creates a dataset. Precondition: values.size() == size(shape).
  template <Element T>
  void write(const std::string& path, const Shape& shape, std::span<const T> values);
  /// The same in slices, so that the numbers need not be in memory as the file has them. fill(first, to): sets `to` to
  /// the elements from position `first` on, row-major; called in their order.
  template <Number T>
  void write_slices(const std::string& path, const Shape& shape,
                    const std::function<void(std::size_t first, std::span<T> to)>& fill);
  /// Creates an attribute of the object at path: a scalar.
  template <Element T>
  void set_attribute(const std::string& path, const std::string& name, const T& value);
  /// A list.
  template <Element T>
  void set_attribute(const std::string& path, const std::string& name, std::span<const T> values);
  void make_scale(const std::string& path);  ///< Makes a one-dimensional dataset a dimension scale of its name.
  /// Lets a scale name the positions along one axis of a dataset.
  void attach_scale(const std::string& dataset, std::size_t axis, const std::string& scale);
  void link(const std::string& existing, const std::string& second);  ///< Gives an object a second name (hard link).

  /// Throws StrangeFile unless all that can be reached from the root is in this file: links are hard links, values are
  /// neither in other files nor views of other datasets, and only HDF5's own filters unpack them; and unless groups
  /// form a tree that is not deep, so that whoever follows links comes to an end. Looks at no value. To be called
  /// before anything but the root's attributes is read of a file that a stranger may have made.
  void expect_plain_tree() const;

  bool exists(const std::string& path) const;    ///< Whether there is an object.
  bool is_group(const std::string& path) const;  ///< Whether this object is a group.
  /// Names of the links in a group, in the order of their bytes.
  std::vector<std::string> children(const std::string& path) const;
  /// Names of the attributes of an object, in the order of their bytes.
  std::vector<std::string> attributes(const std::string& path) const;
  bool has_attribute(const std::string& path, const std::string& name) const;  ///< Whether the object at path has it.

  Shape shape(const std::string& path) const;  ///< Of a dataset; empty for a scalar.
  /// All elements of a dataset, row-major; numbers are converted to T.
  template <Element T>
  std::vector<T> read(const std::string& path) const;
  /// All elements of an attribute.
  template <Element T>
  std::vector<T> attribute(const std::string& path, const std::string& name) const;
  Value value(const std::string& path) const;  ///< A dataset as it is stored.
  Value head(const std::string& path) const;   ///< The same without its elements.
  /// Hands the `numbers` of value() out one slice after the other. They are small where
  /// the dataset is contiguous in the file; any other comes in one slice. Precondition: a dataset of numbers.
  void read_slices(const std::string& path, const std::function<void(std::span<std::byte>)>& take) const;
  Value attribute_value(const std::string& path, const std::string& name) const;  ///< An attribute as it is stored.

 private:
  explicit File(std::int64_t id);

  std::unique_ptr<Disk> disk_;  // of a new file on one
  std::int64_t id_;
};

/// Lets HDF5 give back all it holds, as it does when the program ends. Precondition: there is no File.
void close_library();

std::string library_version();  ///< Version of the HDF5 library in use, "1.10.8".

}  // namespace poesy::h5
