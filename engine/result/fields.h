#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/contract.h"
#include "engine/base/number.h"
#include "engine/storage/h5.h"

/// Descriptions of datasets. A FieldRow describes one dataset of a result file. From it the program writes the dataset
/// with its unit, description and axes, reads the dataset with a check of its shape, and makes columns of CSV tables
/// (csv_table.h).
namespace poesy {

/// The names of the axes of a dataset, the slowest first.
using Axes = std::vector<std::string>;

/// Axes that many datasets have.
/// @{
inline const Axes kByResponse{"response"};
inline const Axes kByFactor{"factor"};
inline const Axes kByPose{"pose"};
/// @}

/// Texts for the unit of a dataset whose numbers have different units: the unit of the response, the unit of the error
/// (factor), the former divided by the latter, and m divided by the unit of the error.
/// @{
inline constexpr const char* kResponseUnit = "SI: response unit, see /responses/unit";
inline constexpr const char* kFactorUnit = "SI: factor unit, see /factors/unit";
inline constexpr const char* kIndexUnit = "SI: response unit / factor unit";
inline constexpr const char* kLengthPerFactorUnit = "SI: m / factor unit";
/// @}

/// The attributes that describe a dataset to people.
struct Label {
  std::string unit;         ///< unit: "m"; "rad,rad,rad,m,m,m" if components have different units; "1" if there is none
  std::string description;  ///< meaning, as a sentence
};

/// Writes an HDF5 file in which every dataset has a unit, a description and named axes.
class ResultBuilder {
 public:
  explicit ResultBuilder(h5::File file) : file_(std::move(file)) {}  ///< file: an empty file.

  h5::File& file() { return file_; }  ///< The file itself, for making groups and attributes.

  /// Adds an axis: the dimension scale /name, with a value for each index along the axis.
  template <h5::Element T>
  void add_axis(const std::string& name, const std::vector<T>& values, const Label& label) {
    axis_length_[name] = values.size();
    write<T>("/" + name, {values.size()}, values, label);
    file_.make_scale("/" + name);
  }
  /// The lengths of these axes. Precondition: the axes were added.
  h5::Shape shape(const Axes& axes) const {
    h5::Shape shape;
    for (const std::string& axis : axes) shape.push_back(axis_length_.at(axis));
    return shape;
  }
  /// Adds a dataset along these axes, or a scalar if there are none. Precondition: the axes were added.
  template <h5::Element T>
  void add(const std::string& path, const Axes& axes, std::span<const T> values, const Label& label) {
    write(path, shape(axes), values, label);
    attach(path, axes);
  }
  /// Adds a dataset of numbers that are computed while they are written. element(at): the number at this row-major
  /// index.
  template <h5::Number T, class ElementAt>
  void add_computed(const std::string& path, const Axes& axes, const ElementAt& element, const Label& label) {
    file_.write_slices<T>(path, shape(axes), [&](std::size_t first, std::span<T> to) {
      for (std::size_t k = 0; k < to.size(); ++k) to[k] = static_cast<T>(element(first + k));
    });
    describe(path, label);
    attach(path, axes);
  }
  /// Adds a dataset from a list.
  template <h5::Element T>
  void add(const std::string& path, const Axes& axes, const std::vector<T>& values, const Label& label) {
    add(path, axes, std::span<const T>(values), label);
  }
  /// Adds a dataset from an array, along the array's axes.
  template <class T, class... A>
  void add(const std::string& path, const Array<T, A...>& array, const Label& label) {
    add(path, array.axis_names(), array.all(), label);
  }
  /// Adds a dataset along the axes of a layout. Its numbers are computed while they are written: element(i, j, ...)
  /// returns the number at these indices, one for each axis.
  template <h5::Number T, class... A, class ElementAt>
  void add_computed(const std::string& path, const AxisLayout<A...>& layout, const ElementAt& element,
                    const Label& label) {
    add_computed<T>(
        path, layout.axis_names(), [&](std::size_t place) { return std::apply(element, layout.positions(place)); },
        label);
  }
  /// Adds a dataset that is a scalar.
  template <h5::Element T>
  void add_scalar(const std::string& path, const T& value, const Label& label) {
    write(path, {}, std::span<const T>(&value, 1), label);
  }
  /// Links these axes into a group under the same names, because xarray reads one group at a time and needs the axes
  /// there.
  void show_axes(const std::string& group, const Axes& axes) {
    for (const std::string& axis : axes) {
      const std::string shown = group + "/" + axis;
      if (!file_.exists(shown)) file_.link("/" + axis, shown);
    }
  }

