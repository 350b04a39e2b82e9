#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/model/status.h"

/// Checks of NumPy arrays that the solver uses directly. An array that does not fit is refused, never converted.
namespace poesy::python {

/// The layout of an array of P errors and B samples at one pose. In each layout all samples of the first error come
/// first in memory.
enum class Layout {
  one_sample,  ///< shape (P,)
  rows,        ///< shape (P, B) in C order
  columns      ///< shape (B, P) in Fortran order
};

/// A checked array of errors at one pose.
struct ErrorArray {
  const double* data;   ///< [errors x samples] errors, in the caller's memory
  std::size_t samples;  ///< number of samples
  Layout layout;        ///< layout of the errors; the array of their responses must have the same layout
};

/// Checks an array of errors. Throws TypeError unless it is an array of float64. Throws ValueError unless it has one of
/// the layouts. errors: the number of errors, P.
ErrorArray error_array(const pybind11::object& given, std::size_t errors);

/// Checks an array of errors that many poses share. Its layout must be one_sample or rows. Throws as error_array()
/// does.
ErrorArray shared_error_array(const pybind11::object& given, std::size_t errors);

/// Checks an array of errors of shape (poses, errors) in C order; row m has the errors at pose m. Throws as
/// error_array() does.
const double* paired_error_array(const pybind11::object& given, std::size_t poses, std::size_t errors);

/// The array for the responses at one pose: a new one if None is given, otherwise the given one after a check. Throws
/// TypeError unless the given object is an array of float64. Throws ValueError unless it is writable and has the shape
/// and layout that `errors` require. responses: the number of responses.
pybind11::array_t<double> response_array(const pybind11::object& given, std::size_t responses,
                                         const ErrorArray& errors);

/// The array for responses of this shape in C order: a new one if None is given, otherwise the given one after a check.
/// Throws as response_array() does.
pybind11::array_t<double> response_block(const pybind11::object& given, const std::vector<std::size_t>& shape);

/// The memory for statuses of this shape; null if None is given. Throws TypeError unless the given object is an array
/// of uint8. Throws ValueError unless it is writable and has this shape in C order.
SolveStatus* status_array(const pybind11::object& given, const std::vector<std::size_t>& shape);

/// The memory of an array; check_apart() compares it with that of other arrays.
struct Memory {
  const char* name;   ///< name of the array, for messages
  const void* begin;  ///< first byte; null: there is no array
  std::size_t bytes;  ///< number of bytes
};

/// Throws ValueError if two arrays share memory.
void check_apart(std::span<const Memory> arrays);

/// The coordinates of poses, SI, one pose after the other. `given` is an array, or anything that NumPy converts to one.
/// axes: 1 for one pose, an array of shape (C,); 2 for M poses, an array of shape (M, C). Throws TypeError if the
/// conversion fails. Throws ValueError unless the array has this number of axes and C is the number of pose
/// coordinates.
std::vector<double> pose_numbers(const pybind11::object& given, std::size_t axes, const ModelDescription& model);

}  // namespace poesy::python
