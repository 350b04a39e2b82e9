#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/sobol/constant.h"
#include "engine/kinds/sobol/kind.h"
#include "engine/kinds/sobol/panel.h"
#include "engine/run/fold.h"
#include "engine/run/rounds.h"
#include "engine/stats/merge_tree.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kKind = 6;  ///< no other state begins with this number

/// The group's ST, or its Shapley effect where it has no ST.
Estimate headline_index(const IndexPanel& panel, const PanelSums& sums, std::size_t r, std::size_t g,
                        double conf_level) {
  return (panel.split[g] != 0 ? sums.shapley(r, g) : sums.aggregated(r, g).total).estimate(conf_level);
}

/// How sure the indices of a panel are: of each response the largest ST, and the largest half-width of any; zero where
/// it does not vary, so that no sample is taken for it. rounding: of each row.
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

/// All units of a panel, in their order: the work of fold(). Of random draws each unit is a leaf of a tree; a replicate
/// of another design is merged unit by unit, and then is one leaf. With adaptive samples there is a round for each
/// milestone.
class PanelWork {
 public:
  PanelWork(const Plan& plan, const Model& model, const Study& study, const RunOptions& options)
      : plan_(plan),
        model_(model),
        panel_(study, plan.poses().size()),
        rounding_(row_rounding(panel_, plan, model)),
        design_(plan, asked_of<SobolOptions>(study.analysis)),
        units_per_leaf_(design_.independent() ? 1 : design_.units_per_replicate()),
        leaves_(options.shard.value_or(Shard()).of(design_.units() / units_per_leaf_)),
        conf_level_(study.analysis.conf_level),
        rule_{panel_.responses,
              study.model().headline.empty() ? all_positions(panel_.responses) : study.model().headline, conf_level_,
              std::vector<double>(panel_.responses, 0.0)},
        rounds_(plan, rule_),
        next_(leaves_.first * units_per_leaf_) {}

  std::size_t begin_round() {
    begun_ = next_;
    return end() - next_;
  }
  PanelEvaluator worker() const { return {plan_, model_, panel_, design_}; }
  PanelSums solve(PanelEvaluator& evaluate, std::size_t n) const { return evaluate(design_.unit(begun_ + n)); }
  SolveCounts merge(std::size_t, const PanelSums& found) {
    if (next_ % units_per_leaf_ == 0) {
      open_ = found;
    } else {
      open_.merge(found);
    }
    ++next_;
    if (!is_open()) close();
    return total_of(found.solves);
  }
  static void write(std::size_t, const PanelSums& found, ByteWriter& to) { found.write(to); }
  PanelSums read(std::size_t, ByteReader& from) const { return PanelSums::read(from, panel_); }
  SolveCounts solved() const {
    SolveCounts sum = closed_;
    if (is_open()) sum.merge(total_of(open_.solves));
    return sum;
  }
  std::uint64_t left() const {
    std::uint64_t samples = 0;
    for (std::size_t n = next_; n < end(); ++n) samples += design_.unit(n).count;
    return rounds_.expected_left(solved(), samples * panel_.solves_of_sample() * panel_.poses);
  }
  void write_state(ByteWriter& to) const {
    rounds_.write_state(to);
    for (const std::uint64_t number : sizes()) to.number(number);
    to.number(plan_.samples());
    to.number(next_);
    to.number(is_open() ? 1 : 0);
    closed_.write(to);
    tree_.write(to);
    if (is_open()) open_.write(to);
  }
  void restore(std::span<const std::byte> state) {
    ByteReader from(state);
    rounds_ = Rounds(plan_, rule_);
    rounds_.restore(from);
    if (from.left() == 0) throw BytesError("is cut off");
    tree_ = {};
    closed_ = {};
    while (from.left() > 0) restore_one(from);
  }
  bool next_round() {
    return rounds_.go_on([&](std::size_t) { return largest_of_responses(panel_, sums(), rounding_, conf_level_); });
  }

  const IndexPanel& panel() const { return panel_; }
  std::span<const double> rounding() const { return rounding_; }
  std::optional<ConvergenceResult> convergence() const { return rounds_.result(); }
  /// Everything merged so far. Precondition: a leaf was.
  PanelSums sums() const {
    MergeTree<PanelSums> all = tree_;
    if (is_open()) all.add(all.end(), open_);
    return std::move(all).total();
  }

