#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <functional>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/contract.h"

namespace poesy {

/// The name of an axis, in a form that can be an argument of a template.
template <std::size_t kSize>
struct AxisName {
  /// Copies a string literal.
  constexpr AxisName(const char (&literal)[kSize]) { std::ranges::copy(literal, text); }  // NOLINT: implicit

  char text[kSize]{};  ///< characters of the text and a final zero
};

/// An axis of an array with its name, which is also its name in result files. Axes with the same name are the same
/// axis.
template <AxisName kText>
struct Axis {
  /// The name of the axis in result files.
  static constexpr std::string_view kName{kText.text, sizeof(kText.text) - 1};
};

/// A type with a member kName, which names an axis.
template <class T>
concept NamedAxis = requires {
  { T::kName } -> std::convertible_to<std::string_view>;
};

// The axes of most arrays. A kind of study defines further axes in the same way.
namespace axis {
using Response = Axis<"response">;    ///< Responses of the model.
using Factor = Axis<"factor">;        ///< Errors of the study.
using Pose = Axis<"pose">;            ///< Poses of the study.
using Sample = Axis<"sample">;        ///< Samples at a pose.
using Component = Axis<"component">;  ///< Components of a vector.
using Joint = Axis<"joint">;          ///< Joints that have a displacement.
}  // namespace axis

/// The lengths of the axes of an array, and the order of its elements. Elements are row-major: the last axis varies
/// fastest.
template <NamedAxis... Axes>
class AxisLayout {
 public:
  static constexpr std::size_t kAxes = sizeof...(Axes);  ///< Number of axes.
  using Lengths = std::array<std::size_t, kAxes>;        ///< The length of each axis.
  static_assert(kAxes > 0, "a single value needs no array");

  AxisLayout() = default;
  explicit AxisLayout(const Lengths& lengths) : lengths_(lengths) {}  ///< The layout with these lengths.

  /// The names of the axes in files.
  static std::vector<std::string> axis_names() { return {std::string(Axes::kName)...}; }

  const Lengths& lengths() const { return lengths_; }  ///< The lengths of all axes.
  /// The number of elements.
  std::size_t elements() const { return product(lengths_); }
  /// The index on each axis of the element whose row-major index is `place`.
  Lengths positions(std::size_t place) const {
    Lengths at{};
    for (std::size_t k = kAxes; k-- > 0; place /= lengths_[k]) at[k] = place % lengths_[k];
    return at;
  }
  /// The length of the first axis of this name.
  template <NamedAxis A>
  std::size_t length() const {
    constexpr std::array<bool, kAxes> kIsIt{std::same_as<A, Axes>...};
    constexpr auto kPlace = static_cast<std::size_t>(std::ranges::find(kIsIt, true) - kIsIt.begin());
    static_assert(kPlace < kAxes, "the array has no such axis");
    return lengths_[kPlace];
  }

 protected:
  /// The elements at these indices on the first axes are consecutive. Returns the row-major index of the first of them,
  /// and their number.
  template <std::integral... Positions>
  std::pair<std::size_t, std::size_t> part(Positions... positions) const {
    constexpr std::size_t kFixed = sizeof...(Positions);
    static_assert(kFixed <= kAxes, "more positions than axes");
    const std::array<std::size_t, kFixed> at{static_cast<std::size_t>(positions)...};
    std::size_t place = 0;
    for (std::size_t k = 0; k < kFixed; ++k) {
      POESY_EXPECTS(at[k] < lengths_[k]);
      place = place * lengths_[k] + at[k];
    }
    const std::size_t count = product(std::span(lengths_).subspan(kFixed));
    return {place * count, count};
  }
  /// The product of the lengths of axes.
  static std::size_t product(std::span<const std::size_t> lengths) {
    return std::accumulate(lengths.begin(), lengths.end(), std::size_t{1}, std::multiplies());
  }

