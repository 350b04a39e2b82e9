#include "engine/io/study_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>

#include "engine/base/text.h"
#include "engine/io/study_file_parts.h"
#include "engine/io/study_file_section.h"
#include "engine/io/text_file.h"
#include "engine/run/coupling_rows.h"

namespace poesy {
namespace {

constexpr std::size_t kMostBytes = 1 << 20;
/// Bounds the depth to which dotted keys nest tables, which the TOML library frees by recursion.
constexpr std::size_t kLongestLine = 16384;
constexpr std::int64_t kVersion = 1;

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

void check_format(const StudySection& root) {
  const StudyValue format = root.require("format", "begin a study with format = \"poesy-study\"");
  if (format.text() != "poesy-study") {
    format.fail("is '" + printable(format.text()) + "'", "a study has format = \"poesy-study\"");
  }
  const StudyValue version = root.require("version", "write version = 1");
  const std::int64_t number = version.whole_number(1);
  if (number > kVersion) {
    version.fail("is " + std::to_string(number) + ", but this poesy knows version 1 only", "use a newer poesy");
  }
}

SolverOptions::Method read_method(const StudyValue& value) {
  using Method = SolverOptions::Method;
  constexpr std::array kMethods{Method::newton, Method::gauss_newton};
  return kMethods[value.word(std::array{name(kMethods[0]), name(kMethods[1])})];
}

SolverOptions read_solver(const StudySection& section, const ModelDescription& model) {
  SolverOptions solver;
  solver.tolerance = model.tolerance;
  if (const auto value = section.find("method")) solver.method = read_method(*value);
  if (const auto value = section.find("tolerance")) {
    solver.tolerance = value->number();
    if (!(solver.tolerance > 0.0)) {
      value->fail("is " + shortest(solver.tolerance), "it must be greater than zero, e.g. 1e-15");
    }
  }
  if (const auto value = section.find("max_iterations")) {
    solver.max_iterations = static_cast<int>(value->whole_number(1, std::numeric_limits<int>::max()));
  }
  return solver;
}

/// What becomes of samples that were not solved. "fail" is short for "exclude" and a limit of 0.
void read_not_converged(const StudySection& section, Study& study) {
  constexpr std::array kPolicies{NotConverged::exclude, NotConverged::include, NotConverged::exclude};
  constexpr std::size_t kFail = 2;
  if (const auto value = section.find("not_converged")) {
    const std::size_t word = value->word(std::array{name(kPolicies[0]), name(kPolicies[1]), std::string_view("fail")});
    study.not_converged = kPolicies[word];
    if (word == kFail) {
      section.refuse("max_not_converged", "not_converged = \"fail\", which allows none");
      study.max_not_converged = 0.0;
    }
  }
  const auto limit = section.find("max_not_converged");
  if (!limit) return;
  study.max_not_converged = limit->number();
  if (study.max_not_converged >= 0.0 && study.max_not_converged <= 1.0) return;
  limit->fail("is " + shortest(study.max_not_converged), "it is a share of all samples, from 0 to 1, e.g. 0.001");
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
    const StudyValue fidelity = root.section("mechanism").require("fidelity", "");
    fidelity.fail("is \"both\", but kind = \"" + std::string(name(study.analysis.kind)) + "\" solves at one fidelity",
                  "write \"" + fidelities[0] + "\" or \"" + fidelities[1] + "\", or take kind = \"sensitivity\"");
  } else if (study.analysis.adaptive) {
    const StudyValue samples = root.section("analysis").require("samples", "");
    samples.fail(
        "ends at a relative error, but fidelity = \"both\" compares two fidelities on the same samples",
        "write a fixed number, e.g. samples = " + std::to_string(Analysis().samples) + ", or choose one fidelity");
  }
}

Study study_from(const StudySection& root, const Catalog& catalog, StudyUse use) {
  check_format(root);
  root.allow();
  Study study;
  if (const auto title = root.find("title")) study.title = title->text();
  study.mechanism = read_mechanism(root, catalog);
  study.poses = read_pose_selection(root, study.model(), use);
  study.errors = read_error_model(root, study.model());
  study.analysis = read_analysis(root, study.model(), use);
  const StudySection solver = root.section("solver");
  solver.allow();
  study.solver = read_solver(solver, study.model());
  read_not_converged(solver, study);
  const StudySection run = root.section("run");
  run.allow();
  if (const auto seed = run.find("seed")) study.seed = static_cast<std::uint64_t>(seed->whole_number(0));
  if (use == StudyUse::run) check_fidelities(root, study);
  check_size(root, study);
  return study;
}

}  // namespace

Study read_study(const std::string& path, const Catalog& catalog, StudyUse use) {
  if (begins_like_hdf5(path)) {
    throw InputError({path}, "is an HDF5 file, such as a result of poesy, and no study", "give its study, a TOML file");
  }
  return study_of_text(read_text(path, "study", kMostBytes), path, catalog, use);
}

Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use) {
  check_lines(text, path);
  const toml::table table = parse(text, path);
  const StudySection root(table, "", {path, 1, 1});
  Study study = study_from(root, catalog, use);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  if (use == StudyUse::run) check_error_bounds(root, study, *model);
  return study;
}

}  // namespace poesy
