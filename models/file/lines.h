#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "engine/base/error.h"
#include "models/file/expression.h"

/// Types of values, as written, that several tables of a mechanism file contain.
namespace poesy::file {

/// A name that refers to something else in the file.
struct Reference {
  std::string name;  ///< name as written
  std::string key;   ///< key in the file, for messages: "limb[0].joints[1].from"
  Place place;       ///< place of the value in the file
};

/// A point, a direction or another vector, as written.
struct Triple {
  std::array<Expression, 3> entries;  ///< entries x, y, z
  std::string key;                    ///< key in the file, for messages
  Place place;                        ///< place of the value in the file
};

/// A point that has a name.
struct NamedPoint {
  std::string name;  ///< name by which references refer to it
  Triple point;      ///< coordinates in the base frame at home; of a point of the platform, in the platform's frame
};

/// Copies of a limb or a body, rotated about an axis of the base.
struct Copies {
  std::size_t count = 1;  ///< number of copies including the first, at least 1
  std::size_t about = 2;  ///< axis of the base about which copies are rotated: 0, 1, 2 for x, y, z

  /// Returns true if both have the same number of copies about the same axis.
  bool operator==(const Copies&) const = default;
};

}  // namespace poesy::file
