#include "engine/kinds/coupling/coupling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/kinds/coupling/kind.h"
#include "engine/kinds/coupling/worst_case.h"
#include "engine/result/result_parts.h"
#include "engine/run/evaluation.h"
#include "engine/run/response_rounding.h"
#include "engine/run/result.h"
#include "engine/stats/indices.h"

namespace poesy::coupling {
namespace {

using PatternChoice = ErrorPattern::Choice;

bool takes(const ErrorPattern& pattern, const Factor& factor) {
  if (pattern.limbs == PatternChoice::some && factor.limb != pattern.limb) return false;
  if (pattern.components != PatternChoice::some || factor.axis.empty()) return true;
  return std::ranges::find(pattern.axes, factor.axis) != pattern.axes.end();
}

/// The limb, frame, dimension and axis that all errors of a block have in common. An element has its default value if
/// the pattern does not divide a source by it.
using BlockPlace = std::tuple<std::size_t, std::size_t, Dimension, std::string>;

BlockPlace place_of(const Factor& factor, const ErrorPattern& pattern) {
  BlockPlace place{};
  if (pattern.limbs == PatternChoice::independent) std::get<0>(place) = factor.limb;
  if (pattern.components != PatternChoice::independent) return place;
  return {std::get<0>(place), factor.frame, factor.dimension, factor.axis};
}

void add_subsets(std::size_t sources, std::size_t wanted, std::vector<std::size_t>& chosen,
                 std::vector<std::vector<std::size_t>>& subsets) {
  if (chosen.size() == wanted) {
    subsets.push_back(chosen);
    return;
  }
  for (std::size_t next = chosen.empty() ? 0 : chosen.back() + 1; next < sources; ++next) {
    chosen.push_back(next);
    add_subsets(sources, wanted, chosen, subsets);
    chosen.pop_back();
  }
}

void add_errors(const ErrorBlock& more, ErrorBlock& errors) {
  errors.insert(errors.end(), more.begin(), more.end());
  std::ranges::sort(errors);
}

/// The effects of a subset of sources on one response at one size and pose, SI. If an effect is NaN, all numbers that
/// depend on it are NaN, except `largest`.
struct Combination {
  double effect = 0.0;
  double sum = 0.0;
  double magnitudes = 0.0;  ///< sum of |effect of a source| over the sources
  double largest = 0.0;     ///< largest |effect of a source|
  double first_order_sum = 0.0;
  double squares = 0.0;

