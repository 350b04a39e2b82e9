#include "engine/files/result_file.h"

#include <array>
#include <filesystem>
#include <fstream>

#include "engine/base/contract.h"
#include "engine/base/error.h"
#include "engine/files/content_hash.h"
#include "engine/files/file_writer.h"
#include "engine/files/output_folder.h"
#include "engine/files/output_path.h"
#include "engine/files/poesy_file.h"
#include "engine/files/result_parts.h"
#include "engine/files/shard_file.h"
#include "engine/kinds/coupling/options.h"
#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/evaluate/options.h"
#include "engine/kinds/identification/options.h"
#include "engine/kinds/monte_carlo/options.h"
#include "engine/kinds/sensitivity/options.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

/// What reads the groups of a kind of study, and what shows them as CSV.
struct KindOfResult {
  const StudyKind* kind;
  void (*read)(const h5::File& file, StoredResult& result);
  void (*append_tables)(CsvTables& tables, const StoredResult& result);
};

constexpr std::array kKindsOfResult{
    KindOfResult{&kSensitivityStudy, read_sensitivity, append_sensitivity_tables},
    KindOfResult{&kIdentificationStudy, read_identification, append_identification_tables},
    KindOfResult{&kEvaluateStudy, read_evaluation, append_evaluation_tables},
    KindOfResult{&kMonteCarloStudy, read_monte_carlo, append_monte_carlo_tables},
    KindOfResult{&kCouplingStudy, read_coupling, append_coupling_tables}};

const KindOfResult& kind_named(const std::string& name) {
  for (const KindOfResult& each : kKindsOfResult) {
    if (each.kind->name == name) return each;
  }
  throw h5::Error("its kind '" + name + "' is unknown");
}

void write_file(const std::string& path, h5::File& file) {
  file.set_attribute("/", "content_sha256", content_sha256(file));
  const auto image = file.image();
  FileWriter writer(path);
  writer.expect(image.size());
  writer.write(image);
  writer.commit();
}

/// Composes what every file has, with compose(file) for the rest, and writes it.
template <class Compose>
void compose_and_write(const std::string& path, std::string_view filetype, const StudyKind& kind, const Study& study,
                       const SelectedPoses& poses, const RunFacts& facts, const Compose& compose) {
  try {
    ResultBuilder result;
    add_header(result, filetype, kind, study, poses);
    compose(result);
    add_facts(result, facts);
    write_file(path, result.file());
  } catch (const h5::Error& error) {
    throw FileError(path, std::string("cannot be composed: ") + error.what(), "report this as a bug of poesy");
  }
}

/// The same for a result, which has factors and responses.
template <class Compose>
void compose_result(const std::string& path, const StudyKind& kind, const Study& study, const SelectedPoses& poses,
                    std::span<const FactorIndex> factors, const RunFacts& facts, const Compose& compose) {
  compose_and_write(path, kResultFile, kind, study, poses, facts, [&](ResultBuilder& result) {
    add_names(result, study, factors);
    compose(result);
  });
}

/// Whether a file is named like a result, or is one: then a newer result may replace it. An empty file holds nothing.
bool may_be_replaced(const std::string& path) {
  if (std::filesystem::path(path).extension() == ".h5") return true;
  constexpr std::array kSignature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  std::array<char, kSignature.size()> begin{};
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), begin.size());
  return file.gcount() == 0 || begin == kSignature;
}

}  // namespace

void write_sensitivity(const std::string& path, const Study& study, const SelectedPoses& poses,
                       const SensitivityResult& result, const RunFacts& facts) {
  POESY_EXPECTS(result.factors == study.analysis.factors.size() && result.poses == poses.poses.size());
  compose_result(path, kSensitivityStudy, study, poses, study.analysis.factors, facts,
                 [&](ResultBuilder& file) { add_sensitivity(file, study, result); });
}

void write_evaluation(const std::string& path, const Study& study, const SelectedPoses& poses, const ErrorTable& errors,
                      Pairing pairing, const EvaluationResult& result, const RunFacts& facts) {
  POESY_EXPECTS(result.poses == poses.poses.size());
  compose_result(path, kEvaluateStudy, study, poses, errors.factors, facts,
                 [&](ResultBuilder& file) { add_evaluation(file, study.model(), result, errors, pairing); });
}