 private:
  template <h5::Element T>
  void write(const std::string& path, const h5::Shape& shape, std::span<const T> values, const Label& label) {
    file_.write<T>(path, shape, values);
    describe(path, label);
  }
  void describe(const std::string& path, const Label& label) {
    file_.set_attribute(path, "unit", label.unit);
    file_.set_attribute(path, "description", label.description);
  }
  void attach(const std::string& path, const Axes& axes) {
    for (std::size_t k = 0; k < axes.size(); ++k) file_.attach_scale(path, k, "/" + axes[k]);
  }

  h5::File file_;
  std::map<std::string, std::size_t> axis_length_;
};

/// The length of an axis of a file.
inline std::size_t axis_length(const h5::File& file, const std::string& name) {
  return h5::size(file.shape("/" + name));
}

/// Throws h5::Error unless a dataset has this shape.
inline void check_shape(const h5::File& file, const std::string& path, const h5::Shape& shape) {
  if (file.shape(path) != shape) throw h5::Error(path + " does not have the shape it should have");
}

/// Reads all elements of a dataset. Throws h5::Error unless it has this shape.
template <h5::Element T>
std::vector<T> read_shaped(const h5::File& file, const std::string& path, const h5::Shape& shape) {
  check_shape(file, path, shape);
  return file.read<T>(path);
}

/// Reads all elements of a dataset. Throws h5::Error unless its shape is that of these axes.
template <h5::Element T>
std::vector<T> read_along(const h5::File& file, const std::string& path, const Axes& axes) {
  h5::Shape shape;
  for (const std::string& axis : axes) shape.push_back(axis_length(file, axis));
  return read_shaped<T>(file, path, shape);
}

/// The lengths of an array's axes in a file. axes: names of these axes in the file.
template <class AnArray>
typename AnArray::Lengths lengths_in(const h5::File& file, const Axes& axes = AnArray::axis_names()) {
  typename AnArray::Lengths lengths;
  std::ranges::transform(axes, lengths.begin(), [&](const std::string& axis) { return axis_length(file, axis); });
  return lengths;
}

/// Reads a dataset as an array of this type. axes: names of the array's axes in the file. Throws h5::Error if the
/// dataset has another shape.
template <class AnArray>
AnArray read_array(const h5::File& file, const std::string& path, const Axes& axes = AnArray::axis_names()) {
  return {lengths_in<AnArray>(file, axes), read_along<typename AnArray::Element>(file, path, axes)};
}

/// Whether every result file of a kind of study has a certain dataset.
enum class Presence {
  always,          ///< every file has it
  where_computed,  ///< the dataset is missing if its array is empty, because the study did not compute it
};

/// The lengths of axes by their names.
using AxisLengths = std::map<std::string, std::size_t, std::less<>>;

namespace detail {

template <class Value>
inline constexpr bool kIsList = false;
template <class T>
inline constexpr bool kIsList<std::vector<T>> = true;
template <class Value>
inline constexpr bool kIsArray = false;
template <class T, class... A>
inline constexpr bool kIsArray<Array<T, A...>> = true;

/// The names of the axes of a member: those of its type if that is an Array, none for a single value.
template <class Value>
Axes axes_of() {
  static_assert(!kIsList<Value>, "the type of a list does not say its axes");
  if constexpr (kIsArray<Value>) {
    return Value::axis_names();
  } else {
    return {};
  }
}

/// Converts an element to the type that HDF5 stores: a flag to a byte, and an index that may be missing to an integer,
/// with -1 for a missing index. Other types stay as they are.
template <class Value>
auto stored(const Value& value) {
  if constexpr (std::is_same_v<Value, bool>) {
    return static_cast<std::uint8_t>(value);
  } else if constexpr (std::is_same_v<Value, std::optional<std::size_t>>) {
    return value ? static_cast<std::int64_t>(*value) : -1;
  } else {
    return value;
  }
}

template <class Value>
using StoredAs = decltype(stored(std::declval<Value>()));

template <class Value>
void restore(StoredAs<Value> from, Value& to) {
  if constexpr (std::is_same_v<Value, std::optional<std::size_t>>) {
    to = from < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(from));
  } else if constexpr (std::is_same_v<Value, bool>) {
    to = from != 0;
  } else {
    to = std::move(from);
  }
}

/// Converts an element to a number. Precondition: the element is not a text.
template <class Value>
Number number(const Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    POESY_EXPECTS(false);
    return 0.0;
  } else {
    return to_number(stored(value));
  }
}

