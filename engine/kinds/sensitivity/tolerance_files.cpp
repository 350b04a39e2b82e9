#include "engine/kinds/sensitivity/tolerance_files.h"

#include <algorithm>
#include <filesystem>

#include "engine/base/contract.h"
#include "engine/base/error.h"
#include "engine/files/csv_table.h"
#include "engine/files/file_writer.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/study_file.h"
#include "engine/study/error_words.h"

namespace poesy {
namespace {

constexpr const char* kPoses = "confirm_poses";
constexpr const char* kEqualEffect = "confirm_equal_effect";
constexpr const char* kEqualTolerance = "confirm_equal_tolerance";
/// Four standard deviations of a normal error reach as far as its part is large.
constexpr double kShareOfPart = 0.25;

void write_poses(const std::string& folder, const StoredResult& result) {
  const auto coordinate = [&](std::size_t m, std::size_t c) { return result.poses[PoseIndex(m)][c]; };
  CsvTable table{kPoses,
                 {result.pose_coordinates.front().name, [&](std::size_t m) { return shortest(coordinate(m, 0)); }},
                 result.poses.size()};
  for (std::size_t c = 1; c < result.pose_coordinates.size(); ++c) {
    table.columns.push_back(
        {result.pose_coordinates[c].name, [&coordinate, c](std::size_t m) { return coordinate(m, c); }});
  }
  write_csv(folder, table);
}

/// The study of a sensitivity result, as a Monte Carlo study of the same errors at the same poses.
Study monte_carlo_study(const StoredResult& result, const Catalog& catalog) {
  // The file of poses, if there is one, is known by a path relative to a study that may be gone; the result has them.
  Study study = study_of_text(result.study_text, "the study in the result", catalog, StudyUse::evaluate);
  if (study.analysis.factors.size() != result.factors.size()) {
    throw FileError("the study in the result", "does not fit the result's factors", "run the study again");
  }
  study.analysis.kind = &find_kind("monte-carlo")->study;
  study.analysis.asked.reset();
  const bool along_file = study.poses.trajectory && !study.poses.trajectory->file.empty();
  if (along_file) study.poses.select = PoseSelection::Select::file;
  study.mechanism.compared.reset();
  if (study.poses.select == PoseSelection::Select::file) study.poses.file = std::string(kPoses) + ".csv";
  return study;
}

/// A quarter of the part that each of the study's errors is an error of, [P].
std::vector<double> quarters_of_parts(const Study& study) {
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  std::vector<double> largest;
  for (const FactorIndex factor : study.analysis.factors) {
    largest.push_back(kShareOfPart * model->error_bound(factor).size);
  }
  return largest;
}

/// Errors whose tolerance is as large as it may be go to `at_largest`.
void set_tolerances(Study& study, std::span<const double> largest, std::span<const double> tolerances,
                    std::vector<std::string>& at_largest) {
  for (std::size_t p = 0; p < tolerances.size(); ++p) {
    const FactorIndex factor = study.analysis.factors[p];
    study.errors.by_factor[factor.value] = Distribution::normal(std::min(tolerances[p], largest[p]));
    if (tolerances[p] < largest[p]) continue;
    const Factor& named = study.model().factors[factor.value];
    const std::string text = named.name + " is " + readable_text({largest[p], named.dimension});
    if (std::ranges::find(at_largest, text) == at_largest.end()) at_largest.push_back(text);
  }
}

std::string write_study(const std::string& folder, const std::string& name, const Study& study,
                        const std::string& caveat) {
  const std::string path = (std::filesystem::path(folder) / (name + ".toml")).string();
  FileWriter writer(path);
  if (const std::string held = held_errors_text(study); !held.empty()) writer.write("# " + held + "\n");
  if (!caveat.empty()) writer.write("# " + caveat + "\n");
  writer.write(resolved_text(study));
  writer.commit();
  return path;
}

}  // namespace

std::vector<std::span<const double>> proposed_tolerances(const ResponseTolerances& tolerances) {
  if (!tolerances.limit) return {tolerances.all.equal_effect};
  return {tolerances.limit->equal_effect, tolerances.limit->equal_tolerance};
}

std::vector<double> largest_tolerances(const StoredResult& result, const Catalog& catalog) {
  return quarters_of_parts(monte_carlo_study(result, catalog));
}

void claim_tolerance_files(OutputFolder& folder, const StoredResult& result, const ResponseTolerances& tolerances,
                           const Catalog& catalog) {
  folder.claim("tolerances.csv");
  if (!tolerances.limit) return;
  for (const char* study : {kEqualEffect, kEqualTolerance}) folder.claim(std::string(study) + ".toml");
  const bool with_poses = monte_carlo_study(result, catalog).poses.select == PoseSelection::Select::file;
  if (with_poses) folder.claim(std::string(kPoses) + ".csv");
}

Confirmation write_confirmation(const std::string& folder, const StoredResult& result,
                                const ResponseTolerances& tolerances, const Catalog& catalog) {
  POESY_EXPECTS(tolerances.limit.has_value());
  Study study = monte_carlo_study(result, catalog);
  make_folder(folder);
  if (study.poses.select == PoseSelection::Select::file) write_poses(folder, result);
  study.analysis.limits = {{tolerances.response, tolerances.limit->limit}};
  const ErrorModel as_studied = study.errors;
  const NamedUnit& response = result.responses[tolerances.response];
  const std::string limit = response.unit == "1"
                                ? shortest(tolerances.limit->limit)
                                : readable_text({tolerances.limit->limit, display(response).dimension});
  const std::vector<double> largest = quarters_of_parts(study);
  Confirmation written;
  const auto add = [&](const std::string& name, const std::string& words, std::span<const double> values) {
    study.title = "Tests " + words + " against a limit of " + limit + " on the root mean square of " + response.name;
    study.errors = as_studied;
    set_tolerances(study, largest, values, written.at_largest);
    written.paths.push_back(write_study(folder, name, study, tolerances.caveat));
  };
  add(kEqualEffect, "tolerances of equal effect", tolerances.limit->equal_effect);
  add(kEqualTolerance, "equal tolerances", tolerances.limit->equal_tolerance);
  return written;
}

}  // namespace poesy
