#pragma once

#include <array>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "engine/kinds/allocation/result.h"
#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/identification/identification.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/result_file.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/kinds/sensitivity/tolerances.h"
#include "engine/kinds/sobol/result.h"
#include "engine/result/result_file.h"
#include "engine/run/evaluation.h"
#include "engine/stats/main_effects.h"
#include "tests/support/fake_model.h"
#include "tests/support/kinds.h"

namespace poesy::test {

/// Results of the fake mechanism with made-up numbers. A script in another language can check them, because the number
/// tells its index: element (r, p, m) of array k is 1000 k + 100 r + 10 p + m / 8; the last element is NaN. The
/// description has two details with the same list of components, so that they share an axis in the file.
class Example {
 public:
  static constexpr std::size_t kPoses = 4;
  static constexpr std::size_t kSamples = 3;

  Example() {
    CatalogEntry& entry = catalog_.front();
    for (const char* name : {"twist_21", "twist_32"}) {
      entry.description.details.push_back(
          {name, {"omega_x", "omega_y", "v_z"}, "rad,rad,m", "a twist between two limbs"});
    }
    study.title = "Beispiel für Dateien";  // not ASCII
    study.mechanism.entry = &entry;
    study.mechanism.geometry = {FakeModel::kArm};
    study.poses.count = kPoses;
    study.poses.workspace = {{-0.3, -0.18}, {-0.5, 0.5}, {-0.6, 0.6}};
    study.errors.by_factor.assign(3, Distribution::normal(0.001));
    study.errors.by_factor[1] = Distribution::uniform(0.5);
    study.analysis.kind = &sensitivity::kStudy;
    study.analysis.factors = {FactorIndex(1), FactorIndex(0)};
    study.analysis.samples = 100;
    std::vector<double> coordinates;
    for (std::size_t m = 0; m < kPoses; ++m) {
      const double step = static_cast<double>(m);
      coordinates.insert(coordinates.end(), {-0.25 + step / 64.0, step / 8.0, -step / 4.0});
    }
    poses.poses = PoseSet(3, coordinates);
    poses.condition = {4.0, 4.5, 5.0, std::numeric_limits<double>::infinity()};
    poses.rejected = {{"q_1 above 250 mm", 12}, {"out of reach: z must be negative", 3}};
    facts = {.created = "2024-05-06T07:08:09Z",
             .host = "somewhere",
             .cpu = "a processor",
             .threads = 2,
             .ranks = 1,
             .wall_seconds = 0.5,
             .checkpoint_seconds = 0.25,
             .solves = 800};
  }
  Example(const Example&) = delete;
  Example& operator=(const Example&) = delete;

  sensitivity::Result sensitivity() const {
    sensitivity::Result result;
    result.conf_level = 0.95;
    std::size_t array = 0;
    for (auto* values : {&result.local, &result.local_ci_low, &result.local_ci_high, &result.mean, &result.std}) {
      *values = {{2, 2, kPoses}, nan_at_end(numbered(array++, kPoses))};
    }
    for (auto* values : {&result.global, &result.global_ci_low, &result.global_ci_high}) {
      *values = {{2, 2}, nan_at_end(numbered(array++, 1))};
    }
    std::size_t after_history = array + 3;
    for (auto* values : {&result.global_corrected, &result.global_corrected_ci_low, &result.global_corrected_ci_high}) {
      *values = {{2, 2}, nan_at_end(numbered(after_history++, 1))};
    }
    result.rounding = {{2}, {1e-15, 2e-15}};
    result.index_change = {{2, 2}, {-0.25, 0.125, 0.0, std::numeric_limits<double>::quiet_NaN()}};
    result.count = sensitivity::Result::Cells<std::uint64_t>({2, 2, kPoses}, 97);
    result.background = Array<double, axis::Response, axis::Pose>({2, kPoses});
    double next = 0.0;
    for (double& value : result.background) value = next++ / 16.0;
    result.solves = Array<SolveCounts, axis::Factor, axis::Pose>({2, kPoses});
    std::uint64_t cell = 0;
    for (SolveCounts& solves : result.solves) {
      solves = {.by_status = {90 - cell, 7, 2, 1, cell}, .iterations = 700 + cell, .most_iterations = 50};
      ++cell;
    }
    sensitivity::set_references(study, result);
    if (!study.analysis.adaptive) {
      result.history = {{50, 100}, numbered(array, 2), numbered(array + 1, 2), numbered(array + 2, 2)};
      result.history->ci_high.back() = std::numeric_limits<double>::quiet_NaN();
    }
    result.failures = {{0, PoseIndex(1), {SampleIndex(7), SolveStatus::iteration_cap}},
                       {1, PoseIndex(3), {SampleIndex(99), SolveStatus::non_finite}}};
    return result;
  }
  /// A function that fills an array of given lengths with numbers in steps of `step`, continuing from `next`. The last
  /// element becomes NaN.
  static auto filler(double& next, double step = 0.125) {
    return [&next, step]<class Numbers>(Numbers& numbers, const typename Numbers::Lengths& lengths) {
      make_room(lengths, numbers);
      for (double& number : numbers) number = next += step;
      numbers.all().back() = std::numeric_limits<double>::quiet_NaN();
    };
  }

