#include "engine/report/frames_table.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/base/units.h"
#include "engine/report/display.h"
#include "engine/report/sketch_words.h"

namespace poesy {
namespace {

constexpr double kMillimetres = 1e3;  // millimetres in a metre
constexpr int kDigits = 6;
constexpr double kNothing = 5e-7;  // mm; smaller numbers are shown as 0

Cell number(double value) { return {number_text(std::abs(value) < kNothing ? 0.0 : value, kDigits), value}; }

void add_vector(std::vector<Cell>& row, const SketchVector& vector, double scale = 1.0) {
  for (const double component : vector) row.push_back(number(scale * component));
}

std::string frame_name(const Sketch& sketch, std::size_t limb, std::size_t frame) {
  const std::vector<SketchedJoint>& joints = sketch.limbs[limb];
  if (frame == 0) return "the base";
  if (frame + 1 == sketch.frames[limb].size()) return "the platform";
  std::size_t joint = 0;
  while (joint < joints.size() && joints[joint].first <= frame) ++joint;
  return joint_words(sketch, limb, joint);
}

/// The first cells of a row: pose, limb, and the frame or joint that the row describes. limb: counted from 0, and shown
/// from 1.
std::vector<Cell> begin_row(std::size_t pose, std::size_t limb, const char* what, std::size_t number,
                            const std::string& name) {
  return {count_cell(pose), count_cell(limb + 1), text_cell(what), count_cell(number), text_cell(name)};
}

void add_limb(Table& table, const Sketch& sketch, std::size_t pose, std::size_t limb) {
  for (std::size_t f = 0; f < sketch.frames[limb].size(); ++f) {
    const SketchedFrame& frame = sketch.frames[limb][f];
    std::vector<Cell> row = begin_row(pose, limb, "frame", f, frame_name(sketch, limb, f));
    add_vector(row, frame.origin, kMillimetres);
    for (const SketchVector& axis : frame.axes) add_vector(row, axis);
    table.rows.push_back(std::move(row));
  }
  for (std::size_t j = 0; j < sketch.limbs[limb].size(); ++j) {
    const SketchedJoint& joint = sketch.limbs[limb][j];
    std::vector<Cell> row = begin_row(pose, limb, "joint", j + 1, joint_words(sketch, limb, j + 1));
    add_vector(row, joint.point, kMillimetres);
    row.insert(row.end(), 6, Cell{"-", std::nullopt});
    add_vector(row, joint.axis);
    table.rows.push_back(std::move(row));
  }
}

}  // namespace

std::optional<Table> frames_table(const Model& model, const PoseSet& poses) {
  Table table{.name = "frames",
              .caption = "Joints and frames without errors, in the base frame",
              .columns = {number_column("pose", "pose"), number_column("limb", "limb"), text_column("what", "what"),
                          number_column("number", "number"), text_column("name", "name")},
              .notes = {"a frame is that of a joint's axis after the joint has moved, frame 0 the base's, the last the "
                        "platform's; a joint stands where it is before it moves, z is its first axis"}};
  for (const char axis : {'x', 'y', 'z'}) table.columns.push_back(number_column(std::string(1, axis), {axis}, "mm"));
  for (const char axis : {'x', 'y', 'z'}) {
    for (const char component : {'x', 'y', 'z'}) {
      table.columns.push_back(number_column({axis, '_', component}, {axis, '_', component}));
    }
  }
  for (std::size_t m = 0; m < poses.size(); ++m) {
    const std::optional<Sketch> sketch = model.sketch(poses[PoseIndex(m)]);
    if (!sketch) return std::nullopt;
    for (std::size_t i = 0; i < sketch->limbs.size(); ++i) add_limb(table, *sketch, m, i);
  }
  return table;
}

static std::string number_text(const Cell& cell) {
  if (cell.whole) return std::to_string(*cell.whole);
  return cell.value ? shortest(*cell.value) : "NaN";
}

std::string csv_of(const Table& table) {
  std::string text;
  for (const Column& column : table.columns) {
    text += fmt::format("{}{}{}", text.empty() ? "" : ",", column.name,
                        column.unit.empty() ? "" : " [" + column.unit + "]");
  }
  text += "\n";
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool is_number = table.columns[c].kind == Column::Kind::number;
      text += c == 0 ? "" : ",";
      text += is_number ? number_text(row[c]) : row[c].text;
    }
    text += "\n";
  }
  return text;
}

}  // namespace poesy
