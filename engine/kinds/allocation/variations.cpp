#include "engine/kinds/allocation/variations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "engine/base/archive.h"
#include "engine/base/contract.h"
#include "engine/kinds/allocation/load_solver.h"
#include "engine/run/unit_fold.h"

namespace poesy::allocation {
namespace {

/// The largest number of machines in a piece of work. It is small so that a piece does not take long even if there are
/// many variations.
constexpr std::size_t kVariedAtOnce = 40;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// From experience, about one pose in this many decides for a machine (kDeciding). The number serves to estimate how
/// many solves remain.
constexpr std::size_t kOfPosesDecide = 4;

/// The machines to solve, and the variations with which they are solved. A piece of work solves some of the machines
/// with all variations.
struct VariedMachines {
  std::span<const std::uint32_t> machines;  ///< [machines] numbers of the machines
  std::span<const Variation> variations;    ///< variations, each of which is applied to every machine

  std::size_t pieces() const { return variations.empty() ? 0 : (machines.size() + kVariedAtOnce - 1) / kVariedAtOnce; }
  std::span<const std::uint32_t> machines_of(std::size_t piece) const {
    const std::size_t first = piece * kVariedAtOnce;
    return machines.subspan(first, std::min(kVariedAtOnce, machines.size() - first));
  }
  std::size_t loads_of(std::size_t piece) const { return variations.size() * machines_of(piece).size(); }
  /// The largest number of solves in a piece of work.
  std::uint64_t solves_of(std::size_t piece, std::size_t poses) const {
    return std::uint64_t{loads_of(piece) + machines_of(piece).size()} * poses;
  }
};

/// The loads (MachineLoads) of the machines of one piece of work, or of several pieces in their order.
struct VariedLoads {
  const VariedMachines* varied = nullptr;
  std::vector<double> load = {};  ///< [variations x machines] loads of each piece, one piece after the other
  std::uint64_t solves = 0;

  void add(std::size_t, const VariedLoads& later) {
    load.insert(load.end(), later.load.begin(), later.load.end());
    solves += later.solves;
  }
  void state(Archive& archive, const NumberRange& pieces) {
    std::size_t count = 0;
    for (std::size_t piece = pieces.first; piece < pieces.end; ++piece) count += varied->loads_of(piece);
    archive.number(solves);
    loads_state(archive, load, count);
  }
};

/// Computes the loads of the machines of a piece of work with all variations. Owns the scratch memory of one thread.
class VariationEvaluator : private LoadSolver {
 public:
  VariationEvaluator(const Plan& plan, const Model& model, const RelativeLimits& limits, const VariedMachines& varied,
                     const MachineCalibration* calibration)
      : LoadSolver(plan, model, limits, calibration), varied_(varied) {}

  VariedLoads operator()(std::size_t piece) {
    const auto machines = varied_.machines_of(piece);
    numbers_.assign(machines.begin(), machines.end());
    count_ = machines.size();
    if (limits_.any_over_poses() || is_calibrated()) return solve_all(piece);
    draw(numbers_);
    drawn_.assign(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(plan_->factors().size() * count_));
    VariedLoads found{&varied_, std::vector<double>(varied_.loads_of(piece)), 0};
    solve_without(found);
    change_.assign(varied_.variations.size(), 0.0);
    for (const bool deciding : {true, false}) {
      for (std::size_t m = 0; m < plan_->poses().size(); ++m) solve_at(m, deciding, found);
    }
    return found;
  }

 private:
  /// Solves all machines of a piece of work at all poses, once with each variation. Used for limits that are judged
  /// from several poses together, and for calibrated machines, whose calibration takes more time than the solves at all
  /// poses.
  VariedLoads solve_all(std::size_t piece) {
    VariedLoads found{&varied_, {}, varied_.loads_of(piece) * plan_->poses().size()};
    std::vector<double> loads(count_);
    for (const Variation& variation : varied_.variations) {
      loads.assign(count_, 0.0);
      missing_.assign(count_, 0);
      beyond_.assign(limits_.size() * count_, 0);
      draw(numbers_);
      begin_poses(count_);
      scale(variation);
      calibrate(numbers_);
      for (std::size_t m = 0; m < plan_->poses().size(); ++m) {
        draw_per_pose(PoseIndex(m), numbers_);
        add_pose(PoseIndex(m), loads, missing_, beyond_);
      }
      end_poses(loads, beyond_);
      for (std::size_t b = 0; b < count_; ++b) found.load.push_back(missing_[b] == 1 ? kInfinity : loads[b]);
    }
    return found;
  }

  /// Multiplies the drawn errors by the factors of a variation.
  void scale(const Variation& variation) {
    for (const auto& [p, factor] : variation) {
      for (std::size_t b = 0; b < count_; ++b) values_[p * count_ + b] *= factor;
    }
  }

  /// Solves the machines of a piece, without variations, at all poses.
  void solve_without(VariedLoads& found) {
    at_pose_.assign(plan_->poses().size() * count_, 0.0);
    load_.assign(count_, 0.0);
    for (std::size_t m = 0; m < plan_->poses().size(); ++m) {
      draw_per_pose(PoseIndex(m), numbers_);
      solve(m, std::span(at_pose_).subspan(m * count_, count_));
      for (std::size_t b = 0; b < count_; ++b) load_[b] = std::max(load_[b], at_pose_[m * count_ + b]);
    }
    found.solves += at_pose_.size();
  }