 private:
  /// Where this round ends.
  std::size_t end() const {
    return plan_.adaptive() ? design_.units_for(rounds_.samples(0)) : leaves_.end * units_per_leaf_;
  }
  /// Whether what was merged last is no whole leaf: a part of a replicate, or a unit that a longer study makes larger.
  bool is_open() const {
    if (next_ % units_per_leaf_ != 0) return true;
    return design_.independent() && next_ > 0 && design_.unit(next_ - 1).count < PanelDesign::kUnitSamples;
  }
  /// Makes a leaf of what is open.
  void close() {
    closed_.merge(total_of(open_.solves));
    tree_.add(next_ / units_per_leaf_ - 1, design_.independent() ? std::move(open_) : open_.as_one());
  }
  /// What a state begins with.
  std::array<std::uint64_t, 6> sizes() const {
    return {kKind,        panel_.quantities(), panel_.groups.size(),
            panel_.poses, panel_.pairs.size(), panel_.shapley ? 1U : 0U};
  }
  /// Samples of a design that is not random belong together, so a longer study has others and cannot go on.
  void restore_one(ByteReader& from) {
    for (const std::uint64_t expected : sizes()) {
      if (from.number() != expected) throw BytesError("is the state of another kind or size of study");
    }
    const bool longer = from.number_up_to(plan_.samples()) < plan_.samples();
    if (longer && !design_.independent()) throw BytesError("is of a design with other samples");
    next_ = static_cast<std::size_t>(from.number_up_to(design_.units()));
    const bool has_open = from.number_up_to(1) == 1;
    closed_.merge(SolveCounts::read(from));
    const auto read_sums = [&](ByteReader& bytes, std::size_t, std::size_t) { return PanelSums::read(bytes, panel_); };
    tree_.read(from, design_.units() / units_per_leaf_, read_sums);
    if (has_open) open_ = PanelSums::read(from, panel_);
    if (has_open && longer) --next_;  // the shorter study's last unit, of which this one has more
    const bool open = has_open && !longer;
    const std::size_t closed_units = design_.independent() && open ? next_ - 1 : next_;
    const bool follows = tree_.empty() || tree_.end() == closed_units / units_per_leaf_;
    if (open != is_open() || !follows) throw BytesError("has lost some of its samples");
  }

  const Plan& plan_;
  const Model& model_;
  IndexPanel panel_;
  std::vector<double> rounding_;  ///< of each row as row_rounding gives it
  PanelDesign design_;
  std::size_t units_per_leaf_;
  NumberRange leaves_;  ///< of this shard
  double conf_level_;
  Rounds::Rule rule_;
  Rounds rounds_;
  std::size_t next_;  ///< unit to be merged
  std::size_t begun_ = 0;
  PanelSums open_;  ///< of the leaf that is not complete
  MergeTree<PanelSums> tree_;
  SolveCounts closed_;  ///< of the tree
};

template <class Indices, class... Positions>
void set(Indices& indices, const IndexSums& sums, Positions... at) {
  indices.S1.set(sums.first.estimate(indices.conf_level), at...);
  indices.ST.set(sums.total.estimate(indices.conf_level), at...);
}

/// What the result says of one response.
void set_response(const IndexPanel& panel, const PanelSums& sums, std::size_t r, SobolResult& found) {
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

/// With room for what is found.
SobolResult room_for(const IndexPanel& panel, double level) {
  const std::size_t responses = panel.responses;
  const std::size_t groups = panel.groups.size();
  SobolResult found;
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

SobolResult result_of(const Study& study, const IndexPanel& panel, const PanelSums& sums,
                      std::span<const double> rounding) {
  SobolResult found = room_for(panel, study.analysis.conf_level);
  found.joined = asked_of<SobolOptions>(study.analysis).groups_by != GroupsBy::none;
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
  if (asked_of<SobolOptions>(study.analysis).design != Design::random) return found;  // others have no addresses
  for (std::size_t m = 0; m < panel.poses; ++m) {
    append_failures(0, PoseIndex(m), sums.failed[m], found.failures);
    found.failed_samples += sums.failures[m];
  }
  return found;
}

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  const Plan plan(run.study, run.poses);
  PanelWork work(plan, run.model, run.study, run.options);
  if (!fold(work, run.options) || run.options.shard || !run.makes_result()) return std::nullopt;
  SobolResult found = result_of(run.study, work.panel(), work.sums(), work.rounding());
  found.convergence = work.convergence();
  return StudyResult{std::move(found), std::nullopt, {}};
}

/// The panel of an outlook, tried pose by pose.
struct Trial {
  Trial(const Study& study, const Model& model, const PoseSet& poses)
      : plan(study, poses),
        panel(study, poses.size()),
        design(plan, asked_of<SobolOptions>(study.analysis)),
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

/// A shard takes whole replicates of a design, or units of random draws.
std::size_t most_shards(const Study& study, std::size_t) {
  const SobolOptions& asked = asked_of<SobolOptions>(study.analysis);
  if (asked.design != Design::random) return asked.replicates;
  return (study.analysis.samples + PanelDesign::kUnitSamples - 1) / PanelDesign::kUnitSamples;
}

}  // namespace

constinit const Kind kSobolKind{.study = kSobolStudy,
                                .run = {run_study_of_kind, sobol_outlook, most_shards},
                                .file = kSobolFile,
                                .report = kSobolReport};

}  // namespace poesy
