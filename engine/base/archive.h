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

/// Writes or reads the state of an object; one list of members serves both directions.
///
///     void Moments::state(Archive& archive) {
///       archive.number(count_);
///       archive.real(mean_);
///     }
///
/// What is read may come from any source, so state() checks it with expect(), which throws BytesError.
class Archive {
 public:
  explicit Archive(ByteWriter& to) : to_(&to) {}        ///< Writes to this writer. Refers to it.
  explicit Archive(ByteReader& from) : from_(&from) {}  ///< Reads from this reader. Refers to it.

  bool reads() const { return from_ != nullptr; }  ///< Whether members are read.

  /// A whole number, an index or an enumeration, up to `most`.
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
  /// A double, bit by bit.
  void real(double& value) { reals(std::span(&value, 1)); }
  /// Several doubles.
  template <class... Doubles>
  void real(double& value, Doubles&... more) {
    real(value);
    real(more...);
  }
  /// The state of an object that exists in both directions, or of a list of objects whose number both know. A packed
  /// object has write(ByteWriter&) and a static read(ByteReader&) instead of state().
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
  /// The states of several objects.
  template <class... Objects>
  void objects(Objects&... objects) {
    (object(objects), ...);
  }
  /// Doubles whose number is known in both directions.
  void reals(std::span<double> values) {
    if (reads()) {
      from_->reals(values);
    } else {
      to_->reals(values);
    }
  }
  /// A list of `count` doubles; empty before reading.
  void list(std::vector<double>& values, std::size_t count) {
    if (reads()) {
      values = from_->reals(count);
    } else {
      to_->reals(values);
    }
  }
  /// An object that may be missing. Before reading, it is constructed with these sizes.
  template <class Object, class... Sizes>
  void optional(std::optional<Object>& value, const Sizes&... sizes) {
    if (!flag(value.has_value())) return value.reset();
    if (reads()) value.emplace(sizes...);
    object(*value);
  }
  /// A bool. Returns what was written when reading.
  bool flag(bool value) {
    std::uint64_t holds = value ? 1 : 0;
    number(holds, 1);
    return holds == 1;
  }
  /// A text of any length.
  void text(std::string& value) {
    if (reads()) {
      value = from_->text();
    } else {
      to_->text(value);
    }
  }
  /// Bytes of any length.
  void block(Bytes& bytes) {
    if (reads()) {
      const std::span<const std::byte> read = from_->block();
      bytes.assign(read.begin(), read.end());
    } else {
      to_->block(bytes);
    }
  }
  /// A number that both directions know. Throws BytesError if another one is read.
  void known(std::uint64_t value, const char* problem) {
    std::uint64_t read = value;
    number(read);
    expect(read == value, problem);
  }
  /// Throws BytesError if a condition on what was read does not hold.
  void expect(bool holds, const char* problem) const {
    if (reads() && !holds) throw BytesError(problem);
  }

  /// An object whose packed form has write(ByteWriter&) and read(ByteReader&, ...), which returns the object.
  template <class Object, class... Known>
  void packed(Object& object, const Known&... known) {
    if (reads()) {
      object = Object::read(*from_, known...);
    } else {
      object.write(*to_);
    }
  }
  /// Whether there are bytes left to read.
  bool is_left() const { return reads() && from_->left() > 0; }

 private:
  ByteWriter* to_ = nullptr;
  ByteReader* from_ = nullptr;
};

/// Writes an object's state.
template <class Object>
void write_state(const Object& object, ByteWriter& to) {
  Archive archive(to);
  archive.object(const_cast<Object&>(object));  // writing does not change it
}

/// Reads the state of an object that is constructed with these sizes. Throws BytesError for bytes that it cannot have
/// written.
template <class Object, class... Sizes>
Object read_state(ByteReader& from, const Sizes&... sizes) {
  Object object(sizes...);
  Archive archive(from);
  archive.object(object);
  return object;
}

}  // namespace poesy
