#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/base/bytes.h"

namespace poesy {

/// Writes or reads the state of an object. The class of the object lists its members once, in state(), for both
/// directions:
///
///     void Moments::state(Archive& archive) {
///       archive.number(count_);
///       archive.real(mean_);
///     }
///
/// The bytes may come from an untrusted source, so state() must check what it reads with expect(), which throws
/// BytesError.
class Archive {
 public:
  explicit Archive(ByteWriter& to) : to_(&to) {}        ///< An archive that writes to `to`, which must outlive it.
  explicit Archive(ByteReader& from) : from_(&from) {}  ///< An archive that reads from `from`, which must outlive it.

  bool reads() const { return from_ != nullptr; }  ///< Returns true if the archive reads, false if it writes.

  /// Writes or reads a whole number or an enumeration. When reading, throws BytesError if the value is above `most` or
  /// does not fit an unsigned type.
  template <class Whole>
  void number(Whole& value, std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) {
    if (reads()) {
      if constexpr (sizeof(Whole) < sizeof(std::uint64_t) && std::is_unsigned_v<Whole>) {
        most = std::min<std::uint64_t>(most, std::numeric_limits<Whole>::max());
      }
      value = static_cast<Whole>(from_->number_up_to(most));
    } else {
      to_->number(static_cast<std::uint64_t>(value));
    }
  }
  /// Writes or reads a double, bit by bit.
  void real(double& value) { reals(std::span(&value, 1)); }
  /// Writes or reads several doubles.
  template <class... Doubles>
  void real(double& value, Doubles&... more) {
    real(value);
    real(more...);
  }
  /// Writes or reads the state of an object, or the states of a list of objects. When reading, the object must exist
  /// already, and a list must have its final length. An object without state() must have write(ByteWriter&) and a
  /// static read(ByteReader&).
  template <class Object>
  void object(Object& object) {
    if constexpr (requires { object.state(*this); }) {
      object.state(*this);
    } else if constexpr (std::ranges::range<Object>) {
      for (auto& one : object) this->object(one);
    } else {
      packed(object);
    }
  }
  /// Writes or reads the states of several objects.
  template <class... Objects>
  void objects(Objects&... objects) {
    (object(objects), ...);
  }
  /// Writes or reads doubles without their number, which the reader knows.
  void reals(std::span<double> values) {
    if (reads()) {
      from_->reals(values);
    } else {
      to_->reals(values);
    }
  }
  /// Writes or reads a list of `count` doubles, without its length.
  void list(std::vector<double>& values, std::size_t count) {
    if (reads()) {
      values = from_->reals(count);
    } else {
      to_->reals(values);
    }
  }
  /// Writes or reads an object that may be missing. sizes: arguments of the object's constructor, which the reader
  /// calls before it reads the state.
  template <class Object, class... Sizes>
  void optional(std::optional<Object>& value, const Sizes&... sizes) {
    if (!flag(value.has_value())) return value.reset();
    if (reads()) value.emplace(sizes...);
    object(*value);
  }
  /// Writes `value` and returns it, or reads a bool and returns that. When reading, `value` is ignored.
  bool flag(bool value) {
    std::uint64_t holds = value ? 1 : 0;
    number(holds, 1);
    return holds == 1;
  }
  /// Writes or reads a text of any length.
  void text(std::string& value) {
    if (reads()) {
      value = from_->text();
    } else {
      to_->text(value);
    }
  }
  /// Writes or reads a list of bytes of any length.
  void block(Bytes& bytes) {
    if (reads()) {
      const std::span<const std::byte> read = from_->block();
      bytes.assign(read.begin(), read.end());
    } else {
      to_->block(bytes);
    }
  }
  /// Writes a number that the reader already knows. When reading, throws BytesError with the text `problem` if another
  /// number was written.
  void known(std::uint64_t value, const char* problem) {
    std::uint64_t read = value;
    number(read);
    expect(read == value, problem);
  }
  /// When reading, throws BytesError with the text `problem` unless `holds` is true. Does nothing when writing.
  void expect(bool holds, const char* problem) const {
    if (reads() && !holds) throw BytesError(problem);
  }

  /// Writes an object by its write(ByteWriter&), or reads it by its static read(ByteReader&, known...). known: further
  /// arguments of read(), which are not in the bytes.
  template <class Object, class... Known>
  void packed(Object& object, const Known&... known) {
    if (reads()) {
      object = Object::read(*from_, known...);
    } else {
      object.write(*to_);
    }
  }
  /// Returns true if there are bytes left to read.
  bool is_left() const { return reads() && from_->left() > 0; }

 private:
  ByteWriter* to_ = nullptr;
  ByteReader* from_ = nullptr;
};

/// Writes an object's state.
template <class Object>
void write_state(const Object& object, ByteWriter& to) {
  Archive archive(to);
  archive.object(const_cast<Object&>(object));  // writing does not change the object
}

/// Constructs an object and reads its state. sizes: arguments of the object's constructor. Throws BytesError if the
/// bytes cannot be the state of an object with these sizes.
template <class Object, class... Sizes>
Object read_state(ByteReader& from, const Sizes&... sizes) {
  Object object(sizes...);
  Archive archive(from);
  archive.object(object);
  return object;
}

}  // namespace poesy
