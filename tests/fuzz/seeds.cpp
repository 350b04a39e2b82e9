// Writes the seeds for the fuzzers of binary formats: a result file of each kind into FOLDER/result, and checkpoints
// without digests into FOLDER/checkpoint.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/identification/identification.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/result/shard_file.h"
#include "engine/storage/checkpoint.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/kinds.h"
#include "tests/support/small_studies.h"
#include "tests/support/states.h"

namespace {

using namespace poesy;

// A mechanism with everything that a result can contain.
const Catalog& catalog() {
  static const Catalog all = [] {
    Catalog list = test::fake_catalog();
    list[0].description.fidelities = {"exact", "first-order"};
    list[0].description.separation = {"how far the platform moves", {"compensable", "", "non-compensable"}};
    return list;
  }();
  return all;
}

void write_sensitivity_seed(const std::string& path) {
  test::Example example;
  example.study.mechanism.entry = &catalog()[0];
  example.study.mechanism.compared = 1;
  sensitivity::Result result = example.sensitivity();
  const auto& described = *catalog()[0].description.separation;
  const sensitivity::SeparationResult::Cells cells({2, test::Example::kPoses}, 0.25);
  result.separation = {.measure = described.measure,
                       .drive = cells,
                       .constraint = cells,
                       .effect = cells,
                       .residual = cells,
                       .removable_local = cells,
                       .drive_share = {{2}, {0.25, 0.75}},
                       .removable = {{2}, {0.125, 0.5}},
                       .removable_together = 0.375,
                       .published = {{2}, std::vector<std::string>{"", "compensable"}}};
  result.fidelity = test::Example::fidelity(catalog()[0].description.fidelities);
  result.failures = {{0, PoseIndex(1), {SampleIndex(7), SolveStatus::singular}}};
  write_result(path, example.study, example.poses, result, example.facts);
}

void write_convergence_seed(const std::string& path) {
  test::Example example;
  example.study.analysis.adaptive = AdaptiveSamples{1000, 0.05};
  sensitivity::Result result = example.sensitivity();
  ConvergenceResult& convergence = result.convergence.emplace();
  convergence.min = 1000;
  convergence.max = 3000;
  convergence.relative_error = 0.05;
  convergence.course.conf_level = 0.95;
  convergence.course.samples = {1000, 2000};
  const std::size_t indices = result.global.size();
  convergence.course.value.assign(2 * indices, 0.5);
  convergence.course.half_width.assign(2 * indices, 0.25);
  convergence.reached.assign(indices, 1);
  convergence.relative_half_width.assign(indices, 0.5);
  convergence.samples.assign(result.factors(), 2000);
  write_result(path, example.study, example.poses, result, example.facts);
}

void write_shard_seed(const std::string& path) {
  const test::Example example;
  const std::vector<Bytes> stages{Bytes(5, std::byte{3}), Bytes(7, std::byte{1})};
  write_shard(path, example.study, example.poses, {1, 3}, stages, example.facts);
}

void write_cases_seed(const std::string& path) {
  test::Example example;
  example.study.analysis.kind = &evaluate::kStudy;
  std::vector<evaluate::ErrorCase>& cases = asked_of<evaluate::CaseOptions>(example.study.analysis).cases;
  cases = {{"fine", {1e-3, 2e-3, 3e-3}}, {"coarse", {4e-3, 5e-3, 6e-3}}, {"none", {0.0, 0.0, 0.0}}};
  const evaluate::Evaluation result =
      evaluate::evaluation_of_cases(example.solves(cases.size()), cases, example.study.model(), NotConverged::include);
  write_result(path, example.study, example.poses, result, example.facts);
}

void write_identification_seed(const std::string& path) {
  test::Example example;
  identification::Result result = example.identification();
  result.single_max(1, 1) = 1.0;
  write_result(path, example.study, example.poses, result, example.facts);
}

void write_results(const std::string& folder) {
  write_sensitivity_seed(folder + "/sensitivity");
  write_cases_seed(folder + "/cases");
  write_identification_seed(folder + "/identification");
  test::Example().write_monte_carlo(folder + "/monte_carlo");
  test::Example().write_machines(folder + "/machines");
  test::Example().write_sobol(folder + "/sobol");
  test::Example of_tolerances;
  of_tolerances.write_allocation(folder + "/allocation", of_tolerances.allocation());
  test::Example().write_coupling(folder + "/coupling");
  write_convergence_seed(folder + "/convergence");
  write_shard_seed(folder + "/shard");
}

/// Writes a checkpoint without its digest, which the fuzz target appends. seed: index of the study in small_studies().
void write_checkpoint(const std::string& path, std::uint64_t seed, std::span<const Bytes> stages) {
  const CheckpointIdentity identity{.poesy_version = "0.2.0",
                                    .git_commit = "abc",
                                    .model = "fake",
                                    .seed = seed,
                                    .samples = 2300,
                                    .study = "[poses]\ncount = 2\n",
                                    .poses = "0123",
                                    .shard = "2/5"};
  Bytes file;
  write_checkpoint(identity, {2.5, 0.5}, test::sources_of(stages),
                   [&](std::span<const std::byte> piece) { file.insert(file.end(), piece.begin(), piece.end()); });
  file.resize(file.size() - 32);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
}

/// Writes two checkpoints for each small study: from the middle and from the end of its run.
void write_checkpoints(const std::string& folder) {
  const std::span<const test::SmallStudy> studies = test::small_studies();
  for (std::size_t k = 0; k < studies.size(); ++k) {
    const std::vector<std::vector<Bytes>> states = test::states_of(studies[k]);
    write_checkpoint(folder + "/" + studies[k].name + "_begun", k, states[states.size() / 2]);
    write_checkpoint(folder + "/" + studies[k].name + "_done", k, states.back());
  }
  write_checkpoint(folder + "/empty", 0, {});
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  const std::string folder = argv[1];
  for (const char* name : {"/result", "/checkpoint"}) std::filesystem::create_directories(folder + name);
  write_results(folder + "/result");
  write_checkpoints(folder + "/checkpoint");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
