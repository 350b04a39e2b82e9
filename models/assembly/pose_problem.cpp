#include "models/assembly/pose_problem.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/linalg/decompositions.h"

namespace poesy::assembly {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Shape = KernelConstant::Shape;

/// The largest number of rounds (iterations) of the kernel. Other solvers solve the samples that need more.
constexpr int kMostRounds = 30;

/// A limb counts as rigid in a direction if its smallest compliance is below this share of its largest, because such a
/// compliance may be rounding.
constexpr double kRigid = 1e-9;

Index index(std::size_t value) { return static_cast<Index>(value); }

/// The motion with lengths in units of `length` (m).
KernelMotion in_units(const Transform& transform, double length) {
  KernelMotion made{};
  for (Index row = 0; row < 3; ++row) {
    for (Index column = 0; column < 3; ++column) made.r[3 * row + column] = transform.R(row, column);
    made.p[row] = transform.p[row] / length;
  }
  return made;
}

KernelConstant constant_of(const Transform& transform, double length) {
  const bool turns = transform.R != lie::Matrix3<double>::Identity();
  const bool shifts = !transform.p.isZero(0.0);
  return {in_units(transform, length), turns ? Shape::any : shifts ? Shape::translation : Shape::identity};
}

void copy_rows(const Matrix& matrix, std::vector<double>& to) {
  for (Index row = 0; row < matrix.rows(); ++row) {
    for (Index column = 0; column < matrix.cols(); ++column) to.push_back(matrix(row, column));
  }
}

/// The joints (of one freedom each) whose frames are reported, limb by limb.
std::vector<JointPlace> reported_joints(const AssemblyModel& model) {
  if (model.assembly.metric != Metric::stiffness) return {};
  std::vector<JointPlace> joints;
  for (std::size_t e = 0; e < model.assembly.limbs.size(); ++e) {
    joints.push_back({e, last_moving(model.assembly.limbs[e])});
  }
  for (const ReportedJoint& one : model.report.drives) joints.push_back({one.limb, one.joint});
  for (const ReportedJoint& one : model.report.reactions) joints.push_back({one.limb, one.joint});
  std::ranges::sort(joints);
  joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  return joints;
}

/// The constant motions before and behind a frame's error.
std::pair<Transform, Transform> parts_of(const chain::Limb& limb, std::size_t j, const KernelError& error) {
  if (limb.errors_at_joints && error.turns) return {limb.before_error(j), limb.behind_error(j)};
  if (error.inverted) return {limb.home[j], Transform()};
  return {Transform(), limb.home[j]};
}

}  // namespace

std::size_t padded(std::size_t samples) { return (samples + kKernelLanes - 1) / kKernelLanes * kKernelLanes; }

PoseProblem::PoseProblem(const AssemblyModel& model, Nominal pose, const SolverOptions& options)
    : model_(&model),
      pose_(std::move(pose)),
      frame_(frame_of_metric(pose_.W)),
      from_units_(linalg::inverse(twists_in_units(frame_, model.assembly.reach))),
      marks_(reported_joints(model)),
      problem_{} {
  const Assembly& assembly = model.assembly;
  find_entries();
  Equilibrium equations(assembly, pose_, frame_);
  equations.set(pose_.limbs, model.ranks);
  for (const Transform& body : pose_.bodies) {
    problem_.bodies.push_back(in_units(frame_.inverse() * body, assembly.reach));
  }
  for (const Screw& load : pose_.load) {
    const Screw in_units = equations.wrench_in_units(load);
    problem_.load.insert(problem_.load.end(), in_units.begin(), in_units.end());
  }
  const double moment = 1.0 / equations.compliance_unit();
  problem_.report.length = assembly.reach;
  problem_.report.force = moment / assembly.reach;
  problem_.report.moment = moment;
  for (std::size_t e = 0; e < assembly.limbs.size(); ++e) set_limb(equations, e);
  set_report();
  solve_first_order(equations);
  problem_.carries = problem_.map.stresses > 0 || std::ranges::any_of(problem_.load, [](double x) { return x != 0.0; });
  set_own_matrices(equations);
  problem_.wants_wrenches = assembly.metric == Metric::stiffness;
  problem_.tolerance = options.tolerance;
  problem_.most_rounds = std::min(kMostRounds, options.max_iterations);
}

