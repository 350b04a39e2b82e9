#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/io/h5.h"

namespace poesy {

/// What a dataset says about itself.
struct Label {
  std::string unit;         ///< "m", "rad,rad,rad,m,m,m" where components differ, or "1"
  std::string description;  ///< a sentence for people
};

/// Composes an HDF5 file in memory in which every dataset has a unit, a description and named axes.
class ResultBuilder {
 public:
  ResultBuilder() : file_(h5::File::in_memory()) {}

  /// For groups and attributes.
  h5::File& file() { return file_; }

  /// Adds the axis `name`: the dimension scale /name, one value for each position.
  template <h5::Element T>
  void add_axis(const std::string& name, const std::vector<T>& values, const Label& label);
  /// Adds the dataset at path along these axes. Its shape is their lengths: none for a scalar.
  template <h5::Element T>
  void add(const std::string& path, const std::vector<std::string>& axes, std::span<const T> values,
           const Label& label);
  /// A dataset with one axis for each of its dimensions. Precondition: the axes were added.
  template <h5::Element T>
  void add(const std::string& path, const std::vector<std::string>& axes, const std::vector<T>& values,
           const Label& label) {
    add(path, axes, std::span<const T>(values), label);
  }
  /// A single value.
  template <h5::Element T>
  void add_scalar(const std::string& path, const T& value, const Label& label) {
    add(path, {}, std::span<const T>(&value, 1), label);
  }
  /// Lets the group's readers find these axes in the group itself: xarray opens one group at a time.
  void show_axes(const std::string& group, const std::vector<std::string>& axes);

 private:
  h5::File file_;
  std::map<std::string, std::size_t> axis_length_;
};

}  // namespace poesy
