#include "engine/kinds/identification/identification.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/identification/kind.h"

namespace poesy::identification {
namespace {

/// An error takes part in the deformation by several errors if setting it to zero reduces the deformation to at most
/// this share.
constexpr double kReduced = 0.1;

/// Errors of one frame that are solved together, as indices among the study's factors.
using FrameErrors = std::vector<std::size_t>;

/// [poses] The deformation, SI, at each pose with one set of errors; NaN if the pose is not solved.
using Deformations = std::vector<double>;

class Identification {
 public:
  Identification(const Analysis& analysis, const ModelDescription& model, const SolveTable& solve)
      : analysis_(&analysis), asked_(&asked_of<Options>(analysis)), model_(&model), solve_(&solve) {
    POESY_EXPECTS(model.deformation.has_value());
    const std::size_t factors = analysis.factors.size();
    const std::size_t groups = asked_->groups.size();
    found_.sizes = asked_->groups;
    found_.rounding = model.deformation->rounding;
    make_room({groups, factors}, found_.single_below, found_.not_solved, found_.coupled_below, found_.coupled_reduced,
              found_.single_max, found_.single_by_group);
    make_room({factors}, found_.single, found_.coupled);
  }

  std::optional<Result> operator()() {
    if (!single_stage() || !coupled_stage()) return std::nullopt;
    for (std::size_t g = 0; g < found_.groups(); ++g) {
      for (std::size_t p = 0; p < found_.factors(); ++p) {
        found_.single(p) |= found_.single_by_group(g, p);
        found_.coupled(p) |= found_.coupled_by_group(g, p);
      }
    }
    return std::move(found_);
  }

 private:
  /// A set of errors that are solved together, at the pair of sizes `group`; all other errors are zero.
  struct ErrorSet {
    std::size_t group;
    FrameErrors members;
  };

  double size(std::size_t group, std::size_t p) const {
    const bool is_length = model_->factors[analysis_->factors[p].value].dimension == Dimension::length;
    return is_length ? asked_->groups[group].linear : asked_->groups[group].angular;
  }

  /// Solves all sets of errors at all poses and returns the deformations of each. Returns nothing if the run was
  /// stopped.
  std::optional<std::vector<Deformations>> solve(const std::vector<ErrorSet>& trials) {
    ErrorTable table{analysis_->factors, {}, trials.size()};
    table.values.resize(trials.size() * found_.factors());
    const ArrayView<double, axis::Sample, axis::Factor> values(table.values, {trials.size(), found_.factors()});
    for (std::size_t t = 0; t < trials.size(); ++t) {
      for (const std::size_t p : trials[t].members) values(t, p) = size(trials[t].group, p);
    }
    const auto solved_table = (*solve_)(table);
    if (!solved_table) return std::nullopt;
    found_.poses = solved_table->poses();
    found_.required_poses = std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(std::llround(asked_->pose_share * static_cast<double>(found_.poses))));
    found_.solves.merge(solved_table->total());
    std::vector<Deformations> deformations(trials.size(), Deformations(found_.poses));
    for (std::size_t m = 0; m < found_.poses; ++m) {
      for (std::size_t t = 0; t < trials.size(); ++t) {
        const bool is_known = solved(solved_table->status(m, t));
        deformations[t][m] = is_known ? solved_table->response(model_->deformation->response, m, t) : kNaN;
      }
    }
    return deformations;
  }

  std::uint64_t below(const Deformations& deformations) const {
    return static_cast<std::uint64_t>(
        // A comparison with NaN is false, so a pose that is not solved is not counted.
        std::ranges::count_if(deformations, [&](double value) { return value <= found_.rounding; }));
  }

  bool deforms(std::uint64_t below_rounding) const { return below_rounding < found_.required_poses; }

  bool single_stage() {
    std::vector<ErrorSet> trials;
    for (std::size_t g = 0; g < found_.groups(); ++g) {
      for (std::size_t p = 0; p < found_.factors(); ++p) trials.push_back({g, {p}});
    }
    const auto deformations = solve(trials);
    if (!deformations) return false;
    for (std::size_t t = 0; t < trials.size(); ++t) {
      const Deformations& values = (*deformations)[t];
      const std::size_t g = trials[t].group;
      const std::size_t p = trials[t].members.front();
      double largest = kNaN;
      std::uint64_t missing = 0;
      for (const double value : values) {
        largest = std::fmax(largest, value);  // fmax ignores NaN
        missing += std::isnan(value) ? 1 : 0;
      }
      found_.single_below(g, p) = below(values);
      found_.single_max(g, p) = largest;
      found_.not_solved(g, p) = missing;
      found_.single_by_group(g, p) = deforms(found_.single_below(g, p)) ? 1 : 0;
    }
    found_.coupled_by_group = found_.single_by_group;
    return true;
  }

  /// For each frame, the errors that do not deform the mechanism alone at this pair of sizes. Frames with fewer than
  /// two such errors are left out.
  std::vector<FrameErrors> frames(std::size_t group) const {
    std::map<std::pair<std::size_t, std::size_t>, FrameErrors> by_frame;
    for (std::size_t p = 0; p < found_.factors(); ++p) {
      const Factor& factor = model_->factors[analysis_->factors[p].value];
      if (found_.single_by_group(group, p) == 0) by_frame[{factor.limb, factor.frame}].push_back(p);
    }
    std::vector<FrameErrors> list;
    for (auto& [frame, unit] : by_frame) {
      if (unit.size() > 1) list.push_back(std::move(unit));
    }
    return list;
  }

