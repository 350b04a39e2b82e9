#pragma once

#include <string>
#include <variant>
#include <vector>

#include "engine/study/study.h"

namespace poesy::python {

/// The options of an evaluator in Python, in the words of study files.
struct Request {
  std::string mechanism = {};       ///< a name of the catalog, or a mechanism's file
  std::string metric = "platform";  ///< ignored if nothing is weighed
  std::string fidelity = "exact";   ///< ignored if there is no choice
  std::variant<std::string, std::vector<std::string>> factors = "all";  ///< a factor set, or names in any order
  bool calibrated = false;                                              ///< see [analysis] of study files
};

/// The study with the mechanism, the solver and the varied errors of the request; its other parts are unused. Throws
/// InputError or FileError as reading a study file does, without a place in it.
Study study_of(const Request& request);

}  // namespace poesy::python