  /// A Monte Carlo result with two quantiles. Sets the study to match. The numbers count up through all arrays.
  monte_carlo::Result monte_carlo() {
    study.analysis.kind = &monte_carlo::kStudy;
    asked_of<monte_carlo::Options>(study.analysis).quantiles = {0.05, 0.995};
    monte_carlo::Result result;
    result.conf_level = 0.9;
    result.quantile_relative_error = 1.0 / 512.0;
    result.levels = asked_of<monte_carlo::Options>(study.analysis).quantiles;
    double next = 0.0;
    const auto fill = filler(next);
    for (auto* values :
         {&result.mean, &result.mean_ci_low, &result.mean_ci_high, &result.std, &result.min, &result.max}) {
      fill(*values, {2, kPoses});
    }
    fill(result.quantiles, {2, kPoses, 2});
    for (auto* values : {&result.overall_mean, &result.overall_std, &result.overall_min, &result.overall_max}) {
      fill(*values, {2});
    }
    fill(result.overall_quantiles, {2, 2});
    fill(result.rms, {2, kPoses});
    fill(result.overall_rms, {2});
    for (auto* values : {&result.quantiles_ci_low, &result.quantiles_ci_high}) fill(*values, {2, kPoses, 2});
    for (auto* values : {&result.overall_quantiles_ci_low, &result.overall_quantiles_ci_high}) fill(*values, {2, 2});
    result.histogram_edges = {{2, 5}, {0.0, 1.0, 2.0, 4.0, 4.0, 1.0, 2.0, 3.0, 4.0, 5.0}};
    result.histogram_counts = {{2, 4}, {100, 200, 82, 0, 300, 0, 60, 6}};
    asked_of<monte_carlo::Options>(study.analysis).judge = Judge::share;
    asked_of<monte_carlo::Options>(study.analysis).share = 0.9973;
    study.analysis.limits = {{0, 0.5}, {1, 0.25}};
    fill(result.share_magnitude, {2, kPoses});
    result.verdicts = verdicts();
    result.count = {{2, kPoses}, {97, 96, 95, 94, 93, 92, 91, 90}};
    result.overall_count = {{2}, {382, 366}};
    for (std::size_t m = 0; m < kPoses; ++m) {
      result.solves.push_back({.by_status = {90 - m, 7, 2, 1, m}, .iterations = 700 + m, .most_iterations = 50});
    }
    result.failures = {{0, PoseIndex(2), {SampleIndex(0), SolveStatus::singular}}};
    fill(result.quantile_error, {2, kPoses});
    fill(result.overall_quantile_error, {2});
    result.effects.conf_level = result.conf_level;
    result.effects.s1_poses = {0, 2};
    next = 1000.0;
    fill(result.effects.bin_error, {2, kEffectBins});
    fill_effects(result.effects.effects, fill);
    return result;
  }