/// Finds the components of frames' errors (entries_) that errors of the model change. Several errors may add to the
/// same component.
void PoseProblem::find_entries() {
  first_.push_back(0);
  for (const Limb& limb : model_->assembly.limbs) first_.push_back(first_.back() + limb.chain.frames());
  errors_.resize(first_.back());
  added_.push_back(0);
  for (const chain::ErrorTerms& terms : model_->terms) {
    for (const chain::ErrorTerm& term : terms) {
      const auto is_same = [&](const Entry& one) {
        return one.limb == term.limb && one.frame == term.frame && one.component == term.component;
      };
      const auto at = std::ranges::find_if(entries_, is_same);
      const double unit = term.component < 3 ? 1.0 : model_->assembly.reach;
      additions_.push_back({static_cast<std::size_t>(at - entries_.begin()), term.at(pose_.displacements) / unit});
      if (at == entries_.end()) entries_.push_back({term.limb, term.frame, term.component});
    }
    added_.push_back(additions_.size());
  }
}

/// The index of a joint's frame among the reported frames; -1 if it is not reported.
int PoseProblem::mark_of(const JointPlace& place) const {
  const auto at = std::ranges::find(marks_, place);
  return at == marks_.end() ? -1 : static_cast<int>(at - marks_.begin());
}

/// The kernel's data of a joint. passive: number of passive joints of the limb before this joint.
KernelJoint PoseProblem::kernel_joint(const JointPlace& place, std::size_t passive) const {
  const Assembly& assembly = model_->assembly;
  const chain::Joint& joint = assembly.limbs[place.limb].chain.joints[place.joint];
  const double q = pose_.displacements[assembly.first_joint(place.limb) + place.joint];
  const bool slides = joint.type == chain::JointType::prismatic;
  return {.slides = slides,
          .advance = joint.advance / assembly.reach,
          .passive = joint.actuated ? -1 : static_cast<int>(passive),
          .mark = mark_of(place),
          .displacement = slides ? q / assembly.reach : q};
}

KernelMark PoseProblem::kernel_mark(const JointPlace& place) const {
  return {place.limb, static_cast<std::size_t>(mark_of(place)), kernel_joint(place, 0)};
}

/// Sets the data of a limb that do not depend on errors: joints that are passive or reported, and the limb's equations.
void PoseProblem::set_limb(const Equilibrium& equations, std::size_t e) {
  const Assembly& assembly = model_->assembly;
  const Limb& limb = assembly.limbs[e];
  KernelLimb made{};
  made.from = limb.from;
  made.to = limb.to;
  made.first_joint = problem_.joints;
  made.first_wrench = static_cast<std::size_t>(equations.first_wrenches()[e]);
  made.carried = static_cast<std::size_t>(equations.carry(e).cols());
  copy_rows(equations.carry(e), made.carry);
  copy_rows(equations.give(e), made.give);
  for (Index k = 0; k < 36; ++k) made.compliance[k] = equations.compliance(e)(k / 6, k % 6);
  for (std::size_t j = 0; j < limb.chain.joints.size(); ++j) {
    const KernelJoint joint = kernel_joint({e, j}, made.passive);
    made.passive += joint.passive >= 0 ? 1 : 0;
    if (joint.passive >= 0 || joint.mark >= 0) made.joints.push_back(joint);
  }
  problem_.joints += made.passive;
  problem_.limbs.push_back(std::move(made));
}

