#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/sobol/constant.h"
#include "engine/kinds/sobol/kind.h"
#include "engine/kinds/sobol/panel.h"
#include "engine/run/rounds.h"
#include "engine/run/unit_fold.h"
#include "engine/stats/merge_tree.h"

namespace poesy::sobol {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The index of a group that decides when adaptive sampling ends: ST, or the Shapley effect if the group gets no ST.
Estimate headline_index(const IndexPanel& panel, const PanelSums& sums, std::size_t r, std::size_t g,
                        double conf_level) {
  return (panel.split[g] != 0 ? sums.shapley(r, g) : sums.aggregated(r, g).total).estimate(conf_level);
}

/// For each response, the largest index of a group (headline_index()), with the largest half-width of an interval of
/// any group. Adaptive sampling ends when these half-widths are small. Zero for a response that does not vary, so that
/// it causes no more samples. rounding: [rows] see row_rounding().
std::vector<Estimate> largest_of_responses(const IndexPanel& panel, const PanelSums& sums,
                                           std::span<const double> rounding, double conf_level) {
  const std::vector<std::uint8_t> varies = varying_quantities(panel, sums, rounding);
  std::vector<Estimate> list;
  for (std::size_t r = 0; r < panel.responses; ++r) {
    if (varies[r] == 0) {
      list.push_back({0.0, {0.0, 0.0}});
      continue;
    }
    double value = 0.0;
    double half_width = 0.0;
    for (std::size_t g = 0; g < panel.groups.size(); ++g) {
      const Estimate total = headline_index(panel, sums, r, g, conf_level);
      const double half = 0.5 * (total.interval.high - total.interval.low);
      value = std::max(value, total.value);
      half_width = std::isnan(half) ? kInfinity : std::max(half_width, half);
    }
    list.push_back({value, {value - half_width, value + half_width}});
  }
  return list;
}

/// Merges the units of a panel (samples A, B and their mixtures) in their order. With random draws, each unit is a leaf
/// of the merge tree. In other designs a replicate is a leaf; its units are merged first.
struct PanelTree {
  const IndexPanel* panel;
  const PanelDesign* design;
  MergeTree<PanelSums> leaves = {};
  PanelSums open = {};  ///< sums of the replicate whose units are not yet all added

  std::size_t units_per_leaf() const { return design->independent() ? 1 : design->units_per_replicate(); }
  void add(std::size_t n, PanelSums&& found) {
    if (design->independent()) return leaves.add(n, std::move(found));
    if (n % units_per_leaf() == 0) {
      open = std::move(found);
    } else {
      open.merge(found);
    }
    if ((n + 1) % units_per_leaf() == 0) leaves.add(n / units_per_leaf(), open.as_one());
  }
  /// Reads or writes the sums of these units. In a design that is not random, each sample depends on the number of
  /// samples of the study, so a longer study cannot continue from these sums.
  void state(Archive& archive, const NumberRange& units) {
    archive.known(design->independent() ? 0 : panel->samples, "is of a design with other samples");
    leaves.state(archive, design->units() / units_per_leaf(), PanelSums(*panel));
    const bool follows = leaves.empty() || leaves.end() == units.end / units_per_leaf();
    archive.expect(follows, "has lost some of its samples");
    if (units.end % units_per_leaf() == 0) return;
    if (archive.reads()) open = PanelSums(*panel);
    archive.object(open);
  }
};

/// The job of a UnitFold (run/unit_fold.h), whose units are samples (A, B and their mixtures, IndexPanel) at all poses.
struct PanelJob {
  const Plan& plan;
  const Model& model;
  const Study& study;
  IndexPanel panel{study, plan.poses().size()};
  std::vector<double> rounding = row_rounding(panel, plan, model);  ///< [rows] rounding of each row, see row_rounding()
  PanelDesign design{plan, asked_of<Options>(study.analysis)};