  double cancellation(double rounding) const {
    const double cancelled = magnitudes - std::abs(sum);
    return cancelled <= rounding ? 0.0 : cancelled / magnitudes;
  }
  bool is_known() const { return !std::isnan(effect) && !std::isnan(sum) && !std::isnan(first_order_sum); }
  bool is_opposed(double rounding) const { return largest - std::abs(sum) > rounding; }
};

/// Combines the effects of the rows that belong to a subset. effects: [rows] responses to the errors of each row of
/// CouplingRows at one size and pose.
Combination combination(const CouplingRows& rows, std::size_t subset, std::span<const double> effects) {
  Combination found;
  found.effect = effects[subset];
  for (const std::size_t source : rows.subsets[subset]) {
    found.sum += effects[source];
    found.magnitudes += std::abs(effects[source]);
    found.largest = std::max(found.largest, std::abs(effects[source]));
    for (const std::size_t row : rows.block_rows[source]) {
      found.first_order_sum += std::abs(effects[row]);
      found.squares += effects[row] * effects[row];
    }
  }
  return found;
}

/// The largest magnitude of the values at these poses, and the first pose with this magnitude; NaN and -1 if `poses` is
/// empty. values: [all poses].
std::pair<double, std::int64_t> largest_at(std::span<const double> values, std::span<const std::size_t> poses) {
  std::pair<double, std::int64_t> largest{kNaN, -1};
  for (const std::size_t m : poses) {
    const double value = std::abs(values[m]);
    if (largest.second < 0 || value > largest.first) largest = {value, static_cast<std::int64_t>(m)};
  }
  return largest;
}

/// The names of the sizes of errors: "0.1 mm", or "0.1 mm, 0.1 deg" with lengths and angles.
std::vector<std::string> size_names(const Options& study) {
  std::vector<std::string> names;
  for (std::size_t z = 0; z < study.sizes(); ++z) {
    std::string& name = names.emplace_back();
    if (!study.linear.empty()) name = readable_text({study.linear[z], Dimension::length});
    if (study.angular.empty()) continue;
    name += (name.empty() ? "" : ", ") + readable_text({study.angular[z], Dimension::angle});
  }
  return names;
}

/// [sizes] The sizes of errors of one dimension (lengths or angles); NaN if no error has this dimension.
Array<double, axis::Size> sizes_or_nan(const std::vector<double>& sizes, std::size_t count) {
  return {{count}, sizes.empty() ? std::vector<double>(count, kNaN) : sizes};
}

/// A result with the names on its axes, and with arrays of the right lengths whose numbers are not yet set.
Result empty_result(const Options& study, std::size_t responses, std::size_t poses) {
  Result found;
  found.size_names = size_names(study);
  found.sources = texts(study.sources, &ErrorSource::name);
  found.subsets = subset_names(study.sources);
  found.linear = sizes_or_nan(study.linear, study.sizes());
  found.angular = sizes_or_nan(study.angular, study.sizes());
  const std::size_t sizes = study.sizes();
  const std::size_t subsets = found.subsets.size();
  make_room({responses, sizes, subsets, poses}, found.effect, found.sum, found.first_order_sum, found.root_sum_square,
            found.cancellation);
  make_room({responses, sizes, subsets}, found.count, found.effect_max, found.effect_max_pose, found.interaction_max,
            found.first_order_sum_max, found.root_sum_square_max, found.opposed_share, found.cancellation_max,
            found.cancellation_max_pose);
  make_room({sizes, poses}, found.solves);
  return found;
}

/// Computes a result from the solved sets of errors: first the numbers at each pose for each response, size and subset,
/// then their summaries.
class Composer {
 public:
  Composer(EvaluationResult evaluation, const Options& study, const ModelDescription& model, NotConverged policy,
           Array<double, axis::Response, axis::Size> rounding)
      : evaluation_(std::move(evaluation)),
        rows_(coupling_rows(study, model)),
        policy_(policy),
        found_(empty_result(study, evaluation_.responses(), evaluation_.poses())) {
    POESY_EXPECTS(evaluation_.samples() == study.sizes() * rows_.errors.size());
    found_.rounding = std::move(rounding);
  }

  Result operator()() {
    for (std::size_t r = 0; r < evaluation_.responses(); ++r) {
      for (std::size_t z = 0; z < found_.size_names.size(); ++z) {
        const Effects effects = effects_of(r, z);
        for (std::size_t k = 0; k < found_.subsets.size(); ++k) add_subset(r, z, k, effects);
      }
    }
    for (std::size_t z = 0; z < found_.size_names.size(); ++z) {
      for (std::size_t m = 0; m < evaluation_.poses(); ++m) found_.solves(z, m) = solves_at(z, m);
    }
    // The interaction is computed last, after the outcomes are freed, so that less memory is needed.
    evaluation_ = {};
    make_room(found_.effect.lengths(), found_.interaction);
    std::ranges::transform(found_.effect, found_.sum, found_.interaction.begin(), std::minus());
    return std::move(found_);
  }

 private:
  /// [poses x rows] One response, SI, at each pose to each set of errors (CouplingRows::errors).
  using Effects = Array<double, axis::Pose, axis::Sample>;

  std::size_t rows() const { return rows_.errors.size(); }
  std::size_t sample(std::size_t z, std::size_t n) const { return z * rows() + n; }

  /// The effects of all sets of errors on response r at size z; NaN if a solve does not count in statistics (counts()).
  Effects effects_of(std::size_t r, std::size_t z) const {
    Effects effects({evaluation_.poses(), rows()});
    for (std::size_t m = 0; m < evaluation_.poses(); ++m) {
      for (std::size_t n = 0; n < rows(); ++n) {
        const bool is_known = counts(evaluation_.status(m, sample(z, n)), policy_);
        effects(m, n) = is_known ? evaluation_.response(r, m, sample(z, n)) : kNaN;
      }
    }
    return effects;
  }

