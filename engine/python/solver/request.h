#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "engine/study/study.h"

namespace poesy::python {

/// A value of a geometry parameter: a number in SI, or a text with a unit ("260 mm").
using GeometryValue = std::variant<double, std::string>;

/// The options of an evaluator in Python. Names and values are those of study files.
struct Request {
  std::string mechanism = {};  ///< name of the catalog, or path of a mechanism file
  /// The metric. If the mechanism does not weigh angles against lengths, the default has no effect, and another value
  /// is refused.
  std::string metric = "platform";
  /// The fidelity with which the mechanism is solved. If the mechanism offers no choice, the default has no effect, and
  /// another value is refused.
  std::string fidelity = "exact";
  /// Errors that vary: a factor set, or names of errors in any order.
  std::variant<std::string, std::vector<std::string>> factors = "all";
  /// True if responses are those after the best correction of the actuators; see [analysis] of study files.
  bool calibrated = false;
  /// Geometry parameters whose values differ from the mechanism's own.
  std::map<std::string, GeometryValue> geometry = {};
};

/// Makes a study with the mechanism, the solver settings and the varied errors of the request; its other members keep
/// their defaults. Throws InputError and FileError as reading a study file does, but without a place in the file.
Study study_of(const Request& request);

}  // namespace poesy::python