/// Chooses the matrix of the steps (KernelStep). Each sample has matrices of its own, for which the data are set here.
/// There are two exceptions, in which all samples share the constant matrix: if a limb has too many passive joints, and
/// if limbs have wrenches and one of the limbs is rigid in some direction.
void PoseProblem::set_own_matrices(const Equilibrium& equations) {
  problem_.step = KernelStep::constant;
  for (const KernelLimb& limb : problem_.limbs) {
    if (limb.passive > kMostOwnJoints) return;
  }
  if (problem_.carries && !is_soft(equations)) return;
  problem_.step = problem_.carries ? KernelStep::own : KernelStep::meet;
  const std::span<const double, 6> W = problem_.report.metric;
  const double largest = *std::ranges::max_element(W);
  for (std::size_t k = 0; k < 6; ++k) {
    problem_.measured[k] = std::sqrt(W[k] / largest);
    problem_.unmeasured[k] = 1.0 / problem_.measured[k];
  }
  const Matrix measured = Eigen::Map<const Screw>(problem_.measured).asDiagonal();
  for (std::size_t e = 0; e < problem_.limbs.size(); ++e) {
    KernelLimb& limb = problem_.limbs[e];
    if (!problem_.carries) {
      set_idle(equations, e, measured * measured);
      continue;
    }
    limb.is_diagonal = model_->assembly.metric == Metric::platform;
    const Matrix stiffness = linalg::inverse(equations.compliance(e));
    for (Index k = 0; k < 36; ++k) limb.stiffness[k] = stiffness(k / 6, k % 6);
    set_idle(equations, e, stiffness);
  }
}

/// Returns true if no limb is rigid in any direction.
bool PoseProblem::is_soft(const Equilibrium& equations) const {
  for (std::size_t e = 0; e < problem_.limbs.size(); ++e) {
    const Eigen::VectorXd softness = linalg::eigenvalues(equations.compliance(e));
    if (!(softness[0] > kRigid * softness[5])) return false;
  }
  return true;
}

/// Sets the terms for a limb's idle freedoms, the motions of its passive joints that do not move its end. The terms are
/// about as large as the numbers in the matrix S^T weight S, where the columns of S are the twists of the limb's
/// passive joints.
void PoseProblem::set_idle(const Equilibrium& equations, std::size_t e, const Matrix& weight) {
  const Matrix& give = equations.give(e);
  const Matrix columns = equations.twists_in_units() * pose_.limbs[e].passive;
  const Matrix idle = Matrix::Identity(give.rows(), give.rows()) - give * columns;  // projection onto idle freedoms
  const double size = (columns.transpose() * weight * columns).trace() / static_cast<double>(give.rows());
  const bool has_idle = equations.carry(e).cols() + give.rows() > 6;
  copy_rows(has_idle ? Matrix(size * idle) : Matrix::Zero(give.rows(), give.rows()), problem_.limbs[e].idle);
}

void PoseProblem::set_report() {
  const Assembly& assembly = model_->assembly;
  KernelReport& report = problem_.report;
  report.deforms = model_->deforms;
  report.has_forces = assembly.metric == Metric::stiffness;
  report.has_motions = model_->report.motions;
  report.has_tool = assembly.tool.has_value();
  const Matrix6 W = from_units_.transpose() * pose_.W * from_units_;
  for (Index k = 0; k < 6; ++k) report.metric[k] = W(k, k);
  report.share = 2.0 / static_cast<double>(assembly.loops());
  const Transform& platform = pose_.bodies[kPlatform];
  const Vector3 arm = frame_.R.transpose() * platform.R * assembly.tool.value_or(Vector3::Zero());
  for (Index k = 0; k < 3; ++k) {
    report.origin[k] = problem_.bodies[kPlatform].p[k];
    report.arm[k] = arm[k] / assembly.reach;
  }
  for (Index k = 0; k < 9; ++k) report.axes[k] = frame_.R(k / 3, k % 3);
  report.marks = marks_.size();
  if (!report.has_forces) return;
  for (const JointPlace& one : marks_) {
    report.nominal_marks.push_back(
        in_units(frame_.inverse() * pose_.limbs[one.limb].before[one.joint], assembly.reach));
  }
  for (std::size_t e = 0; e < assembly.limbs.size(); ++e) {
    report.moments.push_back(static_cast<std::size_t>(mark_of({e, last_moving(assembly.limbs[e])})));
  }
  for (const ReportedJoint& one : model_->report.drives) report.drives.push_back(kernel_mark({one.limb, one.joint}));
  for (const ReportedJoint& one : model_->report.reactions) {
    report.reactions.push_back(kernel_mark({one.limb, one.joint}));
  }
}