  /// A Monte Carlo result of 200 machines that are judged by their yield. The second response has a limit.
  monte_carlo::Result machines() {
    monte_carlo::Result result = monte_carlo();
    study.analysis.draws = Draws::per_machine;
    monte_carlo::Options& asked = asked_of<monte_carlo::Options>(study.analysis);
    asked.judge = Judge::yield;
    asked.yield = 0.9;
    asked.share = 0.0;
    study.analysis.limits = {{1, 0.25}};
    result.share_magnitude = {};
    monte_carlo::MachineResult& found = result.machines.emplace();
    found.conf_level = result.conf_level;
    double next = 2000.0;
    const auto fill = filler(next);
    for (monte_carlo::MachineValues* values : {&found.largest, &found.rms}) {
      for (auto* list :
           {&values->mean, &values->mean_ci_low, &values->mean_ci_high, &values->std, &values->min, &values->max}) {
        fill(*list, {2});
      }
      values->count = {{2}, {200, 198}};
      for (auto* list : {&values->quantiles, &values->quantiles_ci_low, &values->quantiles_ci_high})
        fill(*list, {2, 2});
      values->quantile_error = {{2}, {0.5, 0.25}};
      values->histogram_edges = result.histogram_edges;
      values->histogram_counts = result.histogram_counts;
    }
    fill_effects(found.effects_on_largest, fill);
    monte_carlo::YieldResult& yield = found.yield.emplace();
    yield.conf_level = result.conf_level;
    yield.value = 0.75;
    yield.ci_low = 0.7;
    yield.ci_high = 0.8;
    yield.rejects = 50;
    yield.machines = 200;
    yield.unsolved = 2;
    yield.unsolved_pass = 0.755;
    yield.unsolved_pass_ci_low = 0.705;
    yield.unsolved_pass_ci_high = 0.805;
    yield.unsolved_pass_rejects = 49;
    for (auto* list : {&yield.by_response, &yield.by_response_ci_low, &yield.by_response_ci_high}) fill(*list, {2});
    fill(yield.worst_pose_share, {2, kPoses});
    for (auto* list : {&yield.gradient, &yield.gradient_ci_low, &yield.gradient_ci_high, &yield.change,
                       &yield.change_ci_low, &yield.change_ci_high}) {
      fill(*list, {2});
    }
    fill(yield.linear_share, {2});
    fill(yield.offset, {2});
    fill(yield.offset_share, {2});
    for (auto* list : {&yield.mean_square_share, &yield.mean_square_share_ci_low, &yield.mean_square_share_ci_high}) {
      fill(*list, {2, 2});
    }
    result.verdicts = {.judge = Judge::yield,
                       .limits = {{.response = 1,
                                   .limit = 0.25,
                                   .value = 0.5,
                                   .passed = false,
                                   .tried = 200,
                                   .within = 150,
                                   .pose = {},
                                   .row = {}}},
                       .yield = YieldVerdict{.asked = 0.9}};
    return result;
  }

  /// Fills the main effects of two errors on two responses. fill(array, lengths): fills an array with numbers.
  template <class Fill>
  static void fill_effects(monte_carlo::MainEffects& effects, const Fill& fill) {
    for (auto* list : {&effects.s1, &effects.s1_ci_low, &effects.s1_ci_high}) fill(*list, {2, 2});
    for (auto* list : {&effects.mean, &effects.ci_low, &effects.ci_high}) fill(*list, {2, 2, kEffectBins});
  }

  /// Verdicts on the limits of both responses: the first is kept, the second is exceeded at the last pose.
  static LimitVerdicts verdicts() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {.judge = Judge::share,
            .share = 0.9973,
            .limits = {{.response = 0,
                        .limit = 0.5,
                        .value = 0.375,
                        .passed = true,
                        .tried = 400,
                        .within = 382,
                        .pose = 2,
                        .row = {}},
                       {.response = 1,
                        .limit = 0.25,
                        .value = kInfinity,
                        .passed = false,
                        .tried = 400,
                        .within = 96,
                        .pose = kPoses - 1,
                        .row = {}}}};
  }

  using CouplingCurves = coupling::Result::Curves coupling::Result::*;
  static constexpr CouplingCurves kCurves[] = {&coupling::Result::effect,          &coupling::Result::sum,
                                               &coupling::Result::interaction,     &coupling::Result::worst_case,
                                               &coupling::Result::root_sum_square, &coupling::Result::cancellation};
  using CouplingSummary = coupling::Result::Summary<double> coupling::Result::*;
  static constexpr CouplingSummary kSummaries[] = {
      &coupling::Result::effect_max,          &coupling::Result::interaction_max, &coupling::Result::worst_case_max,
      &coupling::Result::root_sum_square_max, &coupling::Result::opposed_share,   &coupling::Result::cancellation_max};

