#include "engine/files/fields.h"

namespace poesy {

template <h5::Element T>
void ResultBuilder::add_axis(const std::string& name, const std::vector<T>& values, const Label& label) {
  axis_length_[name] = values.size();
  const std::string path = "/" + name;
  file_.write<T>(path, {values.size()}, values);
  file_.set_attribute(path, "unit", label.unit);
  file_.set_attribute(path, "description", label.description);
  file_.make_scale(path);
}

h5::Shape ResultBuilder::shape(const Axes& axes) const {
  h5::Shape shape;
  for (const std::string& axis : axes) shape.push_back(axis_length_.at(axis));
  return shape;
}

template <h5::Element T>
void ResultBuilder::add(const std::string& path, const Axes& axes, std::span<const T> values, const Label& label) {
  file_.write<T>(path, shape(axes), values);
  file_.set_attribute(path, "unit", label.unit);
  file_.set_attribute(path, "description", label.description);
  for (std::size_t k = 0; k < axes.size(); ++k) file_.attach_scale(path, k, "/" + axes[k]);
}

void ResultBuilder::show_axes(const std::string& group, const Axes& axes) {
  for (const std::string& axis : axes) {
    const std::string shown = group + "/" + axis;
    if (!file_.exists(shown)) file_.link("/" + axis, shown);
  }
}

std::size_t axis_length(const h5::File& file, const std::string& name) { return h5::size(file.shape("/" + name)); }

void check_shape(const h5::File& file, const std::string& path, const h5::Shape& shape) {
  if (file.shape(path) != shape) throw h5::Error(path + " does not have the shape it should have");
}

template <h5::Element T>
std::vector<T> read_shaped(const h5::File& file, const std::string& path, const h5::Shape& shape) {
  check_shape(file, path, shape);
  return file.read<T>(path);
}

template <h5::Element T>
std::vector<T> read_along(const h5::File& file, const std::string& path, const Axes& axes) {
  h5::Shape shape;
  for (const std::string& axis : axes) shape.push_back(axis_length(file, axis));
  return read_shaped<T>(file, path, shape);
}

#define POESY_FIELD_ELEMENT(T)                                                                            \
  template void ResultBuilder::add_axis<T>(const std::string&, const std::vector<T>&, const Label&);      \
  template void ResultBuilder::add<T>(const std::string&, const Axes&, std::span<const T>, const Label&); \
  template std::vector<T> read_shaped<T>(const h5::File&, const std::string&, const h5::Shape&);          \
  template std::vector<T> read_along<T>(const h5::File&, const std::string&, const Axes&);
POESY_FIELD_ELEMENT(double)
POESY_FIELD_ELEMENT(std::int64_t)
POESY_FIELD_ELEMENT(std::uint64_t)
POESY_FIELD_ELEMENT(std::uint32_t)
POESY_FIELD_ELEMENT(std::uint8_t)
POESY_FIELD_ELEMENT(std::string)
#undef POESY_FIELD_ELEMENT

}  // namespace poesy
