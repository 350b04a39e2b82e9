#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "engine/base/error.h"
#include "models/file/expression.h"

/// The values of which tables of a mechanism file consist, as written.
namespace poesy::file {

/// A name that refers to something else, and its place in the file.
struct Reference {
  std::string name;  ///< as written
  std::string key;   ///< for messages: "limb[0].joints[1].from"
  Place place;       ///< of the value in the file
};

/// A point, a direction or another vector, as written.
struct Triple {
  std::array<Expression, 3> entries;  ///< x, y, z
  std::string key;                    ///< for messages
  Place place;                        ///< of the value in the file
};

/// A point with a name.
struct NamedPoint {
  std::string name;  ///< as references write it
  Triple point;      ///< in the base frame, at home
};

/// Copies of something, turned about an axis of the base.
struct Copies {
  std::size_t count = 1;  ///< number, at least 1
  std::size_t about = 2;  ///< axis of the base: 0, 1, 2

  bool operator==(const Copies&) const = default;  ///< Whether copies match one by one.
};

}  // namespace poesy::file
