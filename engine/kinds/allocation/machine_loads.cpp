#include "engine/kinds/allocation/machine_loads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/base/bytes.h"
#include "engine/kinds/allocation/load_solver.h"
#include "engine/run/fold.h"

namespace poesy {
namespace {

constexpr std::uint64_t kKind = 72;  ///< the first number of a state, which no other stage has

/// The machines of a run.
struct Machines {
  std::size_t count;                      ///< n
  std::span<const std::uint32_t> listed;  ///< [n] numbers; empty means 0 .. n - 1

  std::size_t pieces() const { return (count + kMachinesOfPiece - 1) / kMachinesOfPiece; }
  std::size_t first(std::size_t piece) const { return piece * kMachinesOfPiece; }
  std::size_t count_of(std::size_t piece) const { return std::min(kMachinesOfPiece, count - first(piece)); }
  std::size_t number(std::size_t n) const { return listed.empty() ? n : listed[n]; }
};

/// Some machines at all poses.
struct LoadPiece {
  std::vector<double> load;           ///< [B]
  std::vector<SolveCounts> solves;    ///< [M]
  std::vector<FailedSamples> failed;  ///< [M]
  std::vector<std::uint64_t> beyond;  ///< [K]
  std::uint64_t unsolved = 0;         ///< machines
};

/// Owns the scratch of one thread.
class LoadEvaluator : private LoadSolver {
 public:
  LoadEvaluator(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits, const Machines& machines)
      : LoadSolver(plan, model, limits), machines_(machines) {}

  LoadPiece operator()(std::size_t piece) {
    const std::size_t count = machines_.count_of(piece);
    const std::size_t poses = plan_->poses().size();
    numbers_.clear();
    for (std::size_t b = 0; b < count; ++b) numbers_.push_back(machines_.number(machines_.first(piece) + b));
    draw(numbers_);
    LoadPiece found{std::vector<double>(count), std::vector<SolveCounts>(poses), std::vector<FailedSamples>(poses),
                    std::vector<std::uint64_t>(limits_.size()), 0};
    missing_.assign(count, 0);
    beyond_.assign(limits_.size() * count, 0);
    for (std::size_t m = 0; m < poses; ++m) add(m, found);
    for (std::size_t b = 0; b < count; ++b) {
      if (missing_[b] == 0) continue;
      if (found.load[b] <= 1.0) ++found.unsolved;
      found.load[b] = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < limits_.size(); ++k) beyond_[k * count + b] = 1;
    }
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const auto of_limit = std::span(beyond_).subspan(k * count, count);
      found.beyond[k] = static_cast<std::uint64_t>(std::ranges::count(of_limit, std::uint8_t{1}));
    }
    return found;
  }

 private:
  void add(std::size_t m, LoadPiece& found) {
    at_pose_.assign(found.load.size(), 0.0);
    const UnitOutcomes outcomes = add_pose(PoseIndex(m), at_pose_, missing_, beyond_);
    for (std::size_t b = 0; b < at_pose_.size(); ++b) {
      found.load[b] = std::max(found.load[b], at_pose_[b]);
      found.solves[m].add(outcomes.status[b], outcomes.iterations[b]);
      found.failed[m].add(SampleIndex(numbers_[b]), outcomes.status[b]);
    }
  }

  const Machines& machines_;
  std::vector<std::size_t> numbers_;   ///< [B]
  std::vector<double> at_pose_;        ///< [B] loads
  std::vector<std::uint8_t> missing_;  ///< [B] whether a pose is not solved
  std::vector<std::uint8_t> beyond_;   ///< [K x B] whether the limit is broken at a pose
};

/// All pieces in their order: the work of fold().
class LoadWork {
 public:
  LoadWork(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits, Machines machines)
      : plan_(plan), model_(model), limits_(limits), machines_(machines) {
    found_.solves.resize(plan.poses().size());
    found_.failed.resize(plan.poses().size());
    found_.beyond.resize(limits.size());
  }
  LoadWork(const LoadWork&) = delete;
  LoadWork& operator=(const LoadWork&) = delete;

