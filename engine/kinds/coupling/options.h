#pragma once

#include <string>
#include <vector>

#include "engine/study/study.h"

namespace poesy {

/// A group of errors that is judged as one.
struct ErrorSource {
  std::string name;                  ///< stands in tables, joined to others by '+'
  std::vector<FactorIndex> factors;  ///< as the study names them, whatever the pattern leaves of them
};

/// Which errors of a source have its size, and which of these move together.
struct ErrorPattern {
  /// How far a choice of limbs or components goes.
  enum class Choice {
    all,         ///< every one, together
    some,        ///< those that are named, together
    independent  ///< every one, each on its own
  };

  Choice limbs = Choice::all;       ///< which limbs' errors have the size
  std::size_t limb = 0;             ///< for some: it alone; counts from 1
  Choice components = Choice::all;  ///< which components of an error have it
  std::vector<std::string> axes;    ///< for some: "x", "y", "z"; scalars are kept besides
};

/// What a coupling study asks for. See engine/kinds/coupling/coupling.h.
struct CouplingStudy {
  std::vector<double> linear;        ///< [Z] m, sizes of the runs; empty where no error is a length
  std::vector<double> angular;       ///< [Z] rad; empty where no error is an angle
  ErrorPattern pattern;              ///< of every source
  std::vector<ErrorSource> sources;  ///< no factor in two of them

  /// Z.
  std::size_t sizes() const { return linear.empty() ? angular.size() : linear.size(); }
};

/// The kind of study of error sources of fixed size, one by one and together.
extern const StudyKind kCouplingStudy;

}  // namespace poesy
