#include "models/file/numbers.h"

#include <numbers>

namespace poesy::file {
namespace {

constexpr double kSamePoint = 1e-9;  ///< points count as equal if their distance is below this share of the reach

}  // namespace

double Numbers::quantity(const Expression& expression, const Physical& wanted) const {
  return evaluate(expression, wanted, file_->geometry, values_);
}

double Numbers::positive(const Expression& expression, const Physical& wanted) const {
  const double value = quantity(expression, wanted);
  if (value > 0.0) return value;
  throw InputError(expression.place, expression.key + " '" + expression.text + "' is not greater than 0",
                   "write a value greater than 0");
}

double Numbers::length(const Expression& expression) const {
  return evaluate(expression, Dimension::length, file_->geometry, values_);
}

Value Numbers::value(const Expression& expression) const { return evaluate(expression, file_->geometry, values_); }

Vector3 Numbers::point(const Triple& triple) const {
  return {length(triple.entries[0]), length(triple.entries[1]), length(triple.entries[2])};
}

Vector3 Numbers::vector(const Triple& triple, const Physical& wanted) const {
  return {quantity(triple.entries[0], wanted), quantity(triple.entries[1], wanted),
          quantity(triple.entries[2], wanted)};
}

Vector3 Numbers::direction(const Triple& triple) const {
  Vector3 vector;
  Value first{.any = true};
  for (std::size_t k = 0; k < 3; ++k) {
    const Value value = evaluate(triple.entries[k], file_->geometry, values_);
    if (!value.like(first)) {
      throw InputError(triple.entries[k].place,
                       triple.key + " mixes " + dimension_text(first) + " and " + dimension_text(value),
                       "the entries of a direction must have one dimension");
    }
    if (first.any) first = value;
    vector[static_cast<Eigen::Index>(k)] = value.si;
  }
  const double smallest = kSamePoint * (first.powers.length == 1 ? reach_ : 1.0);
  if (vector.norm() > smallest) return vector.stableNormalized();
  throw InputError(triple.place, triple.key + " is zero and has no direction", "give it a length, e.g. [0, 0, 1]");
}

lie::Matrix3<double> Numbers::axes(const Triple& x_lines, const Triple& z_lines) const {
  const Vector3 x = direction(x_lines);
  const Vector3 z = direction(z_lines);
  if (!parallel(x, z)) return frame_of(perpendicular(x, z), z);
  throw InputError(x_lines.place, x_lines.key + " is parallel to " + z_lines.key, "give another direction");
}

bool Numbers::same(const Vector3& a, const Vector3& b) const { return (a - b).norm() <= kSamePoint * reach_; }

bool parallel(const Vector3& a, const Vector3& b) { return a.cross(b).norm() <= kParallel; }

lie::Matrix3<double> frame_of(const Vector3& x, const Vector3& z) {
  lie::Matrix3<double> R;
  R << x, z.cross(x), z;
  return R;
}

Vector3 perpendicular(const Vector3& direction, const Vector3& z) {
  return (direction - direction.dot(z) * z).normalized();
}

Transform turned(const Copies& copies, std::size_t k) {
  const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(copies.count);
  return lie::rotation<double>(static_cast<lie::Axis>(copies.about), angle);
}

}  // namespace poesy::file
