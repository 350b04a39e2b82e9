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

/// A text as a parameter of a template.
template <std::size_t kSize>
struct AxisName {
  /// Of a literal.
  constexpr AxisName(const char (&literal)[kSize]) { std::ranges::copy(literal, text); }  // NOLINT: implicit

  char text[kSize]{};  ///< its characters and a zero
};

/// An axis, as result files name it. Axes of one name are the same axis.
template <AxisName kText>
struct Axis {
  static constexpr std::string_view kName{kText.text, sizeof(kText.text) - 1};  ///< Its name.
};

/// A type that names an axis.
template <class T>
concept NamedAxis = requires {
  { T::kName } -> std::convertible_to<std::string_view>;
};

// The axes that many arrays have. A kind of study adds its own in the same way.
namespace axis {
using Response = Axis<"response">;    ///< Responses of the model.
using Factor = Axis<"factor">;        ///< Errors of the study.
using Pose = Axis<"pose">;            ///< Poses of the study.
using Sample = Axis<"sample">;        ///< Samples at a pose.
using Component = Axis<"component">;  ///< Components of a vector.
using Joint = Axis<"joint">;          ///< Joints that have a displacement.
}  // namespace axis

/// Lengths of axes, the slowest first, and where an element lies (row-major).
template <NamedAxis... Axes>
class AxisLayout {
 public:
  static constexpr std::size_t kAxes = sizeof...(Axes);  ///< Number of axes.
  using Lengths = std::array<std::size_t, kAxes>;        ///< Of each axis.
  static_assert(kAxes > 0, "a single value needs no array");

  AxisLayout() = default;
  explicit AxisLayout(const Lengths& lengths) : lengths_(lengths) {}  ///< Of these lengths.

  /// Names of the axes, as files have them.
  static std::vector<std::string> axis_names() { return {std::string(Axes::kName)...}; }

  const Lengths& lengths() const { return lengths_; }  ///< Of all axes.
  /// Number of elements.
  std::size_t elements() const { return product(lengths_); }
  /// Positions of the element at this place, on each axis.
  Lengths positions(std::size_t place) const {
    Lengths at{};
    for (std::size_t k = kAxes; k-- > 0; place /= lengths_[k]) at[k] = place % lengths_[k];
    return at;
  }
  /// Positions along this axis, the first of that name.
  template <NamedAxis A>
  std::size_t length() const {
    constexpr std::array<bool, kAxes> kIsIt{std::same_as<A, Axes>...};
    constexpr auto kPlace = static_cast<std::size_t>(std::ranges::find(kIsIt, true) - kIsIt.begin());
    static_assert(kPlace < kAxes, "the array has no such axis");
    return lengths_[kPlace];
  }

 protected:
  /// Where the elements at these positions on the first axes begin, and how many they are.
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
  /// Of lengths.
  static std::size_t product(std::span<const std::size_t> lengths) {
    return std::accumulate(lengths.begin(), lengths.end(), std::size_t{1}, std::multiplies());
  }

  Lengths lengths_{};  ///< Of all axes.
};

/// Elements that are elsewhere, along axes that have names. See Array.
template <class T, NamedAxis... Axes>
class ArrayView : public AxisLayout<Axes...> {
 public:
  using Layout = AxisLayout<Axes...>;        ///< Of its axes.
  using Lengths = typename Layout::Lengths;  ///< Of each axis.

  /// Refers to the elements. Precondition: as many as the lengths say.
  ArrayView(std::span<T> elements, const Lengths& lengths) : Layout(lengths), elements_(elements) {
    POESY_EXPECTS(elements.size() == Layout::product(lengths));
  }

  /// The element at these positions, one for each axis.
  template <std::integral... Positions>
  T& operator()(Positions... at) const {
    static_assert(sizeof...(Positions) == Layout::kAxes, "a position is needed for each axis");
    return elements_[Layout::part(at...).first];
  }
  /// The elements at these positions on the first axes, row-major along the others.
  template <std::integral... Positions>
  std::span<T> row(Positions... at) const {
    const auto [first, count] = Layout::part(at...);
    return elements_.subspan(first, count);
  }

 private:
  std::span<T> elements_;
};

/// Elements along axes that have names, the slowest axis first (row-major). The type says the axes, so nothing else has
/// to: `Array<double, axis::Response, axis::Pose> mean` is asked as `mean(r, m)`, and `mean.row(r)` is what a response
/// has at all poses. A default array has no elements.
template <class T, NamedAxis... Axes>
class Array : public AxisLayout<Axes...> {
 public:
  using Element = T;                         ///< What it holds.
  using Layout = AxisLayout<Axes...>;        ///< Of its axes.
  using Lengths = typename Layout::Lengths;  ///< Of each axis.

  Array() = default;
  /// Of these lengths, all elements equal.
  explicit Array(const Lengths& lengths, const T& element = T())
      : Layout(lengths), elements_(Layout::product(lengths), element) {}
  /// Of these lengths. Precondition: as many elements, row-major.
  Array(const Lengths& lengths, std::vector<T> elements) : Layout(lengths), elements_(std::move(elements)) {
    POESY_EXPECTS(elements_.size() == Layout::product(lengths));
  }

  std::size_t size() const { return elements_.size(); }  ///< Number of elements.
  bool empty() const { return elements_.empty(); }       ///< Whether there are none.

  /// The element at these positions, one for each axis.
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

  /// The elements at these positions on the first axes, row-major along the others.
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

  /// Equal lengths and elements.
  bool operator==(const Array& other) const { return this->lengths_ == other.lengths_ && elements_ == other.elements_; }

 private:
  template <class... Positions>
  std::size_t place(Positions... at) const {
    static_assert(sizeof...(Positions) == Layout::kAxes, "a position is needed for each axis");
    return Layout::part(at...).first;
  }

  std::vector<T> elements_;
};

/// Gives arrays along the same axes these lengths; all elements are then as constructed.
template <class First, class... Others>
void make_room(const typename First::Lengths& lengths, First& first, Others&... others) {
  first = First(lengths);
  ((others = Others(lengths)), ...);
}

}  // namespace poesy
