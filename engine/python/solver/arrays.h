#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/model/status.h"

/// NumPy arrays, used where they stand: what does not fit is refused, never converted.
namespace poesy::python {

/// How an array of errors of one pose lies in memory; either way all samples of the first error come first.
enum class Layout {
  one_sample,  ///< (P,)
  rows,        ///< (P, B), C order
  columns      ///< (B, P), Fortran order
};

/// Errors of one pose.
struct ErrorArray {
  const double* data;   ///< [P x B]
  std::size_t samples;  ///< B
  Layout layout;        ///< of this array, and so of the responses to it
};

/// Throws TypeError unless it is an array of float64, ValueError unless it has one of the layouts for so many errors.
ErrorArray error_array(const pybind11::object& given, std::size_t errors);

/// The same for errors that many poses have, which come one sample or in rows.
ErrorArray shared_error_array(const pybind11::object& given, std::size_t errors);

/// Errors (M, P) in C order, row m those of pose m. Throws as error_array.
const double* paired_error_array(const pybind11::object& given, std::size_t poses, std::size_t errors);

/// Responses to errors in this layout: a new array for None, else the given one. Throws TypeError unless it is of
/// float64, ValueError unless it can be written and has that shape and layout.
pybind11::array_t<double> response_array(const pybind11::object& given, std::size_t responses,
                                         const ErrorArray& errors);

/// As response_array, of this shape in C order.
pybind11::array_t<double> response_block(const pybind11::object& given, const std::vector<std::size_t>& shape);

/// Null for None. Throws TypeError unless it is an array of uint8, ValueError unless it can be written and has this
/// shape in C order.
SolveStatus* status_array(const pybind11::object& given, const std::vector<std::size_t>& shape);

/// Where an array stands.
struct Memory {
  const char* name;   ///< of the array, for messages
  const void* begin;  ///< null: there is none
  std::size_t bytes;  ///< from there on
};

/// Throws ValueError where two arrays share memory.
void check_apart(std::span<const Memory> arrays);

/// The numbers of a pose (C,), or of poses (M, C) one behind the other: of an array, or of anything of which NumPy
/// makes one. Throws TypeError for what it cannot, ValueError unless there are so many axes and the last one has the
/// pose's coordinates.
std::vector<double> pose_numbers(const pybind11::object& given, std::size_t axes, const ModelDescription& model);

}  // namespace poesy::python
