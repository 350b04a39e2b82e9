#include "engine/kinds/allocation/variations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/base/bytes.h"
#include "engine/kinds/allocation/load_solver.h"
#include "engine/run/fold.h"

namespace poesy {
namespace {

constexpr std::uint64_t kKind = 73;  ///< the first number of a state, which no other stage has
/// Machines that are varied together. They are few so that a piece of work ends soon however many variations there are.
constexpr std::size_t kVariedAtOnce = 40;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// About one of so many poses decides, for a guess of the solves that are left.
constexpr std::size_t kOfPosesDecide = 4;

/// Machines and their variations. A piece of work has all variations of some of the machines.
struct VariedMachines {
  std::span<const std::uint32_t> machines;  ///< [n]
  std::span<const Variation> variations;    ///< [V]

  std::size_t pieces() const { return variations.empty() ? 0 : (machines.size() + kVariedAtOnce - 1) / kVariedAtOnce; }
  std::span<const std::uint32_t> machines_of(std::size_t piece) const {
    const std::size_t first = piece * kVariedAtOnce;
    return machines.subspan(first, std::min(kVariedAtOnce, machines.size() - first));
  }
  std::size_t loads_of(std::size_t piece) const { return variations.size() * machines_of(piece).size(); }
  /// The largest number of solves.
  std::uint64_t solves_of(std::size_t piece, std::size_t poses) const {
    return std::uint64_t{loads_of(piece) + machines_of(piece).size()} * poses;
  }
};

/// The loads of a piece of work.
struct VariedPiece {
  std::vector<double> load;  ///< [V x B]
  std::uint64_t solves = 0;
};

/// Owns the scratch of one thread.
class VariationEvaluator : private LoadSolver {
 public:
  VariationEvaluator(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                     const VariedMachines& varied)
      : LoadSolver(plan, model, limits), varied_(varied) {}

  VariedPiece operator()(std::size_t piece) {
    const auto machines = varied_.machines_of(piece);
    numbers_.assign(machines.begin(), machines.end());
    count_ = machines.size();
    draw(numbers_);
    drawn_.assign(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(plan_->factors().size() * count_));
    VariedPiece found{std::vector<double>(varied_.loads_of(piece)), 0};
    solve_without(found);
    change_.assign(varied_.variations.size(), 0.0);
    for (const bool deciding : {true, false}) {
      for (std::size_t m = 0; m < plan_->poses().size(); ++m) solve_at(m, deciding, found);
    }
    return found;
  }

 private:
  /// Solves the machines without variations.
  void solve_without(VariedPiece& found) {
    at_pose_.assign(plan_->poses().size() * count_, 0.0);
    load_.assign(count_, 0.0);
    for (std::size_t m = 0; m < plan_->poses().size(); ++m) {
      solve(m, std::span(at_pose_).subspan(m * count_, count_));
      for (std::size_t b = 0; b < count_; ++b) load_[b] = std::max(load_[b], at_pose_[m * count_ + b]);
    }
    found.solves += at_pose_.size();
  }

  /// Solves variations at a pose, for machines that it decides. Or for the other machines the variations that change
  /// much in any of the machines, because what hardly acts at the pose that decides for one may act at another.
  void solve_at(std::size_t m, bool deciding, VariedPiece& found) {
    pairs_.clear();
    for (std::size_t pair = 0; pair < found.load.size(); ++pair) {
      const std::size_t b = pair % count_;
      const bool decides = at_pose_[m * count_ + b] >= load_[b] - kDeciding;
      if (decides != deciding || (!decides && change_[pair / count_] <= 0.5 * kDeciding)) continue;
      pairs_.push_back(pair);
      if (pairs_.size() == kMachinesOfPiece) solve_pairs(m, found);
    }
    if (!pairs_.empty()) solve_pairs(m, found);
  }

