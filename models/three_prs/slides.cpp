#include "models/three_prs/slides.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {
namespace {

using Vector3 = lie::Vector3<double>;
using Matrix3 = lie::Matrix3<double>;

constexpr std::size_t kXSlide = kLimbs + 1;
constexpr std::size_t kYSlide = kLimbs + 2;
/// The frames of the slides, numbered after those of the head. Limbs share the numbers of their frames, because limbs
/// are alike; the frames of the two slides have different numbers.
enum Frame : std::size_t { kXTranslation = kFrames, kXRotation, kYTranslation, kYRotation, kSquareness };

struct Entry {
  std::string_view name;
  std::size_t slide;
  std::size_t frame;
  std::string_view axis;  ///< axis of a vector's component; empty for a scalar
  std::string_view symbol;
  std::string_view meaning;
};
/// The slides' errors in the order of SlideSource.
constexpr std::array<Entry, kSlideFactors> kEntries{{
    {"x_position", kXSlide, kXTranslation, "x", "EXX", "positioning error of the X slide along its travel"},
    {"x_straightness_y", kXSlide, kXTranslation, "y", "EYX", "straightness error of the X slide along y"},
    {"x_straightness_z", kXSlide, kXTranslation, "z", "EZX", "straightness error of the X slide along z"},
    {"x_roll", kXSlide, kXRotation, "x", "EAX", "roll of the X slide, about x"},
    {"x_pitch", kXSlide, kXRotation, "y", "EBX", "pitch of the X slide, about y"},
    {"x_yaw", kXSlide, kXRotation, "z", "ECX", "yaw of the X slide, about z"},
    {"y_straightness_x", kYSlide, kYTranslation, "x", "EXY", "straightness error of the Y slide along x"},
    {"y_position", kYSlide, kYTranslation, "y", "EYY", "positioning error of the Y slide along its travel"},
    {"y_straightness_z", kYSlide, kYTranslation, "z", "EZY", "straightness error of the Y slide along z"},
    {"y_pitch", kYSlide, kYRotation, "x", "EAY", "pitch of the Y slide, about x"},
    {"y_roll", kYSlide, kYRotation, "y", "EBY", "roll of the Y slide, about y"},
    {"y_yaw", kYSlide, kYRotation, "z", "ECY", "yaw of the Y slide, about z"},
    {"squareness", kYSlide, kSquareness, "", "C0Y", "squareness error of the Y slide to the X slide, about z"},
}};

Factor factor(const Entry& entry) {
  return {std::string(entry.name),
          entry.frame == kXTranslation || entry.frame == kYTranslation ? Dimension::length : Dimension::angle,
          entry.slide,
          entry.frame,
          std::string(entry.meaning) + " (" + std::string(entry.symbol) + ")",
          std::string(entry.axis)};
}

Vector3 vector(SlideErrors errors, SlideSource source) {
  return Eigen::Map<const Vector3>(errors.data() + static_cast<std::size_t>(source));
}

/// Sets the displacement of a point by a translation, and by a rotation about a centre. arm: from the centre to the
/// point.
void set_point(SlideEffects& effects, int row, SlideSource translation, SlideSource rotation, const Vector3& arm) {
  effects.block<3, 3>(row, static_cast<Eigen::Index>(translation)).setIdentity();
  effects.block<3, 3>(row, static_cast<Eigen::Index>(rotation)) = -lie::hat(arm);
}

}  // namespace

std::vector<Factor> slide_factors() {
  std::vector<Factor> list;
  for (const Entry& entry : kEntries) list.push_back(factor(entry));
  return list;
}

lie::Transform<double> nominal_T_head(double slide_y, SlideErrors errors) {
  const Matrix3 E_x = lie::exp(vector(errors, SlideSource::x_rotation));
  const double squareness = errors[static_cast<std::size_t>(SlideSource::squareness)];
  const Matrix3 along_y = E_x * lie::exp(Vector3(0.0, 0.0, squareness));
  // The displacement of the travel itself, (E_x Rz - I) (0, slide_y, 0), is exactly zero without rotation.
  const Vector3 turned = slide_y * (along_y.col(1) - Vector3::UnitY());
  return {E_x * lie::exp(vector(errors, SlideSource::y_rotation)),
          vector(errors, SlideSource::x_translation) + along_y * vector(errors, SlideSource::y_translation) + turned};
}

SlideEffects slide_effects(double slide_y, const Vector3& P, const Vector3& tip) {
  const Vector3 y_carriage(0.0, slide_y, 0.0);
  SlideEffects effects = SlideEffects::Zero();
  effects.block<3, 3>(kTheta, static_cast<Eigen::Index>(SlideSource::x_rotation)).setIdentity();
  effects.block<3, 3>(kTheta, static_cast<Eigen::Index>(SlideSource::y_rotation)).setIdentity();
  for (const auto& [row, point] : {std::pair(kDr, P), std::pair(kTip, tip)}) {
    set_point(effects, row, SlideSource::x_translation, SlideSource::x_rotation, y_carriage + point);
    set_point(effects, row, SlideSource::y_translation, SlideSource::y_rotation, point);
    effects(row, static_cast<Eigen::Index>(SlideSource::squareness)) = -slide_y;
  }
  return effects;
}

}  // namespace poesy::three_prs
