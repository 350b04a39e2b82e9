#include "engine/io/result_builder.h"

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

template <h5::Element T>
void ResultBuilder::add(const std::string& path, const std::vector<std::string>& axes, std::span<const T> values,
                        const Label& label) {
  h5::Shape shape;
  for (const std::string& axis : axes) shape.push_back(axis_length_.at(axis));
  file_.write<T>(path, shape, values);
  file_.set_attribute(path, "unit", label.unit);
  file_.set_attribute(path, "description", label.description);
  for (std::size_t k = 0; k < axes.size(); ++k) file_.attach_scale(path, k, "/" + axes[k]);
}

void ResultBuilder::show_axes(const std::string& group, const std::vector<std::string>& axes) {
  for (const std::string& axis : axes) file_.link("/" + axis, group + "/" + axis);
}

#define POESY_RESULT_ELEMENT(T)                                                                                \
  template void ResultBuilder::add_axis<T>(const std::string&, const std::vector<T>&, const Label&);           \
  template void ResultBuilder::add<T>(const std::string&, const std::vector<std::string>&, std::span<const T>, \
                                      const Label&);
POESY_RESULT_ELEMENT(double)
POESY_RESULT_ELEMENT(std::int64_t)
POESY_RESULT_ELEMENT(std::uint64_t)
POESY_RESULT_ELEMENT(std::uint32_t)
POESY_RESULT_ELEMENT(std::uint8_t)
POESY_RESULT_ELEMENT(std::string)
#undef POESY_RESULT_ELEMENT

}  // namespace poesy