  /// Solves the pairs of a variation and a machine that are waiting.
  void solve_pairs(std::size_t m, VariedPiece& found) {
    const std::size_t count = pairs_.size();
    for (std::size_t p = 0; p < plan_->factors().size(); ++p) {
      for (std::size_t k = 0; k < count; ++k) values_[p * count + k] = drawn_[p * count_ + pairs_[k] % count_];
    }
    for (std::size_t k = 0; k < count; ++k) {
      const Variation& variation = varied_.variations[pairs_[k] / count_];
      for (const std::size_t p : variation.errors) values_[p * count + k] *= variation.factor;
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

  /// Finds the loads at a pose of the first columns of values_; infinite where a machine is not solved.
  void solve(std::size_t m, std::span<double> loads) {
    missing_.assign(loads.size(), 0);
    beyond_.assign(limits_.size() * loads.size(), 0);
    add_pose(PoseIndex(m), loads, missing_, beyond_);
    for (std::size_t b = 0; b < loads.size(); ++b) {
      if (missing_[b] == 1) loads[b] = kInfinity;
    }
  }

  const VariedMachines& varied_;
  std::size_t count_ = 0;             ///< B, machines of the piece
  std::vector<std::size_t> numbers_;  ///< [B]
  std::vector<double> drawn_;         ///< [P x B] errors
  std::vector<double> at_pose_;       ///< [M x B] loads without variations
  std::vector<double> load_;          ///< [B] the largest of them
  std::vector<double> change_;        ///< [V] the largest change of a load at a pose
  std::vector<std::size_t> pairs_;    ///< waiting pairs, as positions in [V x B]
  std::vector<double> of_pairs_;      ///< their loads at a pose
  std::vector<std::uint8_t> missing_;
  std::vector<std::uint8_t> beyond_;
};

/// All pieces in their order: the work of fold().
class VariationWork {
 public:
  VariationWork(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits, VariedMachines varied)
      : plan_(plan), model_(model), limits_(limits), varied_(varied) {}
  VariationWork(const VariationWork&) = delete;
  VariationWork& operator=(const VariationWork&) = delete;

  std::size_t begin_round() {
    begun_ = next_;
    return varied_.pieces() - next_;
  }
  VariationEvaluator worker() const { return {plan_, model_, limits_, varied_}; }
  VariedPiece solve(VariationEvaluator& evaluate, std::size_t n) const { return evaluate(begun_ + n); }
  SolveCounts merge(std::size_t, const VariedPiece& found) {
    loads_.insert(loads_.end(), found.load.begin(), found.load.end());
    solves_ += found.solves;
    ++next_;
    return as_converged(found.solves);
  }
  static void write(std::size_t, const VariedPiece& found, ByteWriter& to) {
    to.reals(found.load);
    to.number(found.solves);
  }
  VariedPiece read(std::size_t n, ByteReader& from) const {
    const std::size_t piece = begun_ + n;
    VariedPiece found{read_loads(from, varied_.loads_of(piece)), 0};
    found.solves = from.number_up_to(varied_.solves_of(piece, plan_.poses().size()));
    return found;
  }
  SolveCounts solved() const { return as_converged(solves_); }
  std::uint64_t left() const {
    std::uint64_t left = 0;
    for (std::size_t piece = next_; piece < varied_.pieces(); ++piece) {
      left += varied_.solves_of(piece, plan_.poses().size());
    }
    return left / kOfPosesDecide;
  }
  void write_state(ByteWriter& to) const {
    for (const std::uint64_t size : sizes()) to.number(size);
    to.number(next_);
    to.number(solves_);
    to.reals(loads_);
  }
  void restore(std::span<const std::byte> state) {
    ByteReader from(state);
    for (const std::uint64_t size : sizes()) {
      if (from.number() != size) throw BytesError("is the state of another kind or size of study");
    }
    next_ = static_cast<std::size_t>(from.number_up_to(varied_.pieces()));
    std::size_t count = 0;
    std::uint64_t most = 0;
    for (std::size_t piece = 0; piece < next_; ++piece) {
      count += varied_.loads_of(piece);
      most += varied_.solves_of(piece, plan_.poses().size());
    }
    solves_ = from.number_up_to(most);
    loads_ = read_loads(from, count);
    from.expect_end();
  }
  static bool next_round() { return false; }

  /// [V x n]
  std::vector<double> result() const {
    const std::size_t machines = varied_.machines.size();
    std::vector<double> loads(varied_.variations.size() * machines);
    std::size_t first = 0;
    for (std::size_t piece = 0; piece < varied_.pieces(); ++piece) {
      const std::size_t count = varied_.machines_of(piece).size();
      for (std::size_t v = 0; v < varied_.variations.size(); ++v) {
        std::copy_n(&loads_[first * varied_.variations.size() + v * count], count, &loads[v * machines + first]);
      }
      first += count;
    }
    return loads;
  }

 private:
  std::array<std::uint64_t, 4> sizes() const {
    return {kKind, varied_.machines.size(), varied_.variations.size(), plan_.poses().size()};
  }

  const Plan& plan_;
  const Model& model_;
  std::span<const ResponseLimit> limits_;
  VariedMachines varied_;
  std::vector<double> loads_;  ///< of each piece [V x B]
  std::uint64_t solves_ = 0;
  std::size_t next_ = 0;
  std::size_t begun_ = 0;
};

}  // namespace

std::optional<std::vector<double>> try_variations(const Plan& plan, const Model& model,
                                                  std::span<const ResponseLimit> limits,
                                                  std::span<const std::uint32_t> machines,
                                                  std::span<const Variation> variations, const RunOptions& options) {
  VariationWork work(plan, model, limits, {machines, variations});
  if (!fold(work, options)) return std::nullopt;
  return work.result();
}

}  // namespace poesy
