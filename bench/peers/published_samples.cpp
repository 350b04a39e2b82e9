#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>

#include "bench/published_study.h"

namespace {

using namespace poesy;

/// A CSV file, open for writing.
class Table {
 public:
  Table(const std::filesystem::path& path, const char* header) : file_(std::fopen(path.c_str(), "w")) {
    if (file_ == nullptr) throw std::runtime_error("cannot write " + path.string());
    fmt::print(file_, "{}\n", header);
  }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;
  ~Table() { std::fclose(file_); }

  template <class... Cells>
  void row(const char* format, const Cells&... cells) {
    fmt::print(file_, fmt::runtime(format), cells...);
  }

 private:
  std::FILE* file_;
};

void write_background(const std::filesystem::path& path, const Study& study) {
  Table table(path, "factor,value");
  const std::vector<double> errors = background_errors(study.analysis.background, study.model());
  for (std::size_t f = 0; f < errors.size(); ++f) {
    if (errors[f] != 0.0) table.row("{},{:.17g}\n", study.model().factors[f].name, errors[f]);
  }
}

/// Writes samples of the published study (samples.csv), and poesy's solutions of them (answers.csv). cells: number of
/// cells (one error at one pose) from which samples are taken, spread over the study.
void write_samples(const std::filesystem::path& folder, const Study& study, std::size_t cells) {
  const auto model = build_model(study.mechanism);
  const Plan plan(study, select_poses(study.poses, *model).poses);
  const auto evaluator = model->evaluator(study.solver);
  Table samples(folder / "samples.csv", "z,beta,gamma,factor,value");
  Table answers(folder / "answers.csv", "solved,iterations,angular_deformation,linear_deformation");
  const std::size_t count = plan.samples();
  std::vector<double> values(count);
  std::vector<double> responses(study.model().responses.size() * count);
  std::vector<SolveStatus> status(count);
  std::vector<std::uint32_t> iterations(count);
  for (std::size_t n = 0; n < cells; ++n) {
    const WorkUnit unit = bench::scattered_unit(plan, n);
    const FactorIndex factor = plan.factors()[unit.slot];
    const auto pose = plan.poses()[unit.pose];
    fill_uniforms({plan.seed(), Purpose::error_samples, factor, unit.pose}, unit.first, values);
    plan.distributions()[unit.slot].transform(values);
    evaluator->evaluate({pose, plan.background(), std::span(&factor, 1), values, count},
                        {responses, status, iterations, {}});
    for (std::size_t b = 0; b < count; ++b) {
      samples.row("{:.17g},{:.17g},{:.17g},{},{:.17g}\n", pose[0], pose[1], pose[2],
                  study.model().factors[factor.value].name, values[b]);
      answers.row("{},{},{:.17g},{:.17g}\n", solved(status[b]) ? 1 : 0, iterations[b], responses[b],
                  responses[count + b]);
    }
  }
}

/// Writes what all_errors() of solver_bench solves with errors of 0.1 mm and 0.1 deg, as doubles in SI: all poses [158
/// x 3] and blocks of samples [8 x 71 x 1000]. The n-th solve is at pose 31 n mod 158, with block n mod 8.
void write_all_errors(const std::filesystem::path& folder) {
  const Study study = bench::platform_study(bench::kPublishedPoses, bench::kPublishedSamples);
  const PoseSet poses = select_poses(study.poses, *build_model(study.mechanism)).poses;
  const auto append = [&](const char* name, std::span<const double> numbers) {
    std::ofstream(folder / name, std::ios::binary | std::ios::app)
        .write(reinterpret_cast<const char*>(numbers.data()), static_cast<std::streamsize>(numbers.size_bytes()));
  };
  for (std::size_t m = 0; m < poses.size(); ++m) append("poses.f64", poses[PoseIndex(m)]);
  for (std::size_t n = 0; n < 8; ++n) {
    append("all_errors.f64", bench::samples_of_all_errors(study, 0.1, PoseIndex(n), bench::kPublishedSamples));
  }
}

}  // namespace

/// published_samples FOLDER CELLS SAMPLES writes part of the published study as CSV files, for solvers in other
/// languages. published_samples FOLDER writes the blocks of samples that solver_bench solves with all errors, for
/// bench/python_solver.py.
int main(int argc, char** argv) {
  if (argc != 4 && argc != 2) {
    fmt::print(stderr, "usage: published_samples FOLDER [CELLS SAMPLES (of each cell, at most 1000)]\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  if (argc == 2) {
    write_all_errors(folder);
    return 0;
  }
  const auto samples = static_cast<std::size_t>(std::strtoull(argv[3], nullptr, 10));
  Study study = bench::published_study(bench::kPublishedPoses, samples);
  study.solver.method = SolverOptions::Method::gauss_newton;
  std::filesystem::create_directories(folder);
  write_background(folder / "background.csv", study);
  write_samples(folder, study, static_cast<std::size_t>(std::strtoull(argv[2], nullptr, 10)));
}