/// Where a dataset is in a file, and the attributes that describe it.
struct Place {
  const std::string& path;  ///< absolute path of the dataset
  const Axes& axes;         ///< names of the axes of the dataset; the axes are at the root of the file
  const Label& label;       ///< unit and description of the dataset
  Presence presence;        ///< whether a file may lack the dataset
};

/// The interface for reading and writing one member of objects of type `Found`. It hides the type of the member.
template <class Found>
class Member {
 public:
  virtual ~Member() = default;
  /// Adds to the result file a dataset with the elements of the member of one object, or with one element for each of
  /// several objects (things). Returns false if nothing was written, because the member is empty
  /// (Presence::where_computed).
  virtual bool write(ResultBuilder& result, const Place& place, std::span<const Found> things) const = 0;
  /// Reads the member of each object in `things`. Throws h5::Error if the dataset is missing or has another shape.
  virtual void read(const h5::File& file, const std::string& path, const Axes& axes, std::span<Found> things) const = 0;
  virtual void clear(Found& found) const = 0;  ///< Empties the member if it is a list or an Array.
  virtual Number number(const Found& found, std::size_t at) const = 0;  ///< The element at this index, row-major.
  /// The element at index `within` of one row of the member's elements. row: index of the row on the first axis.
  virtual Number number_in_row(const Found& found, std::size_t row, std::size_t within) const = 0;
  /// The size of one element in bytes; for a number the same in memory and in a file.
  virtual std::size_t element_bytes() const = 0;
};

/// Reads and writes a member of type `Value`: an Array, a std::vector, or a single value.
template <class Found, class Value>
class MemberOf final : public Member<Found> {
 public:
  explicit MemberOf(Value Found::*member) : member_(member) {}  ///< member: pointer to this member of `Found`

  bool write(ResultBuilder& result, const Place& place, std::span<const Found> things) const override {
    if constexpr (kIsList<Value> || kIsArray<Value>) {
      const Value& list = things.front().*member_;
      const bool computed = !list.empty() || h5::size(result.shape(place.axes)) == 0;
      if (place.presence == Presence::where_computed && !computed) return false;
      result.add(place.path, place.axes, std::span(list.begin(), list.end()), place.label);
    } else {
      std::vector<StoredAs<Value>> column;
      for (const Found& thing : things) column.push_back(stored(thing.*member_));
      result.add(place.path, place.axes, column, place.label);
    }
    return true;
  }
  void read(const h5::File& file, const std::string& path, const Axes& axes, std::span<Found> things) const override {
    if constexpr (kIsArray<Value>) {
      // The names of the axes come from the description of the dataset, because they may differ from those in the type.
      things.front().*member_ = read_array<Value>(file, path, axes);
    } else if constexpr (kIsList<Value>) {
      things.front().*member_ = read_along<typename Value::value_type>(file, path, axes);
    } else {
      auto column = read_along<StoredAs<Value>>(file, path, axes);
      for (std::size_t k = 0; k < things.size(); ++k) restore(std::move(column[k]), things[k].*member_);
    }
  }
  void clear(Found& found) const override {
    if constexpr (kIsList<Value> || kIsArray<Value>) found.*member_ = Value();
  }
  Number number(const Found& found, std::size_t at) const override {
    const Value& value = found.*member_;
    if constexpr (kIsList<Value> || kIsArray<Value>) {
      return detail::number(*(value.begin() + static_cast<std::ptrdiff_t>(at)));
    } else {
      return detail::number(value);
    }
  }
  Number number_in_row(const Found& found, std::size_t row, std::size_t within) const override {
    if constexpr (kIsArray<Value>) {
      if constexpr (Value::kAxes > 1) return detail::number((found.*member_).row(row)[within]);
    }
    POESY_EXPECTS(within == 0);
    return number(found, row);
  }
  std::size_t element_bytes() const override {
    if constexpr (kIsArray<Value>) {
      return sizeof(typename Value::Element);
    } else if constexpr (kIsList<Value>) {
      return sizeof(typename Value::value_type);
    } else {
      return sizeof(StoredAs<Value>);
    }
  }

