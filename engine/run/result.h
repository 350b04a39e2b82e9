#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/model/pose_set.h"
#include "engine/model/status.h"

namespace poesy {

/// How solves ended and what they cost, summed over samples.
struct SolveCounts {
  std::array<std::uint64_t, kStatusNames.size()> by_status{};
  std::uint64_t iterations = 0;
  std::uint32_t most_iterations = 0;

  std::uint64_t total() const;
  /// Samples that did not reach their fixed point.
  std::uint64_t not_converged() const;
  void add(SolveStatus status, std::uint32_t sample_iterations);
  void merge(const SolveCounts& other);
};

/// What a sensitivity study found: R responses, P varied factors, M poses; SI; NaN where undefined.
struct SensitivityResult {
  std::size_t responses = 0;
  std::size_t factors = 0;
  std::size_t poses = 0;
  double conf_level = 0.95;

  std::vector<double> local;           ///< [R x P x M] Du et al. 2022, Eqs. 51-52
  std::vector<double> local_ci_low;    ///< [R x P x M]
  std::vector<double> local_ci_high;   ///< [R x P x M]
  std::vector<double> count;           ///< [R x P x M] samples behind local, whole numbers
  std::vector<double> mean;            ///< [R x P x M]
  std::vector<double> std;             ///< [R x P x M]
  std::vector<double> global;          ///< [R x P] Eqs. 53-54
  std::vector<double> global_ci_low;   ///< [R x P]
  std::vector<double> global_ci_high;  ///< [R x P]
  std::vector<SolveCounts> solves;     ///< [P x M]

  SolveCounts total() const;
};

/// What `evaluate` found for M poses and S samples each (S = 1 when paired): SI.
struct EvaluationResult {
  std::size_t poses = 0;
  std::size_t samples = 0;
  std::size_t responses = 0;
  std::size_t details = 0;  ///< D, components of all details

  std::vector<double> response;            ///< [R x M x S]
  std::vector<double> detail;              ///< [M x S x D]
  std::vector<SolveStatus> status;         ///< [M x S]
  std::vector<std::uint32_t> iterations;   ///< [M x S]
  std::vector<double> joint_displacement;  ///< [M x joints], nominal

  SolveCounts total() const;
};

/// Facts about one run that differ from machine to machine and are not part of the result's content.
struct RunFacts {
  std::string created;  ///< UTC, ISO 8601
  std::string host;
  std::string cpu;
  std::size_t threads = 1;
  std::size_t ranks = 1;
  double wall_seconds = 0.0;
  std::uint64_t solves = 0;
};

}  // namespace poesy