  /// A coupling result with two sizes and two sources. Sets the study to match. The numbers count up through all
  /// arrays.
  coupling::Result coupling() {
    Analysis& analysis = study.analysis;
    analysis.kind = &coupling::kStudy;
    analysis.factors = {FactorIndex(0), FactorIndex(2)};
    analysis.asked = coupling::Options{{1e-4, 2e-4}, {}, {}, {{"D", {FactorIndex(2)}}, {"E", {FactorIndex(0)}}}};
    coupling::Result result;
    result.size_names = {"0.1 mm", "0.2 mm"};
    result.sources = {"D", "E"};
    result.subsets = {"D", "E", "D+E"};
    result.linear = {{2}, {1e-4, 2e-4}};
    result.angular = Array<double, axis::Size>({2}, std::numeric_limits<double>::quiet_NaN());
    double next = 0.0;
    const auto fill = [&](auto& values, const auto& lengths) {
      values = std::remove_cvref_t<decltype(values)>(lengths);
      for (double& value : values) value = next += 0.125;
      values.all().back() = std::numeric_limits<double>::quiet_NaN();
    };
    const coupling::Result::Curves::Lengths all{2, 2, 3, kPoses};
    const coupling::Result::Summary<double>::Lengths over_poses{2, 2, 3};
    for (const CouplingCurves member : kCurves) fill(result.*member, all);
    for (const CouplingSummary member : kSummaries) fill(result.*member, over_poses);
    result.count = coupling::Result::Summary<std::uint64_t>(over_poses);
    for (auto* places : {&result.effect_max_pose, &result.cancellation_max_pose, &result.worst_case_max_pose}) {
      *places = coupling::Result::Summary<std::int64_t>(over_poses);
    }
    result.worst_case_signs = decltype(result.worst_case_signs)({2, 2, 3, 2});
    for (std::size_t cell = 0; cell < 12; ++cell) {
      const auto [r, z, k] = result.count.positions(cell);
      result.count(r, z, k) = kPoses - cell % 2;
      result.effect_max_pose(r, z, k) = static_cast<std::int64_t>(cell) - 1;
      result.cancellation_max_pose(r, z, k) = static_cast<std::int64_t>(cell % 3);
      result.worst_case_max_pose(r, z, k) = static_cast<std::int64_t>(cell % kPoses);
      result.worst_case_signs(r, z, k, 0) = cell % 2 == 0 ? 1 : -1;
      result.worst_case_signs(r, z, k, 1) = cell % 3 == 0 ? 0 : 1;
    }
    fill(result.first_order_sum, all);
    fill(result.first_order_sum_max, over_poses);
    result.rounding = {{2, 2}, {1e-14, 2e-14, 3e-14, 4e-14}};
    result.corners = decltype(result.corners)({2, 3, kPoses});
    result.unsolved_corners = result.corners;
    for (std::size_t cell = 0; cell < result.corners.size(); ++cell) {
      result.corners.all()[cell] = 20 + cell;
      result.unsolved_corners.all()[cell] = cell % 2;
    }
    result.unsolved_pose = {{2, 3}, {-1, 1, 2, -1, 0, 3}};
    result.unsolved_signs = {{2, 3, 2}, {0, 0, 1, 0, -1, 1, 0, 0, 1, -1, -1, -1}};
    result.solves = decltype(result.solves)({2, kPoses});
    for (std::size_t cell = 0; cell < 2 * kPoses; ++cell) {
      result.solves.all()[cell] = {.by_status = {3, 0, cell, 1, 0}, .iterations = 8 + cell, .most_iterations = 5};
    }
    return result;
  }

