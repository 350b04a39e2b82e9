#pragma once

#include <string>
#include <variant>
#include <vector>

#include "engine/study/study.h"

namespace poesy::python {

/// What a caller in Python asks an evaluator for, in the words of study files.
struct Request {
  std::string mechanism = {};       ///< a name of the catalog, or a mechanism's file
  std::string metric = "platform";  ///< passed over where nothing is weighed
  std::string fidelity = "exact";   ///< passed over where there is no choice
  std::variant<std::string, std::vector<std::string>> factors = "all";  ///< a factor set, or names in any order
  bool calibrated = false;                                              ///< as in [analysis]
};

/// The study that says the same: its mechanism, its solver and the errors that vary; nothing else of it is of use.
/// Throws InputError or FileError as reading a study file does, without a place in it.
Study study_of(const Request& request);

}  // namespace poesy::python