/// [6 limbs x entries] The twists of limbs' ends per unit of each changed component (entry), in the kernel's units.
Matrix PoseProblem::twists_of_entries(const Equilibrium& equations) const {
  const Assembly& assembly = model_->assembly;
  Matrix twists = Matrix::Zero(6 * index(assembly.limbs.size()), index(entries_.size()));
  for (std::size_t n = 0; n < entries_.size(); ++n) {
    const Entry& entry = entries_[n];
    const Limb& limb = assembly.limbs[entry.limb];
    const Screw twist =
        error_twist(limb, pose_.bodies[limb.from], pose_.limbs[entry.limb], entry.frame, entry.component);
    const double unit = entry.component < 3 ? 1.0 : assembly.reach;
    twists.block<6, 1>(6 * index(entry.limb), index(n)) = unit * equations.twists_in_units() * twist;
  }
  return twists;
}

/// Computes the first-order coordinates (KernelMap), and the inverse of the equations' matrix.
void PoseProblem::solve_first_order(const Equilibrium& equations) {
  const std::size_t limbs = problem_.limbs.size();
  const Index size = equations.matrix().rows();
  const Index columns = index(entries_.size()) + 1;
  const Index lambdas = equations.first_wrenches().back();
  const Index moves = size - lambdas;
  const Matrix twists = twists_of_entries(equations);
  Matrix right = Matrix::Zero(size, columns + size);
  for (std::size_t e = 0; e < limbs; ++e) {
    const Matrix& carry = equations.carry(e);
    right.block(equations.first_wrenches()[e], 0, carry.cols(), columns - 1) =
        carry.transpose() * twists.middleRows(6 * index(e), 6);
    right.block(equations.first_wrenches()[e], columns - 1, carry.cols(), 1) =
        carry.transpose() * equations.twists_in_units() * pose_.mismatch[e];
  }
  for (Index k = 0; k < moves; ++k) right(lambdas + k, columns - 1) = -problem_.load[static_cast<std::size_t>(6 + k)];
  right.rightCols(size).setIdentity();
  const Matrix found = linalg::solve(equations.matrix(), right);
  problem_.size = static_cast<std::size_t>(size);
  copy_rows(found.rightCols(size), problem_.inverse);

  // Stresses are wrenches that balance at every body: the combinations of lambda that the bodies' equations leave free.
  const Index stresses = std::max<Index>(lambdas - moves, 0);
  const Matrix stress = stresses > 0 ? linalg::orthogonal_complement(equations.matrix().topRightCorner(lambdas, moves))
                                     : Matrix(lambdas, 0);
  const Matrix lambda = found.topLeftCorner(lambdas, columns);
  const Matrix bodies = found.block(lambdas, 0, moves, columns);
  coordinates_.resize(moves + stresses + index(problem_.joints), columns);
  coordinates_.topRows(moves) = bodies;
  coordinates_.middleRows(moves, stresses) = stress.transpose() * lambda;
  coordinates_.block(moves, columns - 1, stresses, 1).setZero();
  problem_.map.stresses = static_cast<std::size_t>(stresses);
  for (std::size_t e = 0; e < limbs; ++e) {
    const KernelLimb& limb = problem_.limbs[e];
    const Matrix wrenches = equations.carry(e) * lambda.middleRows(equations.first_wrenches()[e], index(limb.carried));
    copy_rows(equations.carry(e) * stress.middleRows(equations.first_wrenches()[e], index(limb.carried)),
              problem_.map.wrenches);
    copy_rows(wrenches.rightCols(1), problem_.map.by_load);
    Matrix wanted = equations.compliance(e) * wrenches;
    wanted.leftCols(columns - 1) -= twists.middleRows(6 * index(e), 6);
    wanted.rightCols(1) -= equations.twists_in_units() * pose_.mismatch[e];
    if (limb.to != kBase) wanted += bodies.middleRows(6 * index(limb.to - 1), 6);
    if (limb.from != kBase) wanted -= bodies.middleRows(6 * index(limb.from - 1), 6);
    coordinates_.middleRows(moves + stresses + index(limb.first_joint), index(limb.passive)) =
        equations.give(e) * wanted;
  }
}