  /// A comparison of two fidelities for two responses and two errors.
  static sensitivity::FidelityResult fidelity(std::vector<std::string> fidelities) {
    sensitivity::FidelityResult fidelity;
    fidelity.fidelities = std::move(fidelities);
    fidelity.linearity = 0.02;
    fidelity.global = {{2, 2}, {1.0, 2.0, 3.0, 4.0}};
    fidelity.discrepancy = {{2, 2}, {0.5, 0.25, -0.125, 0.0}};
    fidelity.relative_discrepancy = {{2, 2}, {0.25, 0.125, -0.0625, std::numeric_limits<double>::infinity()}};
    fidelity.nonlinearity = {{2, 2}, {0.5, 0.0625, 0.03125, 0.75}};
    fidelity.linear = {{2}, {1, 0}};
    fidelity.not_converged = {{2, 4}, {0, 1, 2, 3, 4, 5, 6, 7}};
    return fidelity;
  }

  /// An identification of two errors at two groups of sizes. Sets the study to match.
  identification::Result identification() {
    study.analysis.kind = &identification::kStudy;
    asked_of<identification::Options>(study.analysis).groups = {{"large", 5e-3, 5e-3}, {"small", 5e-5, 4e-4}};
    identification::Result result;
    result.sizes = asked_of<identification::Options>(study.analysis).groups;
    result.poses = kPoses;
    result.rounding = 1.5e-14;
    result.required_poses = 3;
    result.single_below = {{2, 2}, {0, 4, 1, 4}};
    result.single_max = {{2, 2}, {1e-3, 0.0, 2e-3, std::numeric_limits<double>::infinity()}};
    result.not_solved = {{2, 2}, {0, 0, 1, 0}};
    result.coupled_below = {{2, 2}, {0, 2, 0, 3}};
    result.coupled_reduced = {{2, 2}, {0, 4, 0, 1}};
    result.single_by_group = {{2, 2}, {1, 0, 1, 0}};
    result.coupled_by_group = {{2, 2}, {1, 1, 1, 0}};
    result.single = {{2}, {1, 0}};
    result.coupled = {{2}, {1, 1}};
    result.couplings = {{0, 0, 1, 4}, {1, 1, 0, 2}};
    result.solves.by_status = {5, 4, 3, 2, 1};
    return result;
  }

  /// An evaluation of two cases with all details. Sets the study to match.
  evaluate::Evaluation cases() {
    study.analysis.kind = &evaluate::kStudy;
    std::vector<evaluate::ErrorCase>& cases = asked_of<evaluate::CaseOptions>(study.analysis).cases;
    cases = {{"fine", {1e-3, 2e-3, 3e-3}}, {"coarse", {4e-3, 5e-3, 6e-3}}};
    return evaluate::evaluation_of_cases(solves(2), cases, study.model(), NotConverged::include);
  }

  evaluate::Evaluation evaluation(Pairing pairing) const {
    return evaluate::evaluation(solves(pairing == Pairing::row_by_row ? 1 : kSamples), errors(pairing), pairing,
                                study.model());
  }

  /// Solves with made-up numbers that count up through each array.
  EvaluationResult solves(std::size_t samples) const {
    EvaluationResult result;
    result.response = decltype(result.response)({2, kPoses, samples});
    result.detail = decltype(result.detail)({kPoses, samples, 8});
    result.status = decltype(result.status)({kPoses, samples});
    result.iterations = decltype(result.iterations)({kPoses, samples});
    result.joint_displacement = decltype(result.joint_displacement)({kPoses, 2});
    const auto fill = [](auto& values, const auto& value) {
      for (std::size_t k = 0; k < values.size(); ++k) values.all()[k] = value(k);
    };
    fill(result.response, [](std::size_t k) { return static_cast<double>(k) / 8.0; });
    fill(result.detail, [](std::size_t k) { return static_cast<double>(k); });
    fill(result.status, [](std::size_t k) { return static_cast<SolveStatus>(k % 5); });
    fill(result.iterations, [](std::size_t k) { return static_cast<std::uint32_t>(10 + k); });
    fill(result.joint_displacement, [](std::size_t k) { return static_cast<double>(k) / 4.0; });
    return result;
  }

  ErrorTable errors(Pairing pairing) const {
    const std::size_t rows = pairing == Pairing::row_by_row ? kPoses : kSamples;
    ErrorTable table{.factors = {FactorIndex(2), FactorIndex(1)}, .values = {}, .rows = rows};
    for (std::size_t k = 0; k < 2 * rows; ++k) table.values.push_back(static_cast<double>(k) / 1024.0);
    return table;
  }

