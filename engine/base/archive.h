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

/// Writes the state of an object, or reads it back: the same list of members serves both directions.
///
///     void Moments::state(Archive& archive) {
///       archive.number(count_);
///       archive.real(mean_);
///     }
///
/// What is read may come from anywhere, so state() says with expect() what must hold; it throws BytesError.
class Archive {
 public:
  explicit Archive(ByteWriter& to) : to_(&to) {}        ///< Writes. Refers to the writer.
  explicit Archive(ByteReader& from) : from_(&from) {}  ///< Reads. Refers to the reader.

  bool reads() const { return from_ != nullptr; }  ///< Whether members are filled in.

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
  /// A double; every bit is kept.
  void real(double& value) { reals(std::span(&value, 1)); }
  /// Several doubles.
  template <class... Doubles>
  void real(double& value, Doubles&... more) {
    real(value);
    real(more...);
  }
  /// The state of an object that both directions have, or of a list of them whose number both know. An object that is
  /// packed has write(ByteWriter&) and a static read(ByteReader&) instead of state().
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
  /// Doubles whose number both directions know.
  void reals(std::span<double> values) {
    if (reads()) {
      from_->reals(values);
    } else {
      to_->reals(values);
    }
  }
  /// A list of so many doubles, which is empty where it is read.
  void list(std::vector<double>& values, std::size_t count) {
    if (reads()) {
      values = from_->reals(count);
    } else {
      to_->reals(values);
    }
  }
  /// An object that may be missing; where it is read, it is first made of these sizes.
  template <class Object, class... Sizes>
  void optional(std::optional<Object>& value, const Sizes&... sizes) {
    if (!flag(value.has_value())) return value.reset();
    if (reads()) value.emplace(sizes...);
    object(*value);
  }
  /// Whether something holds, as it was when it was written.
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
  /// A number that both directions know. Throws BytesError for any other.
  void known(std::uint64_t value, const char* problem) {
    std::uint64_t read = value;
    number(read);
    expect(read == value, problem);
  }
  /// Throws BytesError where something that was read does not hold.
  void expect(bool holds, const char* problem) const {
    if (reads() && !holds) throw BytesError(problem);
  }

  /// For an object whose packed form has a writer and a reader: write(ByteWriter&), and read(ByteReader&, ...), which
  /// gives the object.
  template <class Object, class... Known>
  void packed(Object& object, const Known&... known) {
    if (reads()) {
      object = Object::read(*from_, known...);
    } else {
      object.write(*to_);
    }
  }
  /// Whether something is left to be read.
  bool is_left() const { return reads() && from_->left() > 0; }

 private:
  ByteWriter* to_ = nullptr;
  ByteReader* from_ = nullptr;
};

/// Writes an object's state.
template <class Object>
void write_state(const Object& object, ByteWriter& to) {
  Archive archive(to);
  archive.object(const_cast<Object&>(object));  // it changes nothing where it writes
}

/// Reads the state of an object that is made of these sizes. Throws BytesError for what no such object writes.
template <class Object, class... Sizes>
Object read_state(ByteReader& from, const Sizes&... sizes) {
  Object object(sizes...);
  Archive archive(from);
  archive.object(object);
  return object;
}

}  // namespace poesy