/// A pointer to the first value of a varied component in the array `values`.
double* PoseProblem::row_of(const Entry& entry, std::size_t stride, std::vector<double>& values) {
  return values.data() + static_cast<std::size_t>(entry.row) * stride;
}

/// Sets the constant part of each component in entries_: the sum over the errors that do not vary.
void PoseProblem::set_constants(const SampleBlock& samples) {
  for (Entry& entry : entries_) {
    entry.constant = 0.0;
    entry.row = -1;
    entry.unit = 1.0;
  }
  std::vector<bool> varies(model_->terms.size(), false);
  for (const FactorIndex factor : samples.varied) varies[factor.value] = true;
  for (std::size_t f = 0; f < varies.size(); ++f) {
    if (varies[f]) continue;
    for (const Addition& one : additions(f)) entries_[one.entry].constant += one.scale * samples.errors[f];
  }
}

/// Makes the kernel read the values of the varied errors from the samples, without a copy. Returns false if that is not
/// possible. It is possible if the samples fill whole batches, and each varied error changes a single component that no
/// other error changes.
bool PoseProblem::take_values(const SampleBlock& samples) {
  if (samples.count != padded(samples.count)) return false;
  int rows = 0;
  for (const FactorIndex factor : samples.varied) {
    const std::span<const Addition> of = additions(factor.value);
    if (of.size() != 1) return false;
    Entry& entry = entries_[of.front().entry];
    if (entry.row >= 0 || entry.constant != 0.0) return false;
    entry.row = rows++;
    entry.unit = of.front().scale;
  }
  values_ = samples.values.data();
  return true;
}

/// Computes the values of the components that vary, as sums over the errors.
void PoseProblem::add_values(const SampleBlock& samples, std::vector<double>& values) {
  const std::size_t stride = padded(samples.count);
  for (Entry& entry : entries_) {
    entry.row = -1;
    entry.unit = 1.0;
  }
  int rows = 0;
  for (const FactorIndex factor : samples.varied) {
    for (const Addition& one : additions(factor.value)) {
      Entry& entry = entries_[one.entry];
      if (entry.row < 0) entry.row = rows++;
    }
  }
  values.resize(static_cast<std::size_t>(rows) * stride);
  for (const Entry& entry : entries_) {
    if (entry.row >= 0) std::fill_n(row_of(entry, stride, values), stride, entry.constant);
  }
  for (std::size_t v = 0; v < samples.varied.size(); ++v) {
    const double* from = samples.values.data() + v * samples.count;
    for (const Addition& one : additions(samples.varied[v].value)) {
      double* to = row_of(entries_[one.entry], stride, values);
      for (std::size_t b = 0; b < samples.count; ++b) to[b] += one.scale * from[b];
    }
  }
  values_ = values.data();
}

/// Sets the segments between the joints of limb e.
void PoseProblem::set_segments(std::size_t e) {
  const Assembly& assembly = model_->assembly;
  const chain::Limb& limb = assembly.limbs[e].chain;
  KernelLimb& made = problem_.limbs[e];
  made.segments.clear();
  KernelSegment segment;
  Transform behind = made.from == kBase ? frame_.inverse() : Transform();
  for (std::size_t j = 0; j < limb.frames(); ++j) {
    const KernelError& error = errors_[first_[e] + j];
    const bool has_error = error.turns || std::ranges::any_of(error.varied, [](int row) { return row >= 0; }) ||
                           std::ranges::any_of(error.constant, [](double value) { return value != 0.0; });
    if (has_error) {
      const auto [before, rest] = parts_of(limb, j, error);
      segment.pieces.push_back({constant_of(behind * before, assembly.reach), error});
      behind = rest;
    } else {
      behind = behind * limb.home[j];
    }
    const bool is_last = j == limb.joints.size();
    const bool is_kept = !is_last && (!limb.joints[j].actuated || mark_of({e, j}) >= 0);
    if (is_last || is_kept) {
      segment.behind = constant_of(behind, assembly.reach);
      made.segments.push_back(std::move(segment));
      segment = {};
      behind = Transform();
    } else {
      chain::move_joint(limb.joints[j], pose_.displacements[assembly.first_joint(e) + j], behind);
    }
  }
}