  static constexpr std::string_view kName = "panel";
  std::vector<std::uint64_t> sizes() const {
    return {panel.quantities(), panel.groups.size(), panel.poses, panel.pairs.size(), panel.shapley ? 1U : 0U};
  }
  /// The units that a shard solves. In a design that is not random, they form whole replicates.
  NumberRange units(const Shard& shard) const {
    const std::size_t each = sums().units_per_leaf();
    const NumberRange leaves = shard.of(design.units() / each);
    return {leaves.first * each, leaves.end * each};
  }
  std::uint64_t expected(std::size_t n) const {
    return std::uint64_t{design.unit(n).count} * panel.solves_of_sample() * panel.poses;
  }
  auto worker() const {
    return [&design = design, evaluate = PanelEvaluator(plan, model, panel, design)](std::size_t n) mutable {
      return evaluate(design.unit(n));
    };
  }
  PanelSums unit(std::size_t) const { return PanelSums(panel); }
  static SolveCounts solves(std::size_t, const PanelSums& unit) { return total_of(unit.solves); }
  PanelTree sums() const { return {&panel, &design}; }
  Rounds rounds() const {
    const std::vector<std::size_t>& headline = study.model().headline;
    return {plan,
            {panel.responses, headline.empty() ? all_positions(panel.responses) : headline, study.analysis.conf_level,
             std::vector<double>(panel.responses, 0.0)}};
  }
  std::size_t samples() const { return plan.samples(); }
  std::size_t units_for(std::size_t samples) const {
    return design.independent() ? design.units_for(samples) : design.units();
  }
  bool is_whole(std::size_t n) const {
    return !design.independent() || design.unit(n).count == PanelDesign::kUnitSamples;
  }
  std::vector<Estimate> estimates(const PanelTree& sums, const PanelSums* last) const {
    MergeTree<PanelSums> all = sums.leaves;
    if (last != nullptr) all.add(all.end(), *last);
    return largest_of_responses(panel, std::move(all).total(), rounding, study.analysis.conf_level);
  }
};

template <class Indices, class... Positions>
void set(Indices& indices, const IndexSums& sums, Positions... at) {
  indices.S1.set(sums.first.estimate(indices.conf_level), at...);
  indices.ST.set(sums.total.estimate(indices.conf_level), at...);
}

/// Sets all numbers of response r in the result.
void set_response(const IndexPanel& panel, const PanelSums& sums, std::size_t r, Result& found) {
  const double level = found.aggregated.conf_level;
  for (std::size_t g = 0; g < panel.groups.size(); ++g) {
    set(found.aggregated, sums.aggregated(r, g), r, g);
    if (panel.shapley) found.Sh.set(sums.shapley(r, g).estimate(level), r, g);
    for (std::size_t m = 0; m < panel.poses; ++m) {
      set(found.at_poses, sums.at_poses(r, g, m), r, g, m);
      found.n(r, g, m) = sums.at_poses(r, g, m).total.count();
    }
  }
  for (std::size_t m = 0; m < panel.poses; ++m) {
    const Moments& moments = sums.moments(r, m);
    found.mean(r, m) = moments.count() == 0 ? kNaN : moments.mean();
    found.variance(r, m) = moments.variance();
  }
  for (std::size_t k = 0; k < panel.pairs.size(); ++k) {
    const auto [i, j] = panel.pairs[k];
    const Estimate estimate = sums.pairs(r, k).estimate(level);
    found.S2.set(estimate, r, i, j);
    found.S2.set(estimate, r, j, i);
  }
  found.without_sign(r) = sums.least(r) >= 0.0 ? 1 : 0;
}

/// A result with arrays of the right lengths, whose numbers are not yet set.
Result room_for(const IndexPanel& panel, double level) {
  const std::size_t responses = panel.responses;
  const std::size_t groups = panel.groups.size();
  Result found;
  found.at_poses.conf_level = found.aggregated.conf_level = found.of_vectors.conf_level = level;
  make_room({responses, groups, panel.poses}, found.at_poses.S1, found.at_poses.ST, found.n);
  make_room({responses, groups}, found.aggregated.S1, found.aggregated.ST);
  make_room({panel.vectors.size(), groups}, found.of_vectors.S1, found.of_vectors.ST);
  make_room({responses, panel.poses}, found.mean, found.variance);
  make_room({responses}, found.without_sign);
  if (!panel.pairs.empty()) make_room({responses, groups, groups}, found.S2);
  if (panel.shapley) make_room({responses, groups}, found.Sh);
  return found;
}

std::string members_text(const ErrorGroup& group, const Study& study) {
  std::string text;
  for (const std::size_t p : group.members) {
    text += (text.empty() ? "" : " ") + study.model().factors[study.analysis.factors[p].value].name;
  }
  return text;
}

Result result_of(const Study& study, const IndexPanel& panel, const PanelSums& sums, std::span<const double> rounding) {
  Result found = room_for(panel, study.analysis.conf_level);
  found.joined = asked_of<Options>(study.analysis).groups_by != GroupsBy::none;
  for (const ErrorGroup& group : panel.groups) {
    found.group_names.push_back(group.name);
    found.group_members.push_back(members_text(group, study));
  }
  for (const SignedVector& vector : panel.vectors) found.vectors.push_back(vector.name);
  for (std::size_t r = 0; r < panel.responses; ++r) set_response(panel, sums, r, found);
  for (std::size_t v = 0; v < panel.vectors.size(); ++v) {
    for (std::size_t g = 0; g < panel.groups.size(); ++g) {
      set(found.of_vectors, sums.aggregated(panel.responses + v, g), v, g);
    }
  }
  leave_out_constant(panel, sums, rounding, found);
  found.solves = sums.solves;
  if (asked_of<Options>(study.analysis).design != Design::random)
    return found;  // `poesy replay` cannot repeat samples of other designs
  for (std::size_t m = 0; m < panel.poses; ++m) {
    append_failures(0, PoseIndex(m), sums.failed[m], found.failures);
    found.failed_samples += sums.failures[m];
  }
  return found;
}

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  const Plan plan(run.study, run.poses);
  const PanelJob job{plan, run.model, run.study};
  UnitFold work(job, run.options);
  if (!fold(work, run.options) || run.options.shard || !run.makes_result()) return std::nullopt;
  std::optional<ConvergenceResult> convergence = work.convergence();
  Result found = result_of(run.study, job.panel, std::move(work).sums().leaves.total(), job.rounding);
  found.convergence = std::move(convergence);
  return StudyResult{std::move(found), std::nullopt, {}};
}