  bool coupled_stage() {
    std::vector<ErrorSet> together;
    for (std::size_t g = 0; g < found_.groups(); ++g) {
      for (FrameErrors& errors : frames(g)) together.push_back({g, std::move(errors)});
    }
    const auto deformations = solve(together);
    if (!deformations) return false;
    for (std::size_t t = 0; t < together.size(); ++t) {
      const std::uint64_t count = below((*deformations)[t]);
      for (const std::size_t p : together[t].members) {
        found_.coupled_below(together[t].group, p) = count;
      }
      if (deforms(count) && !split(together[t], (*deformations)[t])) return false;
    }
    return true;
  }

  /// For errors that together deform the mechanism, finds which of them take part, and which pairs of them deform it.
  /// with_all: deformations by all of them together. Returns false if the run was stopped.
  bool split(const ErrorSet& whole, const Deformations& with_all) {
    std::vector<ErrorSet> trials;
    for (const std::size_t p : whole.members) {
      ErrorSet without = whole;
      std::erase(without.members, p);
      trials.push_back(std::move(without));
    }
    const auto deformations = solve(trials);
    if (!deformations) return false;
    FrameErrors taking_part;
    for (std::size_t n = 0; n < whole.members.size(); ++n) {
      const std::uint64_t count = reduced(with_all, (*deformations)[n]);
      found_.coupled_reduced(whole.group, whole.members[n]) = count;
      if (count >= found_.required_poses) taking_part.push_back(whole.members[n]);
    }
    return find_couplings(whole, taking_part);
  }

  static std::uint64_t reduced(const Deformations& with_all, const Deformations& without) {
    std::uint64_t count = 0;
    for (std::size_t m = 0; m < with_all.size(); ++m) count += without[m] <= kReduced * with_all[m] ? 1 : 0;
    return count;
  }

  bool find_couplings(const ErrorSet& whole, const FrameErrors& taking_part) {
    std::vector<ErrorSet> pairs;
    for (std::size_t a = 0; a < whole.members.size(); ++a) {
      for (std::size_t b = a + 1; b < whole.members.size(); ++b) {
        pairs.push_back({whole.group, {whole.members[a], whole.members[b]}});
      }
    }
    const auto deformations = solve(pairs);
    if (!deformations) return false;
    const std::size_t known = found_.couplings.size();
    for (std::size_t t = 0; t < pairs.size(); ++t) {
      const std::uint64_t count = below((*deformations)[t]);
      if (!deforms(count)) continue;
      const FrameErrors& pair = pairs[t].members;
      found_.couplings.push_back({whole.group, pair[0], pair[1], found_.poses - count});
      name_members(whole.group, pair[0], pair[1]);
    }
    if (found_.couplings.size() > known) return true;
    // No pair deforms the mechanism, so more than two errors are needed to deform it.
    for (const std::size_t p : taking_part) found_.coupled_by_group(whole.group, p) = 1;
    return true;
  }

  void name_members(std::size_t group, std::size_t a, std::size_t b) {
    const auto is_angle = [&](std::size_t p) {
      return model_->factors[analysis_->factors[p].value].dimension == Dimension::angle;
    };
    const bool alike = is_angle(a) == is_angle(b);
    if (alike || is_angle(a)) found_.coupled_by_group(group, a) = 1;
    if (alike || is_angle(b)) found_.coupled_by_group(group, b) = 1;
  }

  const Analysis* analysis_;
  const Options* asked_;
  const ModelDescription* model_;
  const SolveTable* solve_;
  Result found_;
};

/// Identifies which errors of the study deform the mechanism. Returns nothing if the run was stopped.
std::optional<Result> run_identification(const Study& study, const Model& model, const PoseSet& poses,
                                         const RunOptions& options) {
  return identify(study.analysis, model.description(), [&](const ErrorTable& errors) {
    return run_evaluation(model, study.solver, poses, errors, Pairing::every_pose_with_every_row, options,
                          Outcomes::responses);
  });
}

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  auto result = run_identification(run.study, run.model, run.poses, run.options);
  if (!result || !run.makes_result()) return std::nullopt;
  return StudyResult{*std::move(result), std::nullopt, {}};
}

Outlook identification_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const std::size_t errors = study.analysis.factors.size();
  const std::size_t groups = asked_of<Options>(study.analysis).groups.size();
  const std::size_t solves = errors * groups * poses.size();
  const std::size_t outcomes = solves * outcome_bytes(study.model(), Outcomes::responses);
  return {.solves = counted_things(errors, "errors x ") + counted_things(groups, "groups x ") +
                    counted_things(poses.size(), "poses = ") + counted_things(solves, "solves, and more for couplings"),
          .memory = {.accumulators = outcomes, .state = outcomes},
          .shared = {table_work(
              poses,
              [&](const PoseSet& some) { static_cast<void>(run_identification(study, model, some, {.threads = 1})); })},
          .by_one = {}};
}

}  // namespace

std::optional<Result> identify(const Analysis& analysis, const ModelDescription& model, const SolveTable& solve) {
  return Identification(analysis, model, solve)();
}

constinit const Kind kKind{
    .study = kStudy, .run = {run_study_of_kind, identification_outlook, nullptr}, .file = kFile, .report = kReport};

}  // namespace poesy::identification