  /// Solves machines with variations at pose m. If `deciding` is true, solves the machines for which this pose decides,
  /// with all variations. Otherwise solves the other machines, but only with variations that have changed some load by
  /// more than half of kDeciding, because other poses may decide with these variations.
  void solve_at(std::size_t m, bool deciding, VariedLoads& found) {
    pairs_.clear();
    for (const std::size_t p : draw_per_pose(PoseIndex(m), numbers_)) {
      std::copy_n(&values_[p * count_], count_, &drawn_[p * count_]);
    }
    for (std::size_t pair = 0; pair < found.load.size(); ++pair) {
      const std::size_t b = pair % count_;
      const bool decides = at_pose_[m * count_ + b] >= load_[b] - kDeciding;
      if (decides != deciding || (!decides && change_[pair / count_] <= 0.5 * kDeciding)) continue;
      pairs_.push_back(pair);
      if (pairs_.size() == kMachinesOfPiece) solve_pairs(m, found);
    }
    if (!pairs_.empty()) solve_pairs(m, found);
  }

  /// Solves at pose m all pairs of a variation and a machine in `pairs_`, updates their loads, and empties `pairs_`.
  void solve_pairs(std::size_t m, VariedLoads& found) {
    const std::size_t count = pairs_.size();
    for (std::size_t p = 0; p < plan_->factors().size(); ++p) {
      for (std::size_t k = 0; k < count; ++k) values_[p * count + k] = drawn_[p * count_ + pairs_[k] % count_];
    }
    for (std::size_t k = 0; k < count; ++k) {
      for (const auto& [p, factor] : varied_.variations[pairs_[k] / count_]) values_[p * count + k] *= factor;
    }
    of_pairs_.assign(count, 0.0);
    solve(m, of_pairs_);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t pair = pairs_[k];
      found.load[pair] = std::max(found.load[pair], of_pairs_[k]);
      double& change = change_[pair / count_];
      change = std::max(change, std::abs(of_pairs_[k] - at_pose_[m * count_ + pair % count_]));
    }
    found.solves += count;
    pairs_.clear();
  }

  /// Computes the loads, at a pose, of the machines in the first columns of `values_`; infinite if a machine is not
  /// solved.
  void solve(std::size_t m, std::span<double> loads) {
    missing_.assign(loads.size(), 0);
    beyond_.assign(limits_.size() * loads.size(), 0);
    add_pose(PoseIndex(m), loads, missing_, beyond_);
    for (std::size_t b = 0; b < loads.size(); ++b) {
      if (missing_[b] == 1) loads[b] = kInfinity;
    }
  }

  const VariedMachines& varied_;
  std::size_t count_ = 0;             ///< number of machines in the piece
  std::vector<std::size_t> numbers_;  ///< [machines] numbers of the machines
  std::vector<double> drawn_;         ///< [errors x machines] errors at the present pose, without variations
  std::vector<double> at_pose_;       ///< [poses x machines] loads at each pose without variations
  std::vector<double> load_;          ///< [machines] largest load over the poses without variations
  std::vector<double> change_;        ///< [variations] largest change of a load that each variation caused at some pose
  /// Pairs of a variation and a machine that are still to be solved at the present pose, as positions in an array
  /// [variations x machines].
  std::vector<std::size_t> pairs_;
  std::vector<double> of_pairs_;  ///< [pairs] loads of the pairs in pairs_ at the present pose
  std::vector<std::uint8_t> missing_;
  std::vector<std::uint8_t> beyond_;
};

/// The job of a UnitFold (run/unit_fold.h), whose units are the pieces of work.
struct VariationJob {
  const Plan& plan;
  const Model& model;
  RelativeLimits limits;
  VariedMachines varied;
  const MachineCalibration* calibration;

  static constexpr std::string_view kName = "variations";
  std::vector<std::uint64_t> sizes() const {
    return {varied.machines.size(), varied.variations.size(), plan.poses().size()};
  }
  NumberRange units(const Shard& shard) const { return shard.of(varied.pieces()); }
  std::uint64_t expected(std::size_t n) const { return varied.solves_of(n, plan.poses().size()) / kOfPosesDecide; }
  VariationEvaluator worker() const { return {plan, model, limits, varied, calibration}; }
  static SolveCounts solves(std::size_t, const VariedLoads& unit) { return as_converged(unit.solves); }
  VariedLoads sums() const { return {.varied = &varied}; }
};

/// The loads of all pieces, reordered to [variations x machines].
std::vector<double> by_variation(const VariedMachines& varied, std::span<const double> load) {
  const std::size_t machines = varied.machines.size();
  std::vector<double> loads(load.size());
  std::size_t first = 0;
  for (std::size_t piece = 0; piece < varied.pieces(); ++piece) {
    const std::size_t count = varied.machines_of(piece).size();
    for (std::size_t v = 0; v < varied.variations.size(); ++v) {
      std::copy_n(&load[first * varied.variations.size() + v * count], count, &loads[v * machines + first]);
    }
    first += count;
  }
  return loads;
}

}  // namespace

std::optional<std::vector<double>> try_variations(const Plan& plan, const Model& model,
                                                  std::span<const ResponseLimit> limits,
                                                  std::span<const std::uint32_t> machines,
                                                  std::span<const Variation> variations, const RunOptions& options,
                                                  const MachineCalibration* calibration) {
  POESY_EXPECTS(std::ranges::none_of(variations, [&](const Variation& variation) {
    return std::ranges::any_of(variation, [&](const ErrorFactor& one) { return plan.is_per_pose(one.error); });
  }));
  const VariationJob job{plan, model, {plan, model, limits, calibration}, {machines, variations}, calibration};
  const auto loads = fold_units(job, options);
  if (!loads) return std::nullopt;
  return by_variation(job.varied, loads->load);
}

}  // namespace poesy::allocation
