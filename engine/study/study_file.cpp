#include "engine/study/study_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "engine/base/text.h"
#include "engine/schema/keys_section.h"
#include "engine/study/keys.h"
#include "engine/study/study_kind.h"
#include "engine/study/text_file.h"

namespace poesy {
namespace {

constexpr std::size_t kMostBytes = 1 << 20;
/// Bounds the depth to which dotted keys nest tables, which the TOML library frees by recursion.
constexpr std::size_t kLongestLine = 16384;

/// Whether a file, not a pipe, has the signature of HDF5.
bool begins_like_hdf5(const std::string& path) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::string begin(kSignature.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == kSignature;
}

void check_lines(const std::string& text, const std::string& path) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw InputError({path, 1, 1}, "the study is empty", "'poesy template MODEL' writes one to start from");
  }
  std::size_t line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > kLongestLine) {
      throw InputError({path, line, 1}, "the line is longer than " + std::to_string(kLongestLine) + " bytes",
                       "break it into several lines");
    }
    begin = end + 1;
  }
}

toml::table parse(const std::string& text, const std::string& path) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    std::string reason(error.description());
    constexpr std::string_view kPrefix = "Error while ";
    if (reason.starts_with(kPrefix)) reason.erase(0, kPrefix.size());
    throw InputError({path, error.source().begin.line, error.source().begin.column},
                     "this is not TOML: " + printable(reason, 120),
                     "correct this line; 'poesy template MODEL' shows a complete study");
  }
}

/// Keeps the numbers of cells and solves within what memory and 64-bit counts hold.
void check_size(const StudySection& root, const Study& study) {
  const bool from_file = study.poses.select == PoseSelection::Select::file;
  const double poses = static_cast<double>(from_file ? study.poses.from_file.points.size() : study.poses.count);
  const AtPose asked = study.analysis.kind->at_pose(study);
  if (poses * asked.values > static_cast<double>(kMostCells)) {
    throw InputError(root.section("poses").place(),
                     "poses times " + std::string(asked.of_values) + " is " + shortest(poses * asked.values) +
                         ", but a result holds at most " + std::to_string(kMostCells),
                     "ask for fewer poses or " + std::string(asked.of_values));
  }
  if (poses * asked.solves > static_cast<double>(kMostSolves)) {
    throw InputError(root.section("analysis").place(),
                     "poses times " + std::string(asked.of_solves) + " is " + shortest(poses * asked.solves) +
                         ", but at most " + std::to_string(kMostSolves) + " can be solved",
                     "ask for fewer samples");
  }
}

/// "both" is for kinds that compare fidelities, with a fixed number of samples.
void check_fidelities(const Study& study, const Reading& reading) {
  if (!study.mechanism.compared) return;
  if (!study.analysis.kind->compares_fidelities) {
    const auto other = std::ranges::find_if(reading.kinds.all, &StudyKind::compares_fidelities);
    const std::vector<std::string>& fidelities = study.model().fidelities;
    const StudyValue fidelity = reading.root.section("mechanism").require("fidelity");
    fidelity.fail(
        "is \"both\", but kind = " + in_quotes(study.analysis.kind->name) + " solves at one fidelity",
        "write \"" + fidelities[0] + "\" or \"" + fidelities[1] + "\", or take kind = " + in_quotes((*other)->name));
  }
  if (study.analysis.adaptive) {
    const StudyValue samples = reading.root.section("analysis").require("samples");
    samples.fail(
        "ends at a relative error, but fidelity = \"both\" compares two fidelities on the same samples",
        "write a fixed number, e.g. samples = " + std::to_string(Analysis().samples) + ", or choose one fidelity");
  }
}

Study study_from(const Reading& reading) {
  const StudySection& root = reading.root;
  Study study;
  for (const std::string_view key : {"format", "version"}) {
    read_key(row_of(file_keys(), key), root.require(key), study, reading);
  }
  read_keys(file_keys(), root, study, reading, Extent::partial);
  read_mechanism(study, reading);
  read_solver(study, reading);
  read_poses_section(study, reading);
  read_errors_section(study, reading);
  read_analysis(study, reading);
  read_keys(run_keys(), root.section("run"), study, reading);
  if (reading.use == StudyUse::run) check_fidelities(study, reading);
  check_size(root, study);
  return study;
}

}  // namespace

Study read_study(const std::string& path, const Catalog& catalog, StudyUse use, const StudyKinds& kinds) {
  if (begins_like_hdf5(path)) {
    throw InputError({path}, "is an HDF5 file, such as a result of poesy, and no study", "give its study, a TOML file");
  }
  return study_of_text(read_text(path, "study", kMostBytes), path, catalog, use, kinds);
}

Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use,
                    const StudyKinds& kinds, const std::string* mechanism_text) {
  check_lines(text, path);
  const toml::table table = parse(text, path);
  const StudySection root(table, "", {path, 1, 1}, kinds.tables);
  Study study = study_from({root, catalog, kinds, use, mechanism_text});
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  if (use == StudyUse::run) check_error_bounds(root, study, *model);
  return study;
}

}  // namespace poesy