/// A panel for estimating the time of a run: one of its units is solved at some poses.
struct Trial {
  Trial(const Study& study, const Model& model, const PoseSet& poses)
      : plan(study, poses),
        panel(study, poses.size()),
        design(plan, asked_of<Options>(study.analysis)),
        evaluate(plan, model, panel, design) {}

  double solves() const {
    return static_cast<double>(plan.samples()) * static_cast<double>(panel.solves_of_sample() * panel.poses);
  }

  Plan plan;
  IndexPanel panel;
  PanelDesign design;
  PanelEvaluator evaluate;
};

MemoryOutlook memory_of(const IndexPanel& panel, const PanelDesign& design) {
  const std::size_t cells = panel.responses * panel.groups.size() * panel.poses;
  const std::size_t sums = cells * sizeof(IndexSums);
  const std::size_t nodes = 1 + MergeTree<PanelSums>::most_nodes(design.units());
  const std::size_t numbers = sobol_bytes({{"response", panel.responses},
                                           {"group", panel.groups.size()},
                                           {"pose", panel.poses},
                                           {"vector", panel.vectors.size()},
                                           {"other", panel.pairs.empty() ? 0 : panel.groups.size()}});
  return {nodes * sums, nodes * sums, numbers, numbers};
}

Outlook sobol_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const auto trial = std::make_shared<Trial>(study, model, poses);
  const auto try_some = [trial](double at) {
    const auto pose = static_cast<std::size_t>(at * static_cast<double>(trial->panel.poses));
    return static_cast<double>(trial->evaluate.try_pose(trial->design.unit(0), PoseIndex(pose))) / trial->solves();
  };
  return {.solves = fmt::format("{} poses x {} samples x {} solves (A, B, {}) = {:.0f} solves", poses.size(),
                                study.analysis.samples, trial->panel.solves_of_sample(),
                                counted_things(trial->panel.solves_of_sample() - 2, "mixtures"), trial->solves()),
          .memory = memory_of(trial->panel, trial->design),
          .shared = {WorkOutlook{try_some, 1.0}},
          .by_one = {},
          .least = least_share(trial->plan)};
}

/// The largest number of shards: the number of replicates of a design, or of units of random draws.
std::size_t most_shards(const Study& study, std::size_t) {
  const Options& asked = asked_of<Options>(study.analysis);
  if (asked.design != Design::random) return asked.replicates;
  return (study.analysis.samples + PanelDesign::kUnitSamples - 1) / PanelDesign::kUnitSamples;
}

}  // namespace

constinit const Kind kKind{
    .study = kStudy, .run = {run_study_of_kind, sobol_outlook, most_shards}, .file = kFile, .report = kReport};

}  // namespace poesy::sobol
