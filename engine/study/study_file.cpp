#include "engine/study/study_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "engine/base/text.h"
#include "engine/study/keys.h"
#include "engine/study/text_file.h"
#include "engine/schema/keys_section.h"

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

/// What a study asks for at each pose, and what these numbers are the product of.
struct AtPose {
  double values;  ///< of one response that the result keeps
  std::string_view of_values;
  double solves;
  std::string_view of_solves;
};

AtPose at_pose(const Study& study) {
  const Analysis& analysis = study.analysis;
  const double factors = static_cast<double>(analysis.factors.size());
  const double samples = static_cast<double>(analysis.samples);
  const double tried = factors * static_cast<double>(analysis.groups.size());
  const double cases = static_cast<double>(analysis.cases.size());
  switch (analysis.kind) {
    case Analysis::Kind::sensitivity:
      if (study.mechanism.compared) {
        return {factors, "factors", 2.0 * factors * samples, "factors times samples times two fidelities"};
      }
      return {factors, "factors", factors * samples, "factors times samples"};
    case Analysis::Kind::identification:
      return {tried, "factors times groups", tried, "factors times groups"};
    case Analysis::Kind::evaluate:
      return {cases, "cases", cases, "cases"};
    case Analysis::Kind::monte_carlo:
      return {static_cast<double>(analysis.quantiles.size()), "quantiles", samples, "samples"};
    case Analysis::Kind::coupling:
      break;
  }
  const std::size_t rows = coupling_rows(analysis.coupling, study.model()).errors.size();
  const auto sets = static_cast<double>(analysis.coupling.sizes() * rows);
  return {sets, "sizes times sets of sources", sets, "sizes times sets of sources"};
}

/// Keeps the numbers of cells and solves within what memory and 64-bit counts hold.
void check_size(const StudySection& root, const Study& study) {
  const bool from_file = study.poses.select == PoseSelection::Select::file;
  const double poses = static_cast<double>(from_file ? study.poses.from_file.points.size() : study.poses.count);
  const AtPose asked = at_pose(study);
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

/// "both" is for sensitivity studies with a fixed number of samples, and `linearity` for those with "both".
void check_fidelities(const StudySection& root, const Study& study) {
  if (!study.mechanism.compared) {
    root.section("analysis").refuse("linearity", "a study without fidelity = \"both\"");
  } else if (study.analysis.kind != Analysis::Kind::sensitivity) {
    const std::vector<std::string>& fidelities = study.model().fidelities;
    const StudyValue fidelity = root.section("mechanism").require("fidelity");
    fidelity.fail("is \"both\", but kind = \"" + std::string(name(study.analysis.kind)) + "\" solves at one fidelity",
                  "write \"" + fidelities[0] + "\" or \"" + fidelities[1] + "\", or take kind = \"sensitivity\"");
  } else if (study.analysis.adaptive) {
    const StudyValue samples = root.section("analysis").require("samples");
    samples.fail(
        "ends at a relative error, but fidelity = \"both\" compares two fidelities on the same samples",
        "write a fixed number, e.g. samples = " + std::to_string(Analysis().samples) + ", or choose one fidelity");
  }
}

Study study_from(const StudySection& root, const Catalog& catalog, StudyUse use) {
  const Reading reading{root, catalog, use};
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
  if (use == StudyUse::run) check_fidelities(root, study);
  check_size(root, study);
  return study;
}

}  // namespace

const StudyTables& study_tables() {
  static const StudyTables tables = [] {
    StudyTables all{described(file_keys())};
    for (const StudyTables& more : {mechanism_tables(), poses_tables(), errors_tables(), analysis_tables(),
                                    StudyTables{described(solver_keys()), described(run_keys())}}) {
      all.insert(all.end(), more.begin(), more.end());
    }
    return all;
  }();
  return tables;
}

Study read_study(const std::string& path, const Catalog& catalog, StudyUse use) {
  if (begins_like_hdf5(path)) {
    throw InputError({path}, "is an HDF5 file, such as a result of poesy, and no study", "give its study, a TOML file");
  }
  return study_of_text(read_text(path, "study", kMostBytes), path, catalog, use);
}

Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use) {
  check_lines(text, path);
  const toml::table table = parse(text, path);
  const StudySection root(table, "", {path, 1, 1}, study_tables());
  Study study = study_from(root, catalog, use);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  if (use == StudyUse::run) check_error_bounds(root, study, *model);
  return study;
}

}  // namespace poesy
