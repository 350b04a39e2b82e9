#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
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
  /// The state of an object that both directions have.
  template <class Object>
  void object(Object& object) {
    object.state(*this);
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
  /// Throws BytesError where something that was read does not hold.
  void expect(bool holds, const char* problem) const {
    if (reads() && !holds) throw BytesError(problem);
  }

  ByteWriter& writer() { return *to_; }    ///< For what is packed. Precondition: it writes.
  ByteReader& reader() { return *from_; }  ///< For what is packed. Precondition: it reads.

 private:
  ByteWriter* to_ = nullptr;
  ByteReader* from_ = nullptr;
};

/// Writes an object's state. context: what its state() is told in addition.
template <class Object, class... Context>
void write_state(const Object& object, ByteWriter& to, const Context&... context) {
  Archive archive(to);
  const_cast<Object&>(object).state(archive, context...);  // it changes nothing where it writes
}

/// Reads the state of an object that is made of these sizes. Throws BytesError for what no such object writes.
template <class Object, class... Sizes>
Object read_state(ByteReader& from, const Sizes&... sizes) {
  Object object(sizes...);
  Archive archive(from);
  object.state(archive);
  return object;
}

}  // namespace poesy
