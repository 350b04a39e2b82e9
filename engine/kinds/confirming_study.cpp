#include "engine/kinds/confirming_study.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "engine/base/text.h"
#include "engine/kinds/registry.h"
#include "engine/result/csv_table.h"
#include "engine/storage/file_writer.h"
#include "engine/study/calibration.h"
#include "engine/study/study_file.h"

namespace poesy {
namespace {

/// The kind of study that judges yields.
const StudyKind& kind_with_yields() {
  return (*std::ranges::find_if(kinds(), [](const Kind* kind) { return kind->study.ask_yield != nullptr; }))->study;
}

/// Whether the study calibrates machines, and a file lists the poses at which they are measured.
bool measures_at_file(const Study& study) {
  const auto& calibration = study.analysis.calibration;
  return calibration != nullptr && calibration->poses && calibration->poses->select == PoseSelection::Select::file;
}

/// Writes points with these coordinates as the table `file` in a folder, with a line for each point.
void write_points(const std::string& folder, const std::string& file, const std::vector<PoseCoordinate>& coordinates,
                  const PoseSet& points) {
  const auto title = [](const PoseCoordinate& named) {
    const std::string unit = " [" + std::string(si_unit(named.dimension)) + "]";
    return named.dimension == Dimension::number ? named.name : named.name + unit;
  };
  CsvTable table{std::filesystem::path(file).stem().string(),
                 {title(coordinates.front()), [&](std::size_t m) { return shortest(points[PoseIndex(m)][0]); }},
                 points.size()};
  for (std::size_t c = 1; c < coordinates.size(); ++c) {
    table.columns.push_back({title(coordinates[c]), [&points, c](std::size_t m) { return points[PoseIndex(m)][c]; }});
  }
  write_csv(folder, table);
}

}  // namespace

Study as_confirming_study(Study study, const std::string& stem) {
  study.analysis.kind = &kind_with_yields();
  study.analysis.asked.reset();
  study.mechanism.compared.reset();
  const bool along_file = study.poses.trajectory && !study.poses.trajectory->file.empty();
  if (along_file) study.poses.select = PoseSelection::Select::file;
  name_files_beside(study, stem);
  return study;
}

void name_files_beside(Study& confirming, const std::string& stem) {
  if (confirming.mechanism.file) confirming.mechanism.file->name = stem + "_mechanism.toml";
  if (confirming.poses.select == PoseSelection::Select::file) confirming.poses.file = stem + "_poses.csv";
  if (!measures_at_file(confirming)) return;
  auto calibration = std::make_shared<CalibrationTable>(*confirming.analysis.calibration);
  calibration->poses->file = stem + "_measured.csv";
  confirming.analysis.calibration = std::move(calibration);
}

std::vector<std::string> files_beside(const Study& confirming) {
  std::vector<std::string> names;
  if (confirming.mechanism.file) names.push_back(confirming.mechanism.file->name);
  if (confirming.poses.select == PoseSelection::Select::file) names.push_back(confirming.poses.file);
  if (measures_at_file(confirming)) names.push_back(confirming.analysis.calibration->poses->file);
  return names;
}

void write_files_beside(const std::string& folder, const Study& confirming, const PoseSet& poses) {
  if (confirming.mechanism.file) {
    const MechanismText& mechanism = *confirming.mechanism.file;
    write_text((std::filesystem::path(folder) / mechanism.name).string(), mechanism.text);
  }
  const ModelDescription& model = confirming.model();
  if (confirming.poses.select == PoseSelection::Select::file) {
    write_points(folder, confirming.poses.file, model.pose_coordinates, poses);
  }
  if (!measures_at_file(confirming)) return;
  const PoseSelection& measured = *confirming.analysis.calibration->poses;
  write_points(folder, measured.file, coordinates(model, measured.from_file.chart), measured.from_file.points);
}

std::string write_confirming_study(const std::string& folder, const std::string& name, const Study& confirming,
                                   const std::string& comment) {
  const std::string path = (std::filesystem::path(folder) / (name + ".toml")).string();
  FileWriter writer(path);
  if (const std::string held = held_errors_text(confirming); !held.empty()) writer.write("# " + held + "\n");
  if (!comment.empty()) writer.write("# " + comment + "\n");
  writer.write(resolved_text(confirming));
  writer.commit();
  return path;
}

}  // namespace poesy