  void add_subset(std::size_t r, std::size_t z, std::size_t k, const Effects& effects) {
    const double rounding = found_.rounding(r, z);
    std::vector<std::size_t> known;  // poses at which all numbers of the subset are known
    std::vector<double> interaction;
    std::size_t opposed = 0;
    for (std::size_t m = 0; m < evaluation_.poses(); ++m) {
      const Combination at = combination(rows_, k, effects.row(m));
      found_.effect(r, z, k, m) = at.effect;
      found_.sum(r, z, k, m) = at.sum;
      interaction.push_back(at.effect - at.sum);
      found_.first_order_sum(r, z, k, m) = at.first_order_sum;
      found_.root_sum_square(r, z, k, m) = std::sqrt(at.squares);
      found_.cancellation(r, z, k, m) = at.cancellation(rounding);
      if (!at.is_known()) continue;
      known.push_back(m);
      opposed += at.is_opposed(rounding) ? 1 : 0;
    }
    const auto largest = [&](const Result::Curves& curves) { return largest_at(curves.row(r, z, k), known); };
    std::tie(found_.effect_max(r, z, k), found_.effect_max_pose(r, z, k)) = largest(found_.effect);
    std::tie(found_.cancellation_max(r, z, k), found_.cancellation_max_pose(r, z, k)) = largest(found_.cancellation);
    found_.count(r, z, k) = known.size();
    found_.interaction_max(r, z, k) = largest_at(interaction, known).first;
    found_.first_order_sum_max(r, z, k) = largest(found_.first_order_sum).first;
    found_.root_sum_square_max(r, z, k) = largest(found_.root_sum_square).first;
    found_.opposed_share(r, z, k) =
        known.empty() ? kNaN : static_cast<double>(opposed) / static_cast<double>(known.size());
  }

  SolveCounts solves_at(std::size_t z, std::size_t m) const {
    SolveCounts solves;
    for (std::size_t n = 0; n < rows(); ++n) {
      solves.add(evaluation_.status(m, sample(z, n)), evaluation_.iterations(m, sample(z, n)));
    }
    return solves;
  }

  EvaluationResult evaluation_;
  CouplingRows rows_;
  NotConverged policy_;
  Result found_;
};

/// Reports the progress of the two stages of a run as one: first the table of errors, then the search for corners.
class TwoStages {
 public:
  TwoStages(const StudyRun& run, double expected_corners) : run_(run), expected_(expected_corners) {}

  RunOptions of_table() {
    RunOptions options = run_.options;
    options.progress = [this](const Progress& table) {
      before_ = table.before;
      report({table.solves, table.total + static_cast<std::uint64_t>(expected_), table.not_converged, table.before});
    };
    return options;
  }
  /// The options of the second stage, the search for corners. If the first stage did not report progress, the
  /// checkpoint contained all of it, so all its solves were made before this run.
  RunOptions of_corners() {
    RunOptions options = run_.options;
    const SolveCounts done = run_.checkpoints().solves();
    options.progress = [this, all = done.total(), failed = done.not_converged()](const Progress& corners) {
      report({all + corners.solves, all + corners.total, failed + corners.not_converged,
              before_.value_or(all) + corners.before});
    };
    return options;
  }

 private:
  void report(const Progress& progress) const {
    if (run_.options.progress) run_.options.progress(progress);
  }

