#include "engine/python/solver/arrays.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>

#include "engine/base/units.h"

namespace py = pybind11;

namespace poesy::python {
namespace {

using Shape = std::vector<std::size_t>;

/// A shape as text in the notation of Python: "(71,)", "(71, 1000)".
std::string text_of(const Shape& shape) {
  return fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
}

Shape shape_of(const py::array& array) { return {array.shape(), array.shape() + array.ndim()}; }

bool has_order(const py::array& array, int order) { return (array.flags() & order) != 0; }

/// Throws TypeError unless the object is an array of this type of number in this machine's byte order.
template <class Number>
py::array_t<Number> array_of(const py::object& given, const std::string& name, const std::string& type) {
  if (py::isinstance<py::array_t<Number>>(given)) return py::reinterpret_borrow<py::array_t<Number>>(given);
  const std::string is = py::isinstance<py::array>(given)
                             ? "an array of " + py::str(given.attr("dtype")).cast<std::string>()
                             : "of type " + py::str(py::type::of(given).attr("__name__")).cast<std::string>();
  throw py::type_error(
      fmt::format("{} is {}, but a NumPy array of {} is needed, which is used where it stands: "
                  "numpy.ascontiguousarray(..., dtype=numpy.{}) makes one",
                  name, is, type, type));
}

/// Throws ValueError unless the array begins at a multiple of the size of its elements in memory. size: size of an
/// element in bytes.
void check_aligned(const py::array& array, const std::string& name, std::size_t size) {
  if (reinterpret_cast<std::uintptr_t>(array.data()) % size == 0) return;
  throw py::value_error(name + " does not begin at a multiple of its elements' size in memory; copy it");
}

[[noreturn]] void refuse_shape(const py::array& array, const std::string& name, const std::string& wanted) {
  const bool c = has_order(array, py::array::c_style);
  const char* order = c ? "C order" : has_order(array, py::array::f_style) ? "Fortran order" : "no contiguous order";
  throw py::value_error(
      fmt::format("{} has shape {} in {}; needed: {}", name, text_of(shape_of(array)), order, wanted));
}

/// Throws ValueError unless the array has this shape and this order (C or Fortran).
void check_shape(const py::array& array, const std::string& name, const Shape& shape, int order,
                 const std::string& meaning = "") {
  if (shape_of(array) == shape && has_order(array, order)) return;
  refuse_shape(
      array, name,
      fmt::format("{} in {}{}", text_of(shape), order == py::array::c_style ? "C order" : "Fortran order", meaning));
}

void check_writeable(const py::array& array, const std::string& name) {
  if (!array.writeable()) throw py::value_error(name + " cannot be written");
}

py::array_t<double> responses_of_shape(const py::object& given, const Shape& shape, int order) {
  py::array_t<double> out = array_of<double>(given, "out", "float64");
  check_shape(out, "out", shape, order);
  check_writeable(out, "out");
  check_aligned(out, "out", sizeof(double));
  return out;
}

}  // namespace

ErrorArray error_array(const py::object& given, std::size_t errors) {
  const py::array_t<double> array = array_of<double>(given, "errors", "float64");
  check_aligned(array, "errors", sizeof(double));
  const Shape shape = shape_of(array);
  const bool rows = has_order(array, py::array::c_style);
  if (rows && shape == Shape{errors}) return {array.data(), 1, Layout::one_sample};
  if (rows && shape.size() == 2 && shape[0] == errors) return {array.data(), shape[1], Layout::rows};
  if (has_order(array, py::array::f_style) && shape.size() == 2 && shape[1] == errors) {
    return {array.data(), shape[0], Layout::columns};
  }
  refuse_shape(array, "errors",
               fmt::format("({}, B) in C order, a row for each error, (B, {}) in Fortran order, which is the same "
                           "memory, or ({},), one sample",
                           errors, errors, errors));
}

ErrorArray shared_error_array(const py::object& given, std::size_t errors) {
  const ErrorArray array = error_array(given, errors);
  if (array.layout != Layout::columns) return array;
  refuse_shape(py::reinterpret_borrow<py::array>(given), "errors",
               fmt::format("({}, B) in C order, a row for each error, or ({},), one sample", errors, errors));
}

const double* paired_error_array(const py::object& given, std::size_t poses, std::size_t errors) {
  const py::array_t<double> array = array_of<double>(given, "errors", "float64");
  check_shape(array, "errors", {poses, errors}, py::array::c_style, ", row by row with the poses");
  check_aligned(array, "errors", sizeof(double));
  return array.data();
}

py::array_t<double> response_array(const py::object& given, std::size_t responses, const ErrorArray& errors) {
  if (errors.layout == Layout::columns) {
    const Shape shape{errors.samples, responses};
    if (given.is_none()) return py::array_t<double, py::array::f_style>(shape);
    return responses_of_shape(given, shape, py::array::f_style);
  }
  return response_block(given,
                        errors.layout == Layout::one_sample ? Shape{responses} : Shape{responses, errors.samples});
}

py::array_t<double> response_block(const py::object& given, const Shape& shape) {
  if (given.is_none()) return py::array_t<double>(shape);
  return responses_of_shape(given, shape, py::array::c_style);
}

SolveStatus* status_array(const py::object& given, const Shape& shape) {
  if (given.is_none()) return nullptr;
  py::array_t<std::uint8_t> array = array_of<std::uint8_t>(given, "status", "uint8");
  check_shape(array, "status", shape, py::array::c_style);
  check_writeable(array, "status");
  static_assert(sizeof(SolveStatus) == sizeof(std::uint8_t));
  return reinterpret_cast<SolveStatus*>(array.mutable_data());
}

void check_apart(std::span<const Memory> arrays) {
  const auto begin = [](const Memory& memory) { return reinterpret_cast<std::uintptr_t>(memory.begin); };
  for (const Memory& a : arrays) {
    for (const Memory& b : arrays.first(static_cast<std::size_t>(&a - arrays.data()))) {
      if (a.begin == nullptr || b.begin == nullptr) continue;
      if (begin(a) >= begin(b) + b.bytes || begin(b) >= begin(a) + a.bytes) continue;
      throw py::value_error(fmt::format("{} and {} share memory", b.name, a.name));
    }
  }
}

std::vector<double> pose_numbers(const py::object& given, std::size_t axes, const ModelDescription& model) {
  const std::string name = axes == 1 ? "pose" : "poses";
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) throw py::type_error(name + " must be numbers: an array, or lists of them");
  const Shape shape = shape_of(array);
  if (shape.size() == axes && shape.back() == model.pose_coordinates.size()) {
    return {array.data(), array.data() + array.size()};
  }
  std::vector<std::string> names;
  for (const PoseCoordinate& coordinate : model.pose_coordinates) {
    names.push_back(fmt::format("{} ({})", coordinate.name, si_unit(coordinate.dimension)));
  }
  throw py::value_error(fmt::format("{} has shape {}; needed: ({}{}{}): {}", name, text_of(shape),
                                    axes == 2 ? "M, " : "", names.size(), axes == 1 ? "," : "",
                                    fmt::join(names, ", ")));
}

}  // namespace poesy::python
