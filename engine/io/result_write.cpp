#include <array>
#include <filesystem>
#include <fstream>

#include "engine/base/contract.h"
#include "engine/base/error.h"
#include "engine/io/content_hash.h"
#include "engine/io/file_writer.h"
#include "engine/io/output_path.h"
#include "engine/io/result_file.h"
#include "engine/io/result_format.h"
#include "engine/io/result_parts.h"
#include "engine/io/shard_file.h"
#include "engine/io/study_file.h"
#include "engine/io/version.h"
#include "engine/run/cases.h"

namespace poesy {
namespace {

std::vector<Factor> chosen(const ModelDescription& model, std::span<const FactorIndex> indices) {
  std::vector<Factor> factors;
  for (const FactorIndex index : indices) factors.push_back(model.factors[index.value]);
  return factors;
}

void add_root(h5::File& file, std::string_view filetype, std::string_view kind, const Study& study) {
  const std::vector<std::int64_t> version{result_format::kMajor, result_format::kMinor};
  file.set_attribute("/", "filetype", std::string(filetype));
  file.set_attribute("/", "version", std::span(version));
  file.set_attribute("/", "kind", std::string(kind));
  file.set_attribute("/", "title", study.title);
  file.set_attribute("/", "model", study.model().name);
  file.set_attribute("/", "poesy_version", poesy_version());
  file.set_attribute("/", "git_commit", git_commit());
}

void add_study(ResultBuilder& result, const Study& study) {
  result.file().make_group("/study");
  result.add_scalar("/study/text", resolved_text(study), {"1", "The study, every default filled in (TOML)"});
}

void add_factors(ResultBuilder& result, const std::vector<Factor>& factors) {
  const auto names = texts(factors, &Factor::name);
  result.add_axis("factor", names, {"1", "Name of the error"});
  result.file().make_group("/factors");
  result.add("/factors/name", {"factor"}, names, {"1", "Name of the error"});
  result.add("/factors/unit", {"factor"}, texts(factors, unit_of<Factor>), {"1", "SI unit of the error"});
  result.add("/factors/description", {"factor"}, texts(factors, &Factor::description),
             {"1", "What the error is, in words"});
}

void add_responses(ResultBuilder& result, const ModelDescription& model) {
  const std::vector<Response>& responses = model.responses;
  const auto names = texts(responses, &Response::name);
  result.add_axis("response", names, {"1", "Name of the response"});
  result.file().make_group("/responses");
  result.add("/responses/name", {"response"}, names, {"1", "Name of the response"});
  result.add("/responses/unit", {"response"}, texts(responses, unit_of<Response>), {"1", "SI unit of the response"});
  result.add("/responses/description", {"response"}, texts(responses, &Response::description),
             {"1", "What the response is, in words"});
  const auto add_chosen = [&](const std::string& attribute, const std::vector<std::size_t>& chosen) {
    std::vector<std::string> list;
    for (const std::size_t r : chosen) list.push_back(responses[r].name);
    if (!list.empty()) result.file().set_attribute("/responses", attribute, std::span(std::as_const(list)));
  };
  add_chosen("headline", model.headline);
  add_chosen("signed_headline", model.signed_headline);
}

void add_run(ResultBuilder& result, const RunFacts& facts) {
  h5::File& file = result.file();
  file.make_group("/run");
  file.set_attribute("/run", "description", std::string("Facts about this run; not part of the content hash"));
  file.set_attribute("/run", "version_hdf5", h5::library_version());
  for (const LibraryVersion& library : build_versions()) {
    file.set_attribute("/run", "version_" + std::string(library.name), std::string(library.version));
  }
  result.add_scalar("/run/created", facts.created, {"1", "When the run ended (UTC, ISO 8601)"});
  result.add_scalar("/run/host", facts.host, {"1", "Name of the machine"});
  result.add_scalar("/run/cpu", facts.cpu, {"1", "Its processor"});
  result.add_scalar<std::uint64_t>("/run/threads", facts.threads, {"1", "Threads, of all ranks together"});
  result.add_scalar<std::uint64_t>("/run/ranks", facts.ranks, {"1", "MPI ranks"});
  result.add_scalar("/run/wall_seconds", facts.wall_seconds, {"s", "Time the solves took"});
  result.add_scalar("/run/checkpoint_seconds", facts.checkpoint_seconds, {"s", "Of that time, spent on checkpoints"});
  result.add_scalar<std::uint64_t>("/run/solves", facts.solves, {"1", "Solves of the mechanism"});
  const double rate = facts.wall_seconds > 0.0 ? static_cast<double>(facts.solves) / facts.wall_seconds : 0.0;
  result.add_scalar("/run/solves_per_second", rate, {"1/s", "Solves a second, all threads and ranks together"});
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
void compose_and_write(const std::string& path, std::string_view filetype, std::string_view kind, const Study& study,
                       const SelectedPoses& poses, const RunFacts& facts, const Compose& compose) {
  try {
    ResultBuilder result;
    add_root(result.file(), filetype, kind, study);
    add_study(result, study);
    add_poses(result, study.model(), poses);
    compose(result);
    add_run(result, facts);
    write_file(path, result.file());
  } catch (const h5::Error& error) {
    throw FileError(path, std::string("cannot be composed: ") + error.what(), "report this as a bug of poesy");
  }
}

/// The same for a result, which has factors and responses.
template <class Compose>
void compose_result(const std::string& path, std::string_view kind, const Study& study, const SelectedPoses& poses,
                    std::span<const FactorIndex> factors, const RunFacts& facts, const Compose& compose) {
  compose_and_write(path, result_format::kFileType, kind, study, poses, facts, [&](ResultBuilder& result) {
    add_metric(result, study);
    add_factors(result, chosen(study.model(), factors));
    add_responses(result, study.model());
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
  compose_result(path, result_format::kSensitivity, study, poses, study.analysis.factors, facts,
                 [&](ResultBuilder& file) { add_sensitivity(file, study, result); });
}

void write_evaluation(const std::string& path, const Study& study, const SelectedPoses& poses, const ErrorTable& errors,
                      Pairing pairing, const EvaluationResult& result, const RunFacts& facts) {
  POESY_EXPECTS(result.poses == poses.poses.size());
  compose_result(path, result_format::kEvaluate, study, poses, errors.factors, facts, [&](ResultBuilder& file) {
    add_evaluation(file, study.model(), result);
    add_errors(file, errors, pairing);
  });
}

void write_cases(const std::string& path, const Study& study, const SelectedPoses& poses, const CaseResult& result,
                 const RunFacts& facts) {
  POESY_EXPECTS(result.evaluation.poses == poses.poses.size());
  const ErrorTable errors = case_table(study.analysis.cases);
  compose_result(path, result_format::kEvaluate, study, poses, errors.factors, facts,
                 [&](ResultBuilder& file) { add_cases(file, study, result); });
}

void write_identification(const std::string& path, const Study& study, const SelectedPoses& poses,
                          const IdentificationResult& result, const RunFacts& facts) {
  POESY_EXPECTS(result.factors == study.analysis.factors.size() && result.poses == poses.poses.size());
  compose_result(path, result_format::kIdentification, study, poses, study.analysis.factors, facts,
                 [&](ResultBuilder& file) { add_identification(file, study, result); });
}

void write_monte_carlo(const std::string& path, const Study& study, const SelectedPoses& poses,
                       const MonteCarloResult& result, const RunFacts& facts) {
  POESY_EXPECTS(result.poses == poses.poses.size());
  compose_result(path, result_format::kMonteCarlo, study, poses, study.analysis.factors, facts,
                 [&](ResultBuilder& file) { add_monte_carlo(file, study, result); });
}

void write_coupling(const std::string& path, const Study& study, const SelectedPoses& poses,
                    const CouplingResult& result, const RunFacts& facts) {
  POESY_EXPECTS(result.poses == poses.poses.size());
  compose_result(path, result_format::kCoupling, study, poses, study.analysis.factors, facts,
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
  compose_and_write(path, result_format::kShardFileType, name(study.analysis.kind), study, poses, facts,
                    [&](ResultBuilder& file) { add_shard(file, shard, stages); });
}

void check_result_path(const std::string& path, std::span<const std::string> inputs) {
  check_output_path(path, {"result", may_be_replaced}, inputs);
}

}  // namespace poesy