 private:
  Value Found::*member_;
};

}  // namespace detail

/// A number of a result that a file has as an attribute of a group or a dataset.
template <class Found>
struct Attribute {
  std::string name;       ///< name of the attribute in the file
  double Found::*member;  ///< pointer to the member with the number
};

/// Describes a dataset in a group of a result file by the member of `Found` that has its numbers. If the member is an
/// Array, its axes are those of the dataset. If the member is a single value, the dataset is a scalar, or has one
/// element for each object of a list, along a named axis.
template <class Found>
struct FieldRow {
  /// Describes a dataset from an Array or a single value.
  template <class Value>
  FieldRow(std::string dataset, Value Found::*elements, std::string in, std::string meaning,
           Presence when = Presence::always, std::vector<Attribute<Found>> beside = {})
      : FieldRow(std::move(dataset), elements, detail::axes_of<Value>(), std::move(in), std::move(meaning), when) {
    attributes = std::move(beside);
  }
  /// Describes a dataset along these axes, for a member whose type does not determine its axes.
  template <class Value>
  FieldRow(std::string dataset, Value Found::*elements, Axes along, std::string in, std::string meaning,
           Presence when = Presence::always)
      : name(std::move(dataset)),
        member(std::make_shared<detail::MemberOf<Found, Value>>(elements)),
        axes(std::move(along)),
        unit(std::move(in)),
        description(std::move(meaning)),
        presence(when) {}
  /// Describes a dataset with these axes and attributes.
  template <class Value>
  FieldRow(std::string dataset, Value Found::*elements, Axes along, std::string in, std::string meaning,
           std::vector<Attribute<Found>> beside)
      : FieldRow(std::move(dataset), elements, std::move(along), std::move(in), std::move(meaning)) {
    attributes = std::move(beside);
  }

  std::string name;                                     ///< name of the dataset in its group
  std::shared_ptr<const detail::Member<Found>> member;  ///< reads and writes the member with the elements
  Axes axes;                ///< names of the axes, which are at the root of the file; none for a scalar
  std::string unit;         ///< unit: "m", "1", or one of the texts above, such as kResponseUnit
  std::string description;  ///< meaning, as a sentence
  std::vector<Attribute<Found>> attributes;  ///< attributes of the dataset, which are written but not read
  Presence presence = Presence::always;      ///< whether every file has the dataset, or only some
};

/// The descriptions of the datasets of a group, in the order in which they are written.
template <class Found>
using Fields = std::vector<FieldRow<Found>>;

/// A group of a result file with its datasets.
template <class Found>
struct Group {
  std::string path;                                                        ///< path of the group: "/sensitivity"
  std::string description;                                                 ///< meaning, as a sentence
  std::vector<Attribute<Found>> attributes = {};                           ///< numbers that are attributes of the group
  std::vector<std::pair<std::string, std::size_t Found::*>> lengths = {};  ///< axes whose lengths are read into members
  Fields<Found> fields;                                                    ///< datasets of the group
};

/// Adds one dataset to a group, with the elements of one object, or with one element for each of several objects
/// (things). Returns false if nothing was written, because the member is empty (Presence::where_computed).
/// Precondition: members that are lists occur only with a single object.
template <class Found>
bool write_field(ResultBuilder& result, const std::string& group, const FieldRow<Found>& field,
                 std::span<const Found> things) {
  const std::string path = group + "/" + field.name;
  const Label label{field.unit, field.description};
  if (!field.member->write(result, {path, field.axes, label, field.presence}, things)) return false;
  for (const Attribute<Found>& each : field.attributes) {
    result.file().set_attribute(path, each.name, things.front().*each.member);
  }
  return true;
}

/// Writes to the result file the datasets of these fields, with the elements of a single object.
template <class Found>
void write_fields(ResultBuilder& result, const std::string& group, const Fields<Found>& fields, const Found& found) {
  for (const FieldRow<Found>& field : fields) write_field(result, group, field, std::span(&found, 1));
}