  const StudyRun& run_;
  double expected_;
  std::optional<std::uint64_t> before_;
};

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  const Options& coupling = asked_of<Options>(run.study.analysis);
  const ModelDescription& model = run.model.description();
  const CornerTable corners(coupling, model);
  Array<double, axis::Response, axis::Size> rounding = coupling_rounding(coupling, run.model);
  const bool searches = coupling.worst_case == UnknownSigns::search;
  const NumberRange cells = run.options.shard.value_or(Shard()).of(coupling.sizes() * run.poses.size());
  const double at_each = searches ? expected_corners(corners, model.responses.size()) : 0.0;
  TwoStages stages(run, static_cast<double>(cells.end - cells.first) * at_each);
  auto evaluation = run_evaluation(run.model, run.study.solver, run.poses, coupling_table(coupling, model),
                                   Pairing::every_pose_with_every_row, stages.of_table(), Outcomes::responses);
  if (!run.checkpoints().complete()) return std::nullopt;
  std::optional<WorstCases> worst;
  if (searches) worst = run_worst_cases(run, corners, rounding, stages.of_corners());
  if (!evaluation || worst.has_value() != searches || !run.makes_result()) return std::nullopt;
  Result found = coupling_result(*std::move(evaluation), coupling, model, run.study.not_converged, std::move(rounding));
  if (worst) add_worst_cases(*std::move(worst), corners, found);
  return StudyResult{std::move(found), std::nullopt, {}};
}

/// The expected work of the search for corners, which is proportional to the number of sizes times poses.
WorkOutlook corner_work(const Study& study, const Model& model, const PoseSet& poses) {
  struct Trial {
    Trial(const Study& study, const Model& model, const PoseSet& poses)
        : table(asked_of<Options>(study.analysis), model.description()),
          rounding(coupling_rounding(asked_of<Options>(study.analysis), model)),
          search(model, study.solver, poses, table, rounding) {}

    CornerTable table;
    Array<double, axis::Response, axis::Size> rounding;
    CornerSearch search;
  };
  const auto trial = std::make_shared<Trial>(study, model, poses);
  const std::size_t sizes = trial->table.size_of_error.size();
  const std::size_t cells = sizes * poses.size();
  return {[trial, sizes, cells](double at) {
    const auto cell = static_cast<std::size_t>(at * static_cast<double>(cells));
    static_cast<void>(trial->search(cell / sizes, cell % sizes));
    return 1.0 / static_cast<double>(cells);
  }};
}

Outlook coupling_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const Options& coupling = asked_of<Options>(study.analysis);
  const CouplingRows rows = coupling_rows(coupling, study.model());
  const ErrorTable table = coupling_table(coupling, study.model());
  const std::size_t solves = table.rows * poses.size();
  const std::size_t outcomes = solves * outcome_bytes(study.model(), Outcomes::responses);
  const std::size_t cells = coupling.sizes() * poses.size();
  const std::size_t curve = sizeof(double) * cells * rows.subsets.size() * study.model().responses.size();
  const bool searches = coupling.worst_case == UnknownSigns::search;
  const std::size_t of_corners = searches ? curve + 2 * sizeof(std::uint64_t) * cells * rows.subsets.size() : 0;
  const std::size_t result = 6 * curve + of_corners + cells * sizeof(SolveCounts);
  // While the result is computed, the outcomes and all curves except the interaction are in memory. While the result is
  // written, its lists are freed one by one.
  const std::size_t composing = outcomes + 5 * curve + of_corners;
  Outlook expected{.solves = counted_things(coupling.sizes(), "sizes x ") +
                             counted_things(rows.errors.size(), "sets of errors x ") +
                             counted_things(poses.size(), "poses = ") + counted_things(solves, "solves"),
                   .memory = {.accumulators = composing - std::min(composing, result),
                              .state = outcomes + of_corners,
                              .result = result,
                              .file = 6 * curve + of_corners + cells * kSolverColumns},
                   .shared = {table_work(study, model, poses, table, Outcomes::responses)},
                   .by_one = {}};
  if (!searches) return expected;
  const double corners = static_cast<double>(cells) *
                         expected_corners(CornerTable(coupling, study.model()), study.model().responses.size());
  expected.solves += fmt::format(", and about {:.2g} for the worst cases", corners);
  expected.shared.push_back(corner_work(study, model, poses));
  return expected;
}

}  // namespace

std::vector<ErrorBlock> error_blocks(const ErrorSource& source, const ErrorPattern& pattern,
                                     const ModelDescription& model) {
  std::map<BlockPlace, ErrorBlock> by_place;
  for (const FactorIndex index : source.factors) {
    const Factor& factor = model.factors[index.value];
    if (!takes(pattern, factor)) continue;
    by_place[place_of(factor, pattern)].push_back(index);
  }
  std::vector<ErrorBlock> blocks;
  for (auto& [place, block] : by_place) {
    std::ranges::sort(block);
    blocks.push_back(std::move(block));
  }
  return blocks;
}

std::string_view name(UnknownSigns signs) { return signs == UnknownSigns::search ? "search" : "sum"; }

std::vector<std::vector<std::size_t>> source_subsets(std::size_t sources) {
  std::vector<std::vector<std::size_t>> subsets;
  std::vector<std::size_t> chosen;
  for (std::size_t wanted = 1; wanted <= sources; ++wanted) add_subsets(sources, wanted, chosen, subsets);
  return subsets;
}

