#include "engine/kinds/confirming_study.h"

#include <algorithm>
#include <filesystem>

#include "engine/base/text.h"
#include "engine/kinds/registry.h"
#include "engine/result/csv_table.h"
#include "engine/storage/file_writer.h"
#include "engine/study/study_file.h"

namespace poesy {
namespace {

/// The kind of study that judges a yield.
const StudyKind& kind_with_yields() {
  return (*std::ranges::find_if(kinds(), [](const Kind* kind) { return kind->study.ask_yield != nullptr; }))->study;
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
}

void write_files_beside(const std::string& folder, const Study& confirming, const PoseSet& poses) {
  if (confirming.mechanism.file) {
    const MechanismText& mechanism = *confirming.mechanism.file;
    write_text((std::filesystem::path(folder) / mechanism.name).string(), mechanism.text);
  }
  if (confirming.poses.select != PoseSelection::Select::file) return;
  const std::vector<PoseCoordinate>& coordinates = confirming.model().pose_coordinates;
  const auto title = [](const PoseCoordinate& named) {
    const std::string unit = " [" + std::string(si_unit(named.dimension)) + "]";
    return named.dimension == Dimension::number ? named.name : named.name + unit;
  };
  const auto coordinate = [&](std::size_t m, std::size_t c) { return poses[PoseIndex(m)][c]; };
  CsvTable table{std::filesystem::path(confirming.poses.file).stem().string(),
                 {title(coordinates.front()), [&](std::size_t m) { return shortest(coordinate(m, 0)); }},
                 poses.size()};
  for (std::size_t c = 1; c < coordinates.size(); ++c) {
    table.columns.push_back({title(coordinates[c]), [&coordinate, c](std::size_t m) { return coordinate(m, c); }});
  }
  write_csv(folder, table);
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
