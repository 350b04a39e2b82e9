#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/model/status.h"

/// Checks of NumPy arrays, which are used in place: an array that does not fit is refused, never converted.
namespace poesy::python {

/// The layout of an array of errors at one pose; in each, all samples of the first error come first.
enum class Layout {
  one_sample,  ///< (P,)
  rows,        ///< (P, B), C order
  columns      ///< (B, P), Fortran order
};

/// The errors at one pose.
struct ErrorArray {
  const double* data;   ///< [P x B]
  std::size_t samples;  ///< B
  Layout layout;        ///< layout of this array, and of the responses
};

/// Throws TypeError unless it is an array of float64, ValueError unless it has one of the layouts for this many errors.
ErrorArray error_array(const pybind11::object& given, std::size_t errors);

/// The same for errors shared by many poses, which are one sample or rows.
ErrorArray shared_error_array(const pybind11::object& given, std::size_t errors);

/// Errors (M, P) in C order; row m belongs to pose m. Throws as error_array().
const double* paired_error_array(const pybind11::object& given, std::size_t poses, std::size_t errors);

/// Responses to errors in this layout: a new array for None, otherwise the given one. Throws TypeError unless it is of
/// float64, ValueError unless it is writable and has that shape and layout.
pybind11::array_t<double> response_array(const pybind11::object& given, std::size_t responses,
                                         const ErrorArray& errors);

/// Responses of this shape in C order; see response_array().
pybind11::array_t<double> response_block(const pybind11::object& given, const std::vector<std::size_t>& shape);

/// The statuses; null for None. Throws TypeError unless it is an array of uint8, ValueError unless it is writable and
/// has this shape in C order.
SolveStatus* status_array(const pybind11::object& given, const std::vector<std::size_t>& shape);

/// The memory of an array.
struct Memory {
  const char* name;   ///< name of the array, for messages
  const void* begin;  ///< null: there is no array
  std::size_t bytes;  ///< length in bytes
};

/// Throws ValueError if two arrays share memory.
void check_apart(std::span<const Memory> arrays);

/// The numbers of a pose (C,), or of poses (M, C) one after the other, from an array or anything that NumPy converts to
/// one. Throws TypeError if it cannot be converted, ValueError unless it has this many axes and the last one has the
/// pose's coordinates.
std::vector<double> pose_numbers(const pybind11::object& given, std::size_t axes, const ModelDescription& model);

}  // namespace poesy::python