/// Writes to the result file the datasets of these fields, with one element for each object of a list.
template <class Thing>
void write_columns(ResultBuilder& result, const std::string& group, const Fields<Thing>& fields,
                   const std::vector<Thing>& things) {
  for (const FieldRow<Thing>& field : fields) write_field(result, group, field, std::span(things));
}

/// Adds to the result file a group with all its datasets, and links their axes into the group. Calls after_field(field)
/// after each dataset.
template <class Found, class AfterField>
void write_group(ResultBuilder& result, const Group<Found>& group, const Found& found, const AfterField& after_field) {
  h5::File& file = result.file();
  file.make_group(group.path);
  file.set_attribute(group.path, "description", group.description);
  for (const Attribute<Found>& each : group.attributes) {
    file.set_attribute(group.path, each.name, found.*each.member);
  }
  for (const FieldRow<Found>& field : group.fields) {
    if (write_field(result, group.path, field, std::span(&found, 1))) result.show_axes(group.path, field.axes);
    after_field(field);
  }
}

/// Adds to the result file a group with all its datasets. Unlike the function below, it does not change `found`.
template <class Found>
void write_group(ResultBuilder& result, const Group<Found>& group, const Found& found) {
  write_group(result, group, found, [](const FieldRow<Found>&) {});
}

/// Adds to the result file a group, and empties each list of `found` after writing it, because HDF5 needs memory for
/// data that are not yet on disk. Members without a dataset are kept.
template <class Found>
void write_group(ResultBuilder& result, const Group<Found>& group, Found&& found) {
  write_group(result, group, std::as_const(found), [&](const FieldRow<Found>& field) { field.member->clear(found); });
}

/// Reads the members that these fields describe, for several objects; each dataset has one element for each object.
/// Throws h5::Error if a dataset is missing or has another shape.
template <class Found>
void read_fields(const h5::File& file, const std::string& group, const Fields<Found>& fields, std::span<Found> things) {
  for (const FieldRow<Found>& field : fields) {
    const std::string path = group + "/" + field.name;
    if (field.presence == Presence::where_computed && !file.exists(path)) continue;
    field.member->read(file, path, field.axes, things);
  }
}

/// Reads the members that these fields describe, for a single object.
template <class Found>
void read_fields(const h5::File& file, const std::string& group, const Fields<Found>& fields, Found& found) {
  read_fields(file, group, fields, std::span(&found, 1));
}

/// Reads a list of objects from datasets with one element for each object. The number of objects is the length of the
/// first dataset's axis.
template <class Thing>
std::vector<Thing> read_columns(const h5::File& file, const std::string& group, const Fields<Thing>& fields) {
  const std::size_t length = axis_length(file, fields.front().axes.front());
  for (const FieldRow<Thing>& field : fields) check_shape(file, group + "/" + field.name, {length});
  std::vector<Thing> things(length);
  read_fields(file, group, fields, std::span(things));
  return things;
}

/// Reads the lengths, attributes and datasets of a group into `found`.
template <class Found>
void read_group(const h5::File& file, const Group<Found>& group, Found& found) {
  for (const auto& [axis, length] : group.lengths) found.*length = axis_length(file, axis);
  for (const Attribute<Found>& each : group.attributes) {
    found.*each.member = file.attribute<double>(group.path, each.name).at(0);
  }
  read_fields(file, group.path, group.fields, found);
}

/// The size of all elements of these datasets in bytes; for numbers the same in memory and in a file. lengths: the
/// lengths of all their axes.
template <class Found>
std::size_t bytes_of(const Fields<Found>& fields, const AxisLengths& lengths) {
  std::size_t bytes = 0;
  for (const FieldRow<Found>& field : fields) {
    std::size_t elements = 1;
    for (const std::string& axis : field.axes) elements *= lengths.at(axis);
    bytes += elements * field.member->element_bytes();
  }
  return bytes;
}

/// The element of a dataset at this row-major index, as the file stores it. Precondition: the element exists and is a
/// number.
template <class Found>
Number number_at(const FieldRow<Found>& field, const Found& found, std::size_t at) {
  return field.member->number(found, at);
}

}  // namespace poesy
