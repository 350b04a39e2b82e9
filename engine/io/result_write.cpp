#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <functional>
#include <map>
#include <numeric>
#include <system_error>

#include "engine/base/contract.h"
#include "engine/base/error.h"
#include "engine/io/content_hash.h"
#include "engine/io/file_writer.h"
#include "engine/io/result_builder.h"
#include "engine/io/result_file.h"
#include "engine/io/result_format.h"
#include "engine/io/study_file.h"
#include "engine/io/version.h"

namespace poesy {
namespace {

using Axes = std::vector<std::string>;

std::vector<std::int64_t> positions(std::size_t count) {
  std::vector<std::int64_t> list(count);
  std::iota(list.begin(), list.end(), 0);
  return list;
}

template <class Things, class Member>
std::vector<std::string> texts(const Things& things, const Member& member) {
  std::vector<std::string> list;
  for (const auto& thing : things) list.emplace_back(std::invoke(member, thing));
  return list;
}

template <class Thing>
std::string unit_of(const Thing& thing) {
  return std::string(si_unit(thing.dimension));
}

std::vector<Factor> chosen(const ModelDescription& model, std::span<const FactorIndex> indices) {
  std::vector<Factor> factors;
  for (const FactorIndex index : indices) factors.push_back(model.factors[index.value]);
  return factors;
}

void add_root(h5::File& file, std::string_view kind, const Study& study) {
  const std::vector<std::int64_t> version{result_format::kMajor, result_format::kMinor};
  file.set_attribute("/", "filetype", std::string(result_format::kFileType));
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

void add_rejected_poses(ResultBuilder& result, const std::vector<RejectedPoses>& rejected) {
  if (rejected.empty()) return;
  const auto reasons = texts(rejected, &RejectedPoses::reason);
  std::vector<std::uint64_t> counts;
  for (const RejectedPoses& each : rejected) counts.push_back(each.count);
  result.add_axis("rejection", reasons, {"1", "Why poses were rejected"});
  result.file().make_group("/poses/rejected");
  result.show_axes("/poses/rejected", {"rejection"});
  result.add("/poses/rejected/reason", {"rejection"}, reasons, {"1", "Why poses were rejected"});
  result.add("/poses/rejected/count", {"rejection"}, counts, {"1", "Candidate poses rejected for this reason"});
}

void add_poses(ResultBuilder& result, const ModelDescription& model, const SelectedPoses& selected) {
  const PoseSet& poses = selected.poses;
  result.add_axis("pose", positions(poses.size()), {"1", "Number of the pose, from 0"});
  result.file().make_group("/poses");
  const auto names = texts(model.pose_coordinates, &PoseCoordinate::name);
  result.file().set_attribute("/poses", "coordinates", std::span(names));
  for (std::size_t c = 0; c < names.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    result.add("/poses/" + names[c], {"pose"}, poses.column(c), {unit_of(coordinate), coordinate.description});
  }
  result.add("/poses/condition", {"pose"}, selected.condition,
             {"1", "Condition number of the passive joints' Jacobian; infinity at a singular pose"});
  add_rejected_poses(result, selected.rejected);
}

void add_factors(ResultBuilder& result, const std::vector<Factor>& factors) {
  const auto names = texts(factors, &Factor::name);
  result.add_axis("factor", names, {"1", "Name of the error"});
  result.file().make_group("/factors");
  result.add("/factors/name", {"factor"}, names, {"1", "Name of the error"});
  result.add("/factors/unit", {"factor"}, texts(factors, unit_of<Factor>), {"1", "SI unit of the error"});
}

void add_responses(ResultBuilder& result, const std::vector<Response>& responses) {
  const auto names = texts(responses, &Response::name);
  result.add_axis("response", names, {"1", "Name of the response"});
  result.file().make_group("/responses");
  result.add("/responses/name", {"response"}, names, {"1", "Name of the response"});
  result.add("/responses/unit", {"response"}, texts(responses, unit_of<Response>), {"1", "SI unit of the response"});
}

void add_sigma(ResultBuilder& result, const Study& study) {
  std::vector<double> sigma;
  for (const FactorIndex factor : study.analysis.factors) {
    sigma.push_back(study.errors.by_factor[factor.value].standard_deviation());
  }
  result.add("/factors/sigma", {"factor"}, sigma,
             {"SI: factor unit, see /factors/unit", "Standard deviation of the error, as set in the study"});
}

void add_global_indices(ResultBuilder& result, const SensitivityResult& found) {
  const Axes axes{"response", "factor"};
  const std::string unit = "SI: response unit / factor unit";
  result.add(
      "/sensitivity/global", axes, found.global,
      {unit, "Global index: mean over the poses + standard deviation over the poses (Du et al. 2022, Eqs. 53-54)"});
  result.add("/sensitivity/global_ci_low", axes, found.global_ci_low, {unit, "Lower end of the interval of global"});
  result.add("/sensitivity/global_ci_high", axes, found.global_ci_high, {unit, "Upper end of the interval of global"});
}

void add_local_indices(ResultBuilder& result, const SensitivityResult& found) {
  const Axes axes{"response", "factor", "pose"};
  const std::string index_unit = "SI: response unit / factor unit";
  const std::string response_unit = "SI: response unit, see /responses/unit";
  const std::vector<std::uint64_t> count(found.count.begin(), found.count.end());
  result.add("/sensitivity/local", axes, found.local,
             {index_unit, "Index at each pose: sigma(response) / sigma(error) (Du et al. 2022, Eqs. 51-52)"});
  result.add("/sensitivity/local_ci_low", axes, found.local_ci_low, {index_unit, "Lower end of the interval of local"});
  result.add("/sensitivity/local_ci_high", axes, found.local_ci_high,
             {index_unit, "Upper end of the interval of local"});
  result.add("/sensitivity/count", axes, count, {"1", "Samples behind the index"});
  result.add("/sensitivity/mean", axes, found.mean, {response_unit, "Mean of the response over the samples"});
  result.add("/sensitivity/std", axes, found.std,
             {response_unit, "Standard deviation of the response over the samples"});
}

void add_sensitivity(ResultBuilder& result, const SensitivityResult& found) {
  h5::File& file = result.file();
  file.make_group("/sensitivity");
  result.show_axes("/sensitivity", {"response", "factor", "pose"});
  file.set_attribute("/sensitivity", "description",
                     std::string("Sensitivity of each response to each error: sigma(response) / sigma(error), one "
                                 "error varying at a time; NaN where undefined"));
  file.set_attribute("/sensitivity", "conf_level", found.conf_level);
  add_global_indices(result, found);
  add_local_indices(result, found);
  for (const char* interval : {"global_ci_low", "global_ci_high", "local_ci_low", "local_ci_high"}) {
    file.set_attribute(std::string("/sensitivity/") + interval, "conf_level", found.conf_level);
  }
}

template <class T, class Get>
std::vector<T> each(const std::vector<SolveCounts>& solves, const Get& get) {
  std::vector<T> values;
  for (const SolveCounts& cell : solves) values.push_back(get(cell));
  return values;
}

void add_solver(ResultBuilder& result, const std::vector<SolveCounts>& solves) {
  const Axes axes{"factor", "pose"};
  result.add_axis("status", texts(kStatusNames, std::identity()), {"1", "How a solve ended"});
  result.file().make_group("/solver");
  result.show_axes("/solver", {"status", "factor", "pose"});
  result.add("/solver/not_converged", axes,
             each<std::uint64_t>(solves, [](auto& cell) { return cell.not_converged(); }),
             {"1", "Samples that did not reach their fixed point"});
  result.add(
      "/solver/iterations_mean", axes,
      each<double>(solves,
                   [](auto& cell) { return static_cast<double>(cell.iterations) / static_cast<double>(cell.total()); }),
      {"1", "Mean number of iterations of a sample"});
  result.add("/solver/iterations_max", axes,
             each<std::uint32_t>(solves, [](auto& cell) { return cell.most_iterations; }),
             {"1", "Most iterations of a sample"});
  std::vector<std::uint64_t> by_status;
  for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
    for (const SolveCounts& cell : solves) by_status.push_back(cell.by_status[status]);
  }
  result.add("/solver/solves_by_status", {"status", "factor", "pose"}, by_status, {"1", "Samples that ended so"});
}

void add_details(ResultBuilder& result, const std::vector<Detail>& details, const EvaluationResult& found) {
  if (found.details == 0) return;
  const auto names = texts(details, &Detail::name);
  result.file().set_attribute("/evaluate", "details", std::span(names));
  std::map<std::vector<std::string>, std::string> axis_of;  // details with the same components share an axis
  std::size_t first = 0;
  for (const Detail& detail : details) {
    const std::size_t width = detail.components.size();
    const std::string next = "component" + (axis_of.empty() ? "" : "_" + std::to_string(axis_of.size() + 1));
    const auto [axis, is_new] = axis_of.try_emplace(detail.components, next);
    if (is_new) {
      result.add_axis(axis->second, detail.components, {"1", "Component of " + detail.name + " and its like"});
      result.show_axes("/evaluate", {axis->second});
    }
    std::vector<double> values;
    for (std::size_t row = 0; row < found.status.size(); ++row) {
      const auto begin = found.detail.begin() + static_cast<std::ptrdiff_t>(row * found.details + first);
      values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
    }
    const std::string path = "/evaluate/" + detail.name;
    result.add(path, {"pose", "sample", axis->second}, values, {detail.unit, detail.description});
    result.file().set_attribute(path, "components", std::span(detail.components));
    first += width;
  }
}

void add_evaluation(ResultBuilder& result, const ModelDescription& model, const EvaluationResult& found) {
  const Axes axes{"pose", "sample"};
  result.add_axis("sample", positions(found.samples), {"1", "Number of the sample at each pose, from 0"});
  result.add_axis("joint", texts(model.joints, &JointDisplacement::name), {"1", "Name of the joint displacement"});
  result.file().make_group("/evaluate");
  result.show_axes("/evaluate", {"pose", "sample", "joint"});
  const std::size_t cells = found.poses * found.samples;
  for (std::size_t r = 0; r < model.responses.size(); ++r) {
    const Response& response = model.responses[r];
    result.add("/evaluate/" + response.name, axes, std::span(found.response).subspan(r * cells, cells),
               {unit_of(response), response.description});
  }
  add_details(result, model.details, found);
  std::vector<std::uint8_t> status;
  for (const SolveStatus ending : found.status) status.push_back(static_cast<std::uint8_t>(ending));
  const auto status_names = texts(kStatusNames, std::identity());
  result.add("/evaluate/status", axes, status, {"1", "How the solve ended: a position in status_names, from 0"});
  result.file().set_attribute("/evaluate/status", "status_names", std::span(status_names));
  result.add("/evaluate/iterations", axes, found.iterations, {"1", "Iterations of the solve"});
  result.add("/evaluate/joint_displacements", {"pose", "joint"}, found.joint_displacement,
             {"rad or m, by joint", "Joint displacements of the perfect mechanism"});
}

void add_errors(ResultBuilder& result, const ErrorTable& errors, Pairing pairing) {
  const bool row_by_row = pairing == Pairing::row_by_row;
  const std::string rows = row_by_row ? "pose" : "sample";
  result.file().make_group("/errors");
  result.file().set_attribute(
      "/errors", "pairing", std::string(row_by_row ? result_format::kRowByRow : result_format::kEveryPoseWithEveryRow));
  result.show_axes("/errors", {rows, "factor"});
  result.add("/errors/values", {rows, "factor"}, errors.values,
             {"SI: factor unit, see /factors/unit", "The errors that were given; all others are zero"});
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
  result.add_scalar<std::uint64_t>("/run/threads", facts.threads, {"1", "Threads in each rank"});
  result.add_scalar<std::uint64_t>("/run/ranks", facts.ranks, {"1", "MPI ranks"});
  result.add_scalar("/run/wall_seconds", facts.wall_seconds, {"s", "Time the solves took"});
  result.add_scalar<std::uint64_t>("/run/solves", facts.solves, {"1", "Solves of the mechanism"});
  const double rate = facts.wall_seconds > 0.0 ? static_cast<double>(facts.solves) / facts.wall_seconds : 0.0;
  result.add_scalar("/run/solves_per_second", rate, {"1/s", "Solves a second, all threads and ranks together"});
}

void write_file(const std::string& path, h5::File& file) {
  file.set_attribute("/", "content_sha256", content_sha256(file));
  FileWriter writer(path);
  writer.write(file.image());
  writer.commit();
}

template <class Compose>
void compose_and_write(const std::string& path, const Compose& compose) {
  try {
    ResultBuilder result;
    compose(result);
    write_file(path, result.file());
  } catch (const h5::Error& error) {
    throw FileError(path, std::string("cannot be composed: ") + error.what(), "report this as a bug of poesy");
  }
}

}  // namespace

void write_sensitivity(const std::string& path, const Study& study, const SelectedPoses& poses,
                       const SensitivityResult& result, const RunFacts& facts) {
  POESY_EXPECTS(result.factors == study.analysis.factors.size() && result.poses == poses.poses.size());
  compose_and_write(path, [&](ResultBuilder& file) {
    add_root(file.file(), result_format::kSensitivity, study);
    add_study(file, study);
    add_poses(file, study.model(), poses);
    add_factors(file, chosen(study.model(), study.analysis.factors));
    add_sigma(file, study);
    add_responses(file, study.model().responses);
    add_sensitivity(file, result);
    add_solver(file, result.solves);
    add_run(file, facts);
  });
}

void write_evaluation(const std::string& path, const Study& study, const SelectedPoses& poses, const ErrorTable& errors,
                      Pairing pairing, const EvaluationResult& result, const RunFacts& facts) {
  POESY_EXPECTS(result.poses == poses.poses.size());
  compose_and_write(path, [&](ResultBuilder& file) {
    add_root(file.file(), result_format::kEvaluate, study);
    add_study(file, study);
    add_poses(file, study.model(), poses);
    add_factors(file, chosen(study.model(), errors.factors));
    add_responses(file, study.model().responses);
    add_evaluation(file, study.model(), result);
    add_errors(file, errors, pairing);
    add_run(file, facts);
  });
}

void check_result_path(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    throw InputError({.file = path}, fs::is_directory(path, ignored) ? "is a folder" : "is not a plain file",
                     "name a file for the result");
  }
  if (!fs::is_directory(folder, ignored)) {
    throw InputError({.file = path}, "its folder " + folder.string() + " does not exist", "make it or choose another");
  }
  if (!fs::path(path).has_filename()) throw InputError({.file = path}, "names no file", "name a file for the result");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    const std::string reason = std::generic_category().message(errno);
    throw FileError(path, "cannot be written into its folder (" + reason + ")", "choose another folder");
  }
}

}  // namespace poesy