  void write_sensitivity(const std::string& path) const {
    poesy::write_result(path, study, poses, sensitivity(), facts);
  }
  /// A Sobol' result of two errors, each a group of its own, with their interaction and two vectors.
  sobol::Result sobol() {
    study.analysis.kind = &sobol::kStudy;
    asked_of<sobol::Options>(study.analysis).second_order = true;
    sobol::Result result;
    for (const FactorIndex factor : study.analysis.factors) {
      result.group_names.push_back(study.model().factors[factor.value].name);
    }
    result.group_members = result.group_names;
    const std::size_t groups = result.groups();
    result.vectors = {"twist_21_omega", "twist_21_v"};
    double next = 0.0;
    const auto fill = filler(next, 0.0078125);
    const auto fill_shares = [&]<class Shares>(Shares& shares, const typename Shares::Lengths& lengths) {
      for (auto* values : {&shares.value, &shares.ci_low, &shares.ci_high}) fill(*values, lengths);
    };
    const auto fill_indices = [&](auto& indices, const auto& lengths) {
      indices.conf_level = 0.9;
      fill_shares(indices.S1, lengths);
      fill_shares(indices.ST, lengths);
    };
    fill_indices(result.at_poses, std::array{std::size_t{2}, groups, kPoses});
    fill_indices(result.aggregated, std::array{std::size_t{2}, groups});
    fill_indices(result.of_vectors, std::array{std::size_t{2}, groups});
    fill_shares(result.S2, {2, groups, groups});
    for (auto* values : {&result.mean, &result.variance}) fill(*values, {2, kPoses});
    make_room({2, groups, kPoses}, result.n);
    std::iota(result.n.begin(), result.n.end(), 100);
    result.without_sign = {{2}, {0, 1}};
    result.solves.resize(kPoses);
    for (SolveCounts& solves : result.solves) {
      for (std::size_t s = 0; s < 5; ++s) solves.add(SolveStatus::converged, 3);
    }
    result.solves[1].add(SolveStatus::iteration_cap, 50);
    result.failures = {{0, PoseIndex(1), {SampleIndex(2), SolveStatus::iteration_cap}}};
    result.failed_samples = 1;
    return result;
  }
  /// A certified allocation of three parts with two stages. Only the second response has a limit.
  allocation::Result allocation() {
    study.analysis.kind = &allocation::kStudy;
    study.analysis.asked = allocation::Options();
    study.analysis.draws = Draws::per_machine;
    study.analysis.limits = {{1, 3e-5}};
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    using Names = std::vector<std::string>;
    allocation::Result result;
    result.part_names = {"bars", "hinge", "plate"};
    result.part_members = {{3}, Names{"delta_1 delta_2", "epsilon_1", "delta_3"}};
    result.part_unit = {{3}, Names{"m", "rad", "m"}};
    result.tolerance = {{3}, {1.23456789e-5, 1.7453292519943295e-3, 2.5e-5}};
    result.sigma = {{3}, {4.11522e-6, 5.8177641733144e-4, 7.5e-6}};
    result.sigmas = {{3}, {3.0, 3.0, 3.0}};
    result.shift = {{3}, {0.0, 0.0, 2.5e-6}};
    result.cost = {{3}, {2.5, 7.0, 0.5}};
    result.share = {{3}, {0.25, 0.7, 0.05}};
    result.mean_square_share = {{3}, {0.5, 0.375, 0.125}};
    result.error_mean_square_share = {{2}, {0.375, 0.45}};  // the error of the hinge, and that of the bars
    result.bound = {{3}, {0, 2, 3}};
    result.chosen = {{3}, Names{"", "grinding", "IT7"}};
    result.coarser_yield = {{3}, {0.9965, 0.9971, kNone}};
    result.multiplier = {{2, kPoses}, {kNone, kNone, kNone, kNone, 0.0, 0.0, 2e5, 1e5}};
    result.limit_use = {{2, kPoses}, {kNone, kNone, kNone, kNone, 0.25, 0.5, 0.75, 1.0}};
    result.limit = {{2}, {kNone, 3e-5}};
    result.saving = {{2}, {kNone, 0.09}};
    result.deciding_share = {{2, kPoses}, {kNone, kNone, kNone, kNone, 0.0, 0.25, 0.5, 0.25}};
    result.fixed_share = {{2}, {kNone, 0.25}};
    result.total_cost = 10.0;
    result.lower_bound = 9.995;
    result.gap = 0.005;
    result.wanted_yield = 0.9973;
    result.confidence = 0.95;
    result.stages = {{"linear", 9.0, 8.75, 0.3333, 0, 0}, {"scaled to the yield", 10.0, 9.995, 0.3, 20000, 48}};
    result.stage_tolerance = {{2, 3}, {1.5e-5, 1.9e-3, 2.5e-5, 1.23456789e-5, 1.7453292519943295e-3, 2.5e-5}};
    result.design_machines = 20000;
    result.design_rejects = 48;
    result.design_most = 49;
    result.certificate_seed = 12345678901234567890U;
    result.certificate_most = 366;
    result.certificate = {.decision = YieldVerdict::Decision::kept,
                          .asked = 0.9973,
                          .conf_level = 0.95,
                          .value = 147640.0 / 148000.0,
                          .ci_low = 0.9973,
                          .ci_high = 0.9978,
                          .machines = 148000,
                          .rejects = 360,
                          .unsolved = 2};
    result.calibrated = true;
    result.curve_yield = {0.99, 0.9973, 0.999};
    result.curve_yield_cost = {{3}, {8.0, 10.0, 12.5}};
    result.curve_factor = {0.5, 1.0};
    result.curve_factor_cost = {{2}, {20.0, 10.0}};
    result.certificate_study = "format = \"poesy-study\"\n# limits < 30 um\n";
    result.solves = Array<SolveCounts, axis::Pose>({kPoses});
    for (std::size_t m = 0; m < kPoses; ++m) {
      result.solves(m) = {.by_status = {147990 - m, 7, 2, 1, m}, .iterations = 700000, .most_iterations = 50};
    }
    result.failures = {{0, PoseIndex(2), {SampleIndex(7), SolveStatus::singular}}};
    return result;
  }
  void write_allocation(const std::string& path, const allocation::Result& result) const {
    poesy::write_result(path, study, poses, result, facts);
  }
  void write_monte_carlo(const std::string& path) {
    const monte_carlo::Result result = monte_carlo();
    poesy::write_result(path, study, poses, result, facts);
  }
  void write_machines(const std::string& path) {
    const monte_carlo::Result result = machines();
    poesy::write_result(path, study, poses, result, facts);
  }
  void write_sobol(const std::string& path) {
    const sobol::Result result = sobol();
    poesy::write_result(path, study, poses, result, facts);
  }
  void write_coupling(const std::string& path) {
    const coupling::Result result = coupling();
    poesy::write_result(path, study, poses, result, facts);
  }
  void write_cases(const std::string& path) {
    const evaluate::Evaluation result = cases();
    poesy::write_result(path, study, poses, result, facts);
  }
  void write_identification(const std::string& path) {
    const identification::Result result = identification();
    poesy::write_result(path, study, poses, result, facts);
  }
  void write_evaluation(const std::string& path, Pairing pairing) const {
    evaluate::write_evaluation(path, study, poses, errors(pairing).factors, evaluation(pairing), facts);
  }

  Study study;
  SelectedPoses poses;
  RunFacts facts;

 private:
  /// [2 x 2 x length] values that tell their index (see the class).
  static std::vector<double> numbered(std::size_t array, std::size_t length) {
    std::vector<double> values;
    for (std::size_t r = 0; r < 2; ++r) {
      for (std::size_t p = 0; p < 2; ++p) {
        for (std::size_t m = 0; m < length; ++m) {
          values.push_back(static_cast<double>(1000 * array + 100 * r + 10 * p) + static_cast<double>(m) / 8.0);
        }
      }
    }
    return values;
  }

  static std::vector<double> nan_at_end(std::vector<double> values) {
    values.back() = std::numeric_limits<double>::quiet_NaN();
    return values;
  }

  Catalog catalog_ = fake_catalog();
};

}  // namespace poesy::test