void PoseProblem::set_map() {
  constexpr std::size_t kRows = KernelMap::kRows;
  KernelMap& map = problem_.map;
  std::vector<Index> column;  // for each varied value, the column of coordinates_ that belongs to its component
  Eigen::VectorXd offset = coordinates_.rightCols(1);
  for (std::size_t n = 0; n < entries_.size(); ++n) {
    if (entries_[n].row >= 0) {
      column.resize(std::max(column.size(), static_cast<std::size_t>(entries_[n].row) + 1));
      column[static_cast<std::size_t>(entries_[n].row)] = index(n);
    } else if (entries_[n].constant != 0.0) {
      offset += entries_[n].constant * coordinates_.col(index(n));
    }
  }
  const auto rows = static_cast<std::size_t>(coordinates_.rows());
  const std::size_t blocks = (rows + kRows - 1) / kRows;
  map.entries = column.size();
  map.offset.assign(blocks * kRows, 0.0);
  map.matrix.assign(blocks * kRows * map.entries, 0.0);
  map.units.clear();
  for (const Index n : column) map.units.push_back(entries_[static_cast<std::size_t>(n)].unit);
  for (std::size_t row = 0; row < rows; ++row) {
    map.offset[row] = offset[index(row)];
    const std::size_t first = row / kRows * kRows * map.entries + row % kRows;
    for (std::size_t v = 0; v < map.entries; ++v) map.matrix[first + v * kRows] = coordinates_(index(row), column[v]);
  }
}

const KernelProblem& PoseProblem::with(const SampleBlock& samples, std::vector<double>& scratch) {
  set_constants(samples);
  if (!take_values(samples)) add_values(samples, scratch);
  for (std::size_t e = 0; e < problem_.limbs.size(); ++e) {
    for (std::size_t j = first_[e]; j < first_[e + 1]; ++j) {
      errors_[j] = {false, j + 1 == first_[e + 1], {-1, -1, -1, -1, -1, -1}, {}, {}};
    }
  }
  for (const Entry& entry : entries_) {
    KernelError& error = errors_[first_[entry.limb] + entry.frame];
    error.varied[entry.component] = entry.row;
    error.unit[entry.component] = entry.unit;
    error.constant[entry.component] = entry.constant;
    error.turns = error.turns || (entry.component < 3 && (entry.row >= 0 || entry.constant != 0.0));
  }
  for (std::size_t e = 0; e < problem_.limbs.size(); ++e) set_segments(e);
  set_map();
  use_starts(samples);
  return problem_;
}

bool PoseProblem::has_starts(const SampleBlock& samples) const {
  return started_ && samples.varied.size() == 1 && started_->factor.value == samples.varied.front().value &&
         started_->range == samples.range && std::ranges::equal(started_->errors, samples.errors);
}

void PoseProblem::set_starts(const SampleBlock& samples, std::vector<double> coefficients) {
  started_ = {samples.varied.front(), samples.range, {samples.errors.begin(), samples.errors.end()}};
  problem_.start.coefficients = std::move(coefficients);
}

/// Decides whether these samples start from the series of KernelStart, and sets how the argument of the series follows
/// from the first varied value.
void PoseProblem::use_starts(const SampleBlock& samples) {
  problem_.start.is_used = !problem_.start.coefficients.empty() && has_starts(samples);
  if (!problem_.start.is_used) return;
  const std::span<const Addition> of = additions(samples.varied.front().value);
  double scale = 0.0;  // change of the first changed component per unit of the error
  for (const Addition& one : of) scale += one.entry == of.front().entry ? one.scale : 0.0;
  problem_.start.is_used = scale != 0.0;
  problem_.start.centre = entries_[of.front().entry].constant;
  problem_.start.scale = 1.0 / (scale * samples.range);
}

}  // namespace poesy::assembly
