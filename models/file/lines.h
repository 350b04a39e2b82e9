#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "engine/base/error.h"
#include "models/file/expression.h"

/// What tables of a mechanism file are made of, as it is written.
namespace poesy::file {

/// A name that stands for something else, and where it is written.
struct Reference {
  std::string name;  ///< as written
  std::string key;   ///< for messages: "limb[0].joints[1].from"
  Place place;       ///< of the value
};

/// A point or a direction, or another vector.
struct Triple {
  std::array<Expression, 3> entries;  ///< x, y, z
  std::string key;                    ///< for messages
  Place place;                        ///< of the value
};

/// A point with a name.
struct NamedPoint {
  std::string name;  ///< as references have it
  Triple point;      ///< in the base frame, at home
};

/// How many there are of something, and about which axis of the base they are turned.
struct Copies {
  std::size_t count = 1;  ///< at least 1
  std::size_t about = 2;  ///< base axis: 0, 1, 2

  bool operator==(const Copies&) const = default;  ///< Whether copies go with each other.
};

}  // namespace poesy::file
