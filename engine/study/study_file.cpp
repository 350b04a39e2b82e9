#include "engine/study/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "engine/base/contract.h"
#include "engine/base/text.h"
#include "engine/schema/keys_given.h"
#include "engine/schema/toml_text.h"
#include "engine/study/study_kind.h"
#include "engine/study/text_file.h"

namespace poesy {
namespace {

constexpr std::size_t kMostStudyBytes = 1 << 20;

/// Throws InputError if the result would have more than kMostCells values of one response, or if the study asks for
/// more than kMostSolves solves.
void check_size(const StudySection& root, const Study& study) {
  const bool from_file = study.poses.select == PoseSelection::Select::file;
  const double poses = static_cast<double>(from_file ? study.poses.from_file.points.size() : study.poses.count);
  const AtPose asked = study.analysis.kind->at_pose(study);
  const auto product = [&](std::string_view of, double times) {
    return fmt::format("poses times {} is {}, but ", of, shortest(poses * times));
  };
  if (poses * asked.values > static_cast<double>(kMostCells)) {
    throw InputError(root.section("poses").place(),
                     product(asked.of_values, asked.values) + fmt::format("a result holds at most {}", kMostCells),
                     fmt::format("ask for fewer poses or {}", asked.of_values));
  }
  if (poses * asked.solves > static_cast<double>(kMostSolves)) {
    throw InputError(root.section("analysis").place(),
                     product(asked.of_solves, asked.solves) + fmt::format("at most {} can be solved", kMostSolves),
                     "ask for fewer samples");
  }
}

/// Throws InputError if two fidelities are compared by a kind that cannot compare them, or with adaptive samples.
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

/// Throws InputError if the background names a factor set in which all errors vary, or a list with an error that
/// varies.
void check_background(const Study& study, const Reading& reading) {
  if (!study.analysis.background || study.analysis.kind->varies == Varies::none) return;
  const auto varies = [&](FactorIndex factor) {
    return std::ranges::find(study.analysis.factors, factor) != study.analysis.factors.end();
  };
  const std::vector<FactorIndex>& held = study.analysis.background->factors;
  const StudyValue factors = reading.root.section("analysis").section("background").require("factors");
  const std::string remedy = "leave it out here, or out of the errors that vary";
  if (factors.is_text() && std::ranges::all_of(held, varies)) {
    factors.fail("holds errors constant that all vary in this study, so it would do nothing", remedy);
  }
  if (factors.is_text()) return;
  const std::vector<StudyValue> named = factors.list();
  for (std::size_t n = 0; n < named.size(); ++n) {
    if (!varies(held[n])) continue;
    named[n].fail("holds '" + study.model().factors[held[n].value].name + "' constant, which varies in this study",
                  remedy);
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
  read_responses(study, reading);
  read_poses_section(study, reading);
  read_errors_section(study, reading);
  read_analysis(study, reading);
  read_keys(run_keys(), root.section("run"), study, reading);
  if (reading.use == StudyUse::run) {
    check_fidelities(study, reading);
    check_correlated(study, reading);
    check_zones(study, reading);
    check_machines(study, reading);
    check_background(study, reading);
    check_other_poses(study, reading);
  }
  check_size(root, study);
  return study;
}

/// The keys of [analysis] for the study's kind. The key `calibration` is kept for every kind, because `poesy calibrate`
/// reads it from studies of all kinds.
StudyRows analysis_keys_of(const Study& study) {
  const StudyKind& kind = *study.analysis.kind;
  StudyRows keys = analysis_keys(kind);
  std::erase_if(keys.rows, [&](const StudyRow& row) {
    return row.name != keys.chooser && row.name != "calibration" && !kind.has_key(row.name);
  });
  return keys;
}

}  // namespace

bool StudyKind::has_key(std::string_view key) const { return std::ranges::find(keys, key) != keys.end(); }

StudyKinds study_kinds_of(std::vector<const StudyKind*> all, std::span<const std::string_view> order) {
  StudyKinds kinds{std::move(all), {described(file_keys())}};
  const auto analysis = std::ranges::find(kinds.tables.front().keys, "analysis", &StudyKey::name);
  analysis->usual = "a " + std::string(kinds.all.front()->name) + " study";
  for (const StudyTables& more :
       {mechanism_tables(), response_tables(), poses_tables(), errors_tables(), analysis_tables(kinds.all, order),
        StudyTables{described(solver_keys()), described(run_keys())}}) {
    kinds.tables.insert(kinds.tables.end(), more.begin(), more.end());
  }
  return kinds;
}

const StudyKind* find(const StudyKinds& kinds, std::string_view name) {
  const auto found = std::ranges::find(kinds.all, name, [](const StudyKind* kind) { return kind->name; });
  return found == kinds.all.end() ? nullptr : *found;
}

std::vector<std::string_view> names(const StudyKinds& kinds) {
  std::vector<std::string_view> list;
  for (const StudyKind* kind : kinds.all) list.push_back(kind->name);
  return list;
}

Study read_study(const std::string& path, const Catalog& catalog, StudyUse use, const StudyKinds& kinds,
                 std::span<const GivenKey> given) {
  return study_of_text(read_text(path, "study", kMostStudyBytes), path, catalog, use, kinds, nullptr, given);
}

Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use,
                    const StudyKinds& kinds, const std::string* mechanism_text, std::span<const GivenKey> given) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw InputError({path, 1, 1}, "the study is empty", "'poesy template MODEL' writes one to start from");
  }
  toml::table table = parse_toml(text, path, "correct this line; 'poesy template MODEL' shows a complete study");
  for (const GivenKey& key : given) set_key(table, key);
  const StudySection root(table, "", {path, 1, 1}, kinds.tables);
  Study study = study_from({root, catalog, kinds, use, mechanism_text});
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  if (use == StudyUse::run) check_error_bounds(root, study, *model);
  return study;
}

std::string resolved_text(const Study& study) {
  POESY_EXPECTS(study.analysis.kind != nullptr);
  return fmt::format("{}\n[mechanism]\n{}\n[poses]\n{}\n[errors]\n{}\n[analysis]\n{}\n[solver]\n{}\n[run]\n{}",
                     keys_text(file_keys(), study), keys_text(mechanism_keys(), study), keys_text(poses_keys(), study),
                     keys_text(errors_keys(), study), keys_text(analysis_keys_of(study), study),
                     keys_text(solver_keys(), study), keys_text(run_keys(), study));
}

}  // namespace poesy