CouplingRows coupling_rows(const Options& study, const ModelDescription& model) {
  CouplingRows rows;
  rows.subsets = source_subsets(study.sources.size());
  rows.errors.resize(rows.subsets.size());
  for (std::size_t s = 0; s < study.sources.size(); ++s) {
    const std::vector<ErrorBlock> blocks = error_blocks(study.sources[s], study.pattern, model);
    for (std::size_t k = 0; k < rows.subsets.size(); ++k) {
      if (std::ranges::find(rows.subsets[k], s) == rows.subsets[k].end()) continue;
      for (const ErrorBlock& block : blocks) add_errors(block, rows.errors[k]);
    }
    std::vector<std::size_t>& own = rows.block_rows.emplace_back();
    // Row s is the subset of source s alone. If the source has one block, this row has the block alone, so no row is
    // added.
    if (blocks.size() == 1) own.push_back(s);
    for (const ErrorBlock& block : blocks) {
      if (blocks.size() == 1) break;
      own.push_back(rows.errors.size());
      rows.errors.push_back(block);
    }
  }
  return rows;
}

std::vector<FactorIndex> coupling_factors(const Options& study, const ModelDescription& model) {
  std::vector<FactorIndex> factors;
  for (const ErrorSource& source : study.sources) {
    for (const ErrorBlock& block : error_blocks(source, study.pattern, model)) add_errors(block, factors);
  }
  return factors;
}

ErrorTable coupling_table(const Options& study, const ModelDescription& model) {
  const CouplingRows rows = coupling_rows(study, model);
  ErrorTable table{coupling_factors(study, model), {}, study.sizes() * rows.errors.size()};
  table.values.reserve(table.rows * table.factors.size());
  for (std::size_t z = 0; z < study.sizes(); ++z) {
    for (const ErrorBlock& errors : rows.errors) {
      for (const FactorIndex factor : table.factors) {
        const std::vector<double>& sizes = study.sizes_of(model.factors[factor.value].dimension);
        const bool is_set = std::ranges::binary_search(errors, factor);
        POESY_EXPECTS(!is_set || z < sizes.size());
        table.values.push_back(is_set ? sizes[z] : 0.0);
      }
    }
  }
  return table;
}

Result coupling_result(EvaluationResult evaluation, const Options& study, const ModelDescription& model,
                       NotConverged policy, Array<double, axis::Response, axis::Size> rounding) {
  return Composer(std::move(evaluation), study, model, policy, std::move(rounding))();
}

Array<double, axis::Response, axis::Size> coupling_rounding(const Options& study, const Model& model) {
  const std::vector<double> of_responses = response_rounding(model);
  Array<double, axis::Response, axis::Size> rounding({of_responses.size(), study.sizes()});
  for (std::size_t r = 0; r < of_responses.size(); ++r) {
    for (std::size_t z = 0; z < study.sizes(); ++z) {
      rounding(r, z) = size_rounding(of_responses[r], study.linear.empty() ? kNaN : study.linear[z],
                                     study.angular.empty() ? kNaN : study.angular[z]);
    }
  }
  return rounding;
}

std::vector<std::size_t> responses_without_effect(const Result& found) {
  std::vector<std::size_t> list;
  for (std::size_t r = 0; r < found.effect_max.length<axis::Response>(); ++r) {
    bool is_constant_at_all = true;
    for (std::size_t z = 0; z < found.size_names.size(); ++z) {
      is_constant_at_all = is_constant_at_all && is_constant(found.effect_max.row(r, z), found.rounding(r, z));
    }
    if (is_constant_at_all) list.push_back(r);
  }
  return list;
}

std::vector<std::string> subset_names(std::span<const ErrorSource> sources) {
  std::vector<std::string> names;
  for (const std::vector<std::size_t>& subset : source_subsets(sources.size())) {
    std::string& name = names.emplace_back();
    for (const std::size_t source : subset) name += (name.empty() ? "" : "+") + sources[source].name;
  }
  return names;
}

constinit const Kind kKind{
    .study = kStudy, .run = {run_study_of_kind, coupling_outlook, shards_by_pose}, .file = kFile, .report = kReport};

}  // namespace poesy::coupling