void write_cases(const std::string& path, const Study& study, const SelectedPoses& poses, const CaseResult& result,
                 const RunFacts& facts) {
  POESY_EXPECTS(result.evaluation.poses == poses.poses.size());
  const ErrorTable errors = case_table(asked_of<CaseOptions>(study.analysis).cases);
  compose_result(path, kEvaluateStudy, study, poses, errors.factors, facts,
                 [&](ResultBuilder& file) { add_cases(file, study, errors, result); });
}

void write_identification(const std::string& path, const Study& study, const SelectedPoses& poses,
                          const IdentificationResult& result, const RunFacts& facts) {
  POESY_EXPECTS(result.factors == study.analysis.factors.size() && result.poses == poses.poses.size());
  compose_result(path, kIdentificationStudy, study, poses, study.analysis.factors, facts,
                 [&](ResultBuilder& file) { add_identification(file, study, result); });
}

void write_monte_carlo(const std::string& path, const Study& study, const SelectedPoses& poses,
                       const MonteCarloResult& result, const RunFacts& facts) {
  POESY_EXPECTS(result.poses == poses.poses.size());
  compose_result(path, kMonteCarloStudy, study, poses, study.analysis.factors, facts,
                 [&](ResultBuilder& file) { add_monte_carlo(file, study, result); });
}

void write_coupling(const std::string& path, const Study& study, const SelectedPoses& poses,
                    const CouplingResult& result, const RunFacts& facts) {
  POESY_EXPECTS(result.poses == poses.poses.size());
  compose_result(path, kCouplingStudy, study, poses, study.analysis.factors, facts,
                 [&](ResultBuilder& file) { add_coupling(file, study, result); });
}

void write_result(const std::string& path, const Study& study, const SelectedPoses& poses, const StudyResult& result,
                  const RunFacts& facts) {
  struct Write {
    void operator()(const SensitivityResult& found) const { write_sensitivity(path, study, poses, found, facts); }
    void operator()(const IdentificationResult& found) const { write_identification(path, study, poses, found, facts); }
    void operator()(const CaseResult& found) const { write_cases(path, study, poses, found, facts); }
    void operator()(const MonteCarloResult& found) const { write_monte_carlo(path, study, poses, found, facts); }
    void operator()(const CouplingResult& found) const { write_coupling(path, study, poses, found, facts); }

    const std::string& path;
    const Study& study;
    const SelectedPoses& poses;
    const RunFacts& facts;
  };
  std::visit(Write{path, study, poses, facts}, result);
}

void write_shard(const std::string& path, const Study& study, const SelectedPoses& poses, const Shard& shard,
                 std::span<const Bytes> stages, const RunFacts& facts) {
  compose_and_write(path, kShardFile, *study.analysis.kind, study, poses, facts,
                    [&](ResultBuilder& file) { add_shard(file, shard, stages); });
}

void check_result_path(const std::string& path, std::span<const std::string> inputs) {
  check_output_path(path, {"result", may_be_replaced}, inputs);
}

StoredResult read_result(const std::string& path) {
  return with_poesy_file(path, [&](const h5::File& file) {
    expect_filetype(path, file, kResultFile);
    StoredResult result;
    read_header(file, result);
    kind_named(result.kind).read(file, result);
    return result;
  });
}

Verification verify_result(const std::string& path) {
  return with_poesy_file(path, [](const h5::File& file) {
    return Verification{.stored = stored_hash(file), .computed = content_sha256(file)};
  });
}

std::vector<std::string> export_tables(const StoredResult& result, const std::string& folder) {
  CsvTables tables{pose_table(result)};
  kind_named(result.kind).append_tables(tables, result);
  OutputFolder output(folder);
  for (const CsvTable& table : tables) output.claim(table.name + ".csv");
  output.open();
  std::vector<std::string> paths;
  for (const CsvTable& table : tables) paths.push_back(write_csv(folder, table));
  output.close();
  return paths;
}

std::vector<std::string> export_tables(const std::string& result_path, const std::string& folder) {
  return export_tables(read_result(result_path), folder);
}

}  // namespace poesy