  std::size_t begin_round() {
    begun_ = next_;
    return machines_.pieces() - next_;
  }
  LoadEvaluator worker() const { return {plan_, model_, limits_, machines_}; }
  LoadPiece solve(LoadEvaluator& evaluate, std::size_t n) const { return evaluate(begun_ + n); }
  SolveCounts merge(std::size_t, const LoadPiece& found) {
    found_.load.insert(found_.load.end(), found.load.begin(), found.load.end());
    for (std::size_t m = 0; m < found.solves.size(); ++m) {
      found_.solves[m].merge(found.solves[m]);
      found_.failed[m].merge(found.failed[m]);
    }
    for (std::size_t k = 0; k < limits_.size(); ++k) found_.beyond[k] += found.beyond[k];
    found_.unsolved += found.unsolved;
    ++next_;
    return total_of(found.solves);
  }
  static void write(std::size_t, const LoadPiece& found, ByteWriter& to) {
    to.reals(found.load);
    for (const SolveCounts& solves : found.solves) solves.write(to);
    for (const FailedSamples& failed : found.failed) failed.write(to);
    for (const std::uint64_t beyond : found.beyond) to.number(beyond);
    to.number(found.unsolved);
  }
  LoadPiece read(std::size_t n, ByteReader& from) const {
    LoadPiece found;
    const std::size_t piece = begun_ + n;
    const std::size_t count = machines_.count_of(piece);
    found.load = read_loads(from, count);
    read_poses(from, count, machines_.number(machines_.first(piece)), end_of(machines_.first(piece) + count),
               found.solves, found.failed);
    for (std::size_t k = 0; k < limits_.size(); ++k) found.beyond.push_back(from.number_up_to(count));
    found.unsolved = from.number_up_to(count);
    return found;
  }
  SolveCounts solved() const { return total_of(found_.solves); }
  std::uint64_t left() const { return std::uint64_t{machines_.count - found_.load.size()} * plan_.poses().size(); }
  void write_state(ByteWriter& to) const {
    for (const std::uint64_t size : sizes()) to.number(size);
    to.number(next_);
    to.reals(found_.load);
    for (const SolveCounts& solves : found_.solves) solves.write(to);
    for (const FailedSamples& failed : found_.failed) failed.write(to);
    for (const std::uint64_t beyond : found_.beyond) to.number(beyond);
    to.number(found_.unsolved);
  }
  void restore(std::span<const std::byte> state) {
    ByteReader from(state);
    for (const std::uint64_t size : sizes()) {
      if (from.number() != size) throw BytesError("is the state of another kind or size of study");
    }
    next_ = static_cast<std::size_t>(from.number_up_to(machines_.pieces()));
    const std::size_t count = std::min(machines_.count, machines_.first(next_));
    found_.load = read_loads(from, count);
    found_.solves.clear();
    found_.failed.clear();
    read_poses(from, count, count == 0 ? 0 : machines_.number(0), end_of(count), found_.solves, found_.failed);
    for (std::uint64_t& beyond : found_.beyond) beyond = from.number_up_to(count);
    found_.unsolved = from.number_up_to(count);
    from.expect_end();
  }
  static bool next_round() { return false; }

  MachineLoads result() && { return std::move(found_); }

 private:
  std::array<std::uint64_t, 4> sizes() const { return {kKind, machines_.count, plan_.poses().size(), limits_.size()}; }
  /// One past the number of the last of so many machines.
  std::uint64_t end_of(std::size_t count) const { return count == 0 ? 0 : machines_.number(count - 1) + 1; }
  /// Reads how the solves of `count` machines ended, with numbers first .. end - 1.
  void read_poses(ByteReader& from, std::size_t count, std::uint64_t first, std::uint64_t end,
                  std::vector<SolveCounts>& solves, std::vector<FailedSamples>& failed) const {
    for (std::size_t m = 0; m < plan_.poses().size(); ++m) solves.push_back(SolveCounts::read(from));
    for (const SolveCounts& one : solves) {
      if (one.total() != count) throw BytesError("has a pose with other machines");
      failed.push_back(FailedSamples::read(from, one.not_converged(), first, end));
    }
  }

  const Plan& plan_;
  const Model& model_;
  std::span<const ResponseLimit> limits_;
  Machines machines_;
  MachineLoads found_;
  std::size_t next_ = 0;
  std::size_t begun_ = 0;
};

std::optional<MachineLoads> run(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                const Machines& machines, const RunOptions& options) {
  LoadWork work(plan, model, limits, machines);
  if (!fold(work, options)) return std::nullopt;
  return std::move(work).result();
}

}  // namespace

std::optional<MachineLoads> machine_loads(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                          const RunOptions& options) {
  return run(plan, model, limits, {plan.samples(), {}}, options);
}

std::optional<MachineLoads> machine_loads(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                          std::span<const std::uint32_t> machines, const RunOptions& options) {
  return run(plan, model, limits, {machines.size(), machines}, options);
}

}  // namespace poesy