  Lengths lengths_{};  ///< lengths of all axes
};

/// A view of elements along named axes. See Array.
template <class T, NamedAxis... Axes>
class ArrayView : public AxisLayout<Axes...> {
 public:
  using Layout = AxisLayout<Axes...>;        ///< The layout of its axes.
  using Lengths = typename Layout::Lengths;  ///< The length of each axis.

  /// A view of these elements. Precondition: their number is the product of the lengths.
  ArrayView(std::span<T> elements, const Lengths& lengths) : Layout(lengths), elements_(elements) {
    POESY_EXPECTS(elements.size() == Layout::product(lengths));
  }

  /// The element at these indices, one for each axis.
  template <std::integral... Positions>
  T& operator()(Positions... at) const {
    static_assert(sizeof...(Positions) == Layout::kAxes, "a position is needed for each axis");
    return elements_[Layout::part(at...).first];
  }
  /// The elements at these indices on the first axes, row-major along the others.
  template <std::integral... Positions>
  std::span<T> row(Positions... at) const {
    const auto [first, count] = Layout::part(at...);
    return elements_.subspan(first, count);
  }

 private:
  std::span<T> elements_;
};

/// Elements along named axes, the slowest axis first (row-major). The type states the axes: for `Array<double,
/// axis::Response, axis::Pose> mean`, an element is `mean(r, m)`, and `mean.row(r)` has the elements of one response at
/// all poses. A default-constructed array has no elements.
template <class T, NamedAxis... Axes>
class Array : public AxisLayout<Axes...> {
 public:
  using Element = T;                         ///< The type of its elements.
  using Layout = AxisLayout<Axes...>;        ///< The layout of its axes.
  using Lengths = typename Layout::Lengths;  ///< The length of each axis.

  Array() = default;
  /// An array with these lengths, all elements equal.
  explicit Array(const Lengths& lengths, const T& element = T())
      : Layout(lengths), elements_(Layout::product(lengths), element) {}
  /// An array with these lengths and elements, row-major. Precondition: the number of elements is the product of the
  /// lengths.
  Array(const Lengths& lengths, std::vector<T> elements) : Layout(lengths), elements_(std::move(elements)) {
    POESY_EXPECTS(elements_.size() == Layout::product(lengths));
  }

  std::size_t size() const { return elements_.size(); }  ///< The number of elements.
  bool empty() const { return elements_.empty(); }       ///< Returns true if there are no elements.

  /// The element at these indices, one for each axis.
  /// @{
  template <std::integral... Positions>
  T& operator()(Positions... at) {
    return elements_[place(at...)];
  }
  template <std::integral... Positions>
  const T& operator()(Positions... at) const {
    return elements_[place(at...)];
  }
  /// @}

  /// The elements at these indices on the first axes, row-major along the others.
  /// @{
  template <std::integral... Positions>
  std::span<T> row(Positions... at) {
    const auto [first, count] = Layout::part(at...);
    return std::span(elements_).subspan(first, count);
  }
  template <std::integral... Positions>
  std::span<const T> row(Positions... at) const {
    const auto [first, count] = Layout::part(at...);
    return std::span(elements_).subspan(first, count);
  }
  /// @}

  /// All elements, row-major.
  /// @{
  std::span<T> all() { return elements_; }
  std::span<const T> all() const { return elements_; }
  auto begin() { return elements_.begin(); }
  auto end() { return elements_.end(); }
  auto begin() const { return elements_.begin(); }
  auto end() const { return elements_.end(); }
  /// @}

  /// Returns true if lengths and elements are equal.
  bool operator==(const Array& other) const { return this->lengths_ == other.lengths_ && elements_ == other.elements_; }

 private:
  template <class... Positions>
  std::size_t place(Positions... at) const {
    static_assert(sizeof...(Positions) == Layout::kAxes, "a position is needed for each axis");
    return Layout::part(at...).first;
  }

  std::vector<T> elements_;
};

/// Replaces several arrays with the same axes by arrays of these lengths, with default-constructed elements.
template <class First, class... Others>
void make_room(const typename First::Lengths& lengths, First& first, Others&... others) {
  first = First(lengths);
  ((others = Others(lengths)), ...);
}

}  // namespace poesy
