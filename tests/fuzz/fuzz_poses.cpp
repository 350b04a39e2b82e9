// Fuzzes tables of poses, of trajectories and of measured machines, which are read for every mechanism.
#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/study/machine_file.h"
#include "engine/study/table_file.h"
#include "models/registry.h"
#include "tests/fuzz/target.h"

namespace {

using namespace poesy;

void check(const PoseTable& table, const ModelDescription& model) {
  fuzz::expect(table.points.size() > 0, "a table has a row");
  const std::size_t width =
      table.chart ? model.charts.at(*table.chart).coordinates.size() : model.pose_coordinates.size();
  for (std::size_t m = 0; m < table.points.size(); ++m) {
    const auto point = table.points[PoseIndex(m)];
    fuzz::expect(point.size() == width, "a row has all coordinates");
    fuzz::expect(std::ranges::all_of(point, [](double x) { return std::isfinite(x); }), "coordinates are finite");
  }
}

void check(const TimedPoints& points, const ModelDescription& model) {
  check(points.table, model);
  fuzz::expect(points.time.size() == points.table.points.size() && points.time.size() > 1, "each row has a time");
  fuzz::expect(std::ranges::is_sorted(points.time, std::less_equal<>()), "times ascend");
}

void check(const MachineFile& file, const ModelDescription& model) {
  check(file.poses, model);
  const std::size_t rows = file.poses.points.size();
  fuzz::expect(!file.values.empty() && file.names.size() == rows, "something was measured, and rows have names");
  for (const MachineValue& value : file.values) {
    fuzz::expect(value.row < rows && value.other < rows, "values belong to rows");
    fuzz::expect(std::isfinite(value.value), "values are finite");
    fuzz::expect(!value.sd || (std::isfinite(*value.sd) && *value.sd >= 0.0), "standard deviations are not below zero");
    const bool is_distance = value.column == MachineColumn::distance;
    fuzz::expect(!is_distance || (value.value > 0.0 && value.row != value.other), "a distance is between two rows");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file({data, size});
  for (const CatalogEntry& entry : registry()) {
    const ModelDescription& model = entry.description;
    fuzz::accepted<InputError>([&] { check(read_poses(file.path(), model), model); });
    fuzz::accepted<InputError>([&] { check(read_trajectory(file.path(), model), model); });
    fuzz::accepted<InputError>([&] { check(read_machine_file(file.path(), model), model); });
  }
  return 0;
}
