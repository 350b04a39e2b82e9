#include "models/chain/block_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "models/chain/deformation_solver.h"
#include "models/chain/nominal.h"

namespace poesy::chain {
namespace {

/// The largest Newton step (rad, m). A larger step may lead to another root than the one that Gauss-Newton finds.
constexpr double kLargestStep = 0.15;
/// The largest Newton step (rad, m) of the solves at the nodes of a fit. It may be larger than kLargestStep, because a
/// fit is used only if its roots lie on one smooth branch.
constexpr double kLargestNodeStep = 0.4;
/// If the last coefficients (rad, m) of a fit are below this, nearly every starting point is so good that one step
/// leads to the root.
constexpr double kGoodTail = 1e-6;
/// A fit whose last coefficients (rad, m) are above this is not used, because displacements are not smooth over its
/// range.
constexpr double kTrustedTail = 1e-4;
/// The number of times that a range may be halved for better fits.
constexpr int kSplits = 2;
constexpr std::size_t kMostFits = (std::size_t{2} << kSplits) - 1;

std::array<double, 12> rows_of(const lie::Transform<double>& g) {
  std::array<double, 12> rows{};
  for (Eigen::Index r = 0; r < 3; ++r) {
    for (Eigen::Index c = 0; c < 3; ++c) rows[static_cast<std::size_t>(3 * r + c)] = g.R(r, c);
    rows[static_cast<std::size_t>(9 + r)] = g.p[r];
  }
  return rows;
}

lie::Transform<double> transform_of(const KernelPiece& piece) {
  lie::Transform<double> g;
  for (Eigen::Index r = 0; r < 3; ++r) {
    for (Eigen::Index c = 0; c < 3; ++c) g.R(r, c) = piece.constant[3 * r + c];
    g.p[r] = piece.constant[9 + r];
  }
  return g;
}

double* aligned(std::vector<double>& memory) {
  const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
  return memory.data() + (64 - address % 64) % 64 / sizeof(double);
}

}  // namespace

BlockSolver::BlockSolver(const ParallelChain& chain, const SolverOptions& options, Fidelity fidelity)
    : chain_(&chain),
      fidelity_(fidelity),
      options_{options.method == SolverOptions::Method::newton ? KernelMethod::newton : KernelMethod::gauss_newton,
               options.tolerance,
               rounding_level(chain),
               std::max(std::sqrt(options.tolerance / 10.0), 1e-10),
               kLargestStep,
               static_cast<std::uint32_t>(options.max_iterations)},
      kernels_(simd::for_selected_isa([]<simd::Isa isa> { return kernels<isa>(); })),
      first_order_(chain),
      residual_space_(chain),
      assembly_(chain),
      frames_(chain.frames()) {
  std::size_t joint = 0;
  for (const Limb& limb : chain.limbs) {
    limbs_.push_back({joint, limb.passive_joints(), 0.0});
    joint += limb.passive_joints();
  }
  for (const LimbPair& pair : chain.pairs) {
    pairs_.push_back({pair.k, pair.i});
    limbs_[pair.k].meetings += 1.0;
    limbs_[pair.i].meetings += 1.0;
  }
  for (std::size_t n = 0; n < kStartTerms; ++n) {
    for (std::size_t k = 0; k < kStartTerms; ++k) {
      cosines_.push_back(
          std::cos(std::numbers::pi * static_cast<double>(n) * (static_cast<double>(k) + 0.5) / kStartTerms));
    }
  }
  coefficients_.resize(kMostFits * joint * kStartTerms);
  node_displacements_.resize(joint * kernel_capacity(kStartTerms));
}

void BlockSolver::prepare(std::span<const double> displacements, std::span<const FrameError<double>> errors,
                          std::span<const FrameEntry> varied, double range, const PlatformPoints* platform,
                          const Metric* held) {
  POESY_EXPECTS(displacements.size() == chain_->joints() && errors.size() == chain_->frames());
  varied_ = varied.size();
  platform_ = platform;
  if (fidelity_ == Fidelity::first_order) {
    is_singular_ = !first_order_.prepare(displacements, nullptr);
    if (is_singular_) return;
    find_map(displacements, errors, varied);
    if (platform != nullptr) find_platform_map(errors, varied);
    return;
  }
  first_order_.prepare(displacements, nullptr);
  find_segments(displacements, errors, varied);
  assembly_.prepare(displacements, held);
  find_nearing(errors, varied);
  errors_.assign(errors.begin(), errors.end());
  entries_.assign(varied.begin(), varied.end());
  fits_.clear();
  fits_made_ = 0;
  if (options_.method == KernelMethod::newton && varied.size() == 1 && range > 0.0) {
    predict_starts(0.0, range, kSplits);
  }
}

/// Computes the motions between the passive joints. Displacements are counted from the displacements without errors, so
/// they are small, and their sines and cosines are fast.
void BlockSolver::find_segments(std::span<const double> displacements, std::span<const FrameError<double>> errors,
                                std::span<const FrameEntry> varied) {
  joints_.clear();
  segments_.clear();
  pieces_.clear();
  first_piece_ = 0;
  std::size_t frame = 0;
  std::size_t joint = 0;
  for (const Limb& limb : chain_->limbs) {
    for (std::size_t j = 0; j < limb.frames(); ++j, ++frame) {
      add_frame(limb, j, frame, errors[frame], varied);
      if (j == limb.joints.size()) break;
      const Joint& next = limb.joints[j];
      lie::Transform<double> motion;
      move_joint(next, displacements[joint++], motion);
      add_piece(motion);
      if (next.actuated) continue;
      joints_.push_back({next.type == JointType::revolute, next.advance, 0.0});
      close_segment();
    }
    ++frame;
    close_segment();
  }
}

/// Adds a constant motion. If the preceding piece of the segment is constant too, the product of the two replaces it.
void BlockSolver::add_piece(const lie::Transform<double>& motion) {
  lie::Transform<double> product = motion;
  if (pieces_.size() > first_piece_ && !pieces_.back().is_error) {
    product = transform_of(pieces_.back()) * motion;
    pieces_.pop_back();
  }
  KernelPiece piece{};
  const std::array<double, 12> rows = rows_of(product);
  std::copy(rows.begin(), rows.end(), piece.constant);
  pieces_.push_back(piece);
}

void BlockSolver::add_frame(const Limb& limb, std::size_t j, std::size_t frame, const FrameError<double>& error,
                            std::span<const FrameEntry> varied) {
  KernelPiece piece{};
  piece.is_error = true;
  piece.inverted = j + 1 == limb.frames();
  bool varies = false;
  for (std::size_t c = 0; c < 6; ++c) {
    piece.error[c] = error[static_cast<Eigen::Index>(c)];
    piece.varied_row[c] = -1;
    piece.turns = piece.turns || (c < 3 && piece.error[c] != 0.0);
  }
  for (std::size_t v = 0; v < varied.size(); ++v) {
    if (varied[v].frame != frame) continue;
    piece.varied_row[varied[v].component] = static_cast<int>(v);
    piece.turns = piece.turns || varied[v].component < 3;
    varies = true;
  }
  if (!varies) return add_piece(frame_with_error(limb, j, error));
  const bool at_joint = limb.errors_at_joints && piece.turns && (j == 0 || piece.inverted);
  if (at_joint || piece.inverted) add_piece(at_joint ? limb.before_error(j) : limb.home[j]);
  pieces_.push_back(piece);
  if (at_joint || !piece.inverted) add_piece(at_joint ? limb.behind_error(j) : limb.home[j]);
}

void BlockSolver::close_segment() {
  segments_.push_back({first_piece_, pieces_.size() - first_piece_});
  first_piece_ = pieces_.size();
}

/// Calls act(entry, error) for every error that is constant and not zero.
template <class Act>
void for_each_constant(std::span<const FrameError<double>> errors, std::span<const FrameEntry> varied, Act act) {
  for (std::size_t frame = 0; frame < errors.size(); ++frame) {
    for (std::size_t component = 0; component < 6; ++component) {
      const double error = errors[frame][static_cast<Eigen::Index>(component)];
      if (error == 0.0) continue;
      const bool varies = std::ranges::any_of(
          varied, [&](const FrameEntry& entry) { return entry.frame == frame && entry.component == component; });
      if (!varies) act(FrameEntry{frame, component}, error);
    }
  }
}

/// Computes the first-order effects of errors in coordinates of the residual space. The number of coordinates is padded
/// to a multiple of kMapRows. The constant part includes the mismatch that perfect limbs have if the numbers of their
/// file are rounded.
void BlockSolver::find_map(std::span<const double> displacements, std::span<const FrameError<double>> errors,
                           std::span<const FrameEntry> varied) {
  residual_space_.prepare(first_order_);
  const std::size_t used = residual_space_.dimensions();
  const std::size_t rows = (used + kMapRows - 1) / kMapRows * kMapRows;
  const auto first_of = [used](std::vector<double>& numbers, std::size_t at) {
    return std::span(numbers).subspan(at, used);
  };
  map_constant_.assign(rows, 0.0);
  map_effects_.assign(varied.size() * rows, 0.0);
  map_delta_mu_.assign(6 * pairs_.size() * rows, 0.0);
  for (std::size_t v = 0; v < varied.size(); ++v) {
    residual_space_.add(first_order_, varied[v], 1.0, first_of(map_effects_, v * rows));
  }
  for_each_constant(errors, varied, [&](const FrameEntry& entry, double error) {
    residual_space_.add(first_order_, entry, error, first_of(map_constant_, 0));
  });
  if (chain_->rounded) {
    const std::vector<lie::Screw<double>> motions = nominal_motions(*chain_, displacements);
    for (std::size_t i = 0; i < motions.size(); ++i) residual_space_.add(i, motions[i], first_of(map_constant_, 0));
  }
  const auto copy = [&](const Eigen::MatrixXd& from, std::vector<double>& to, std::size_t at) {
    for (Eigen::Index row = 0; row < from.rows(); ++row) {
      for (Eigen::Index y = 0; y < from.cols(); ++y) {
        to[at + static_cast<std::size_t>(row) * rows + static_cast<std::size_t>(y)] = from(row, y);
      }
    }
  };
  copy(residual_space_.delta_mu(), map_delta_mu_, 0);
}

/// Adds to xi [6] the first-order motion of the platform by an error (rad, m) of the component `entry`: the mean of the
/// motions of the limbs' ends.
void BlockSolver::add_platform_motion(const FrameEntry& entry, double error, std::span<double> xi) {
  first_order_.effect(entry, effect_, slope_);
  lie::Screw<double> sum = first_order_.motion(entry);
  for (std::size_t j = 0; j < slope_.size(); ++j) sum += slope_[j] * first_order_.column(j);
  const double share = error / static_cast<double>(limbs_.size());
  for (std::size_t k = 0; k < 6; ++k) xi[k] += share * sum[static_cast<Eigen::Index>(k)];
}

void BlockSolver::find_platform_map(std::span<const FrameError<double>> errors, std::span<const FrameEntry> varied) {
  effect_.resize(6 * pairs_.size());
  slope_.resize(chain_->passive_joints());
  platform_constant_.assign(6, 0.0);
  platform_effects_.assign(6 * varied.size(), 0.0);
  for (std::size_t v = 0; v < varied.size(); ++v) {
    add_platform_motion(varied[v], 1.0, std::span(platform_effects_).subspan(6 * v, 6));
  }
  for_each_constant(errors, varied, [&](const FrameEntry& entry, double error) {
    add_platform_motion(entry, error, platform_constant_);
  });
}

/// Fits starting points over a range of the varied error. If the fit is not good enough, the function fits both halves
/// of the range.
void BlockSolver::predict_starts(double center, double half_width, int splits_left) {
  const double tail = fit_starts(center, half_width);
  if (tail < kGoodTail || (splits_left == 0 && tail < kTrustedTail)) return;
  // If this fit is usable, the solves at the nodes of both halves start from it. Afterwards this fit is removed,
  // because the fits of the halves replace it.
  const bool useful = tail < kTrustedTail;
  if (!useful) fits_.pop_back();
  if (splits_left == 0) return;
  const std::size_t parent = fits_.size();
  predict_starts(center - half_width / 2.0, half_width / 2.0, splits_left - 1);
  predict_starts(center + half_width / 2.0, half_width / 2.0, splits_left - 1);
  if (useful) fits_.erase(fits_.begin() + static_cast<std::ptrdiff_t>(parent) - 1);
}

/// Interpolates the passive displacements at Chebyshev nodes. Returns the largest of the last three coefficients (rad,
/// m), or infinity if a node is not solved.
double BlockSolver::fit_starts(double center, double half_width) {
  std::array<double, kStartTerms> nodes;
  for (std::size_t k = 0; k < kStartTerms; ++k) nodes[k] = center + half_width * cosines_[kStartTerms + k];
  std::fill(status_.begin(), status_.end(), SolveStatus::iteration_cap);
  KernelOptions direct = options_;
  direct.method = KernelMethod::newton_direct;
  direct.largest_step = kLargestNodeStep;
  run(nodes, kStartTerms, direct, node_displacements_.data());
  const std::size_t stride = kernel_capacity(kStartTerms);
  double* coefficients = coefficients_.data() + fits_made_++ * joints_.size() * kStartTerms;
  fits_.push_back({center, half_width, coefficients});
  if (!std::all_of(status_.begin(), status_.begin() + kStartTerms, solved)) {
    return std::numeric_limits<double>::infinity();
  }
  double tail = 0.0;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    for (std::size_t n = 0; n < kStartTerms; ++n) {
      double sum = 0.0;
      for (std::size_t k = 0; k < kStartTerms; ++k) {
        sum += node_displacements_[j * stride + k] * cosines_[n * kStartTerms + k];
      }
      coefficients[j * kStartTerms + n] = (n == 0 ? 1.0 : 2.0) / kStartTerms * sum;
      if (n + 3 >= kStartTerms) tail = std::max(tail, std::abs(coefficients[j * kStartTerms + n]));
    }
  }
  return tail;
}

void BlockSolver::solve(std::span<const double> values, std::size_t count) {
  if (fidelity_ == Fidelity::first_order) return map(values, count);
  if (platform_ != nullptr) platform_displacements_.resize(joints_.size() * kernel_capacity(count));
  run(values, count, options_, platform_ == nullptr ? nullptr : platform_displacements_.data());
  review(values);
  if (platform_ == nullptr) return;
  const KernelChain chain = kernel_chain();
  const KernelSamples samples{values.data(), varied_, count, count};
  move_platform(chain, samples, nullptr, make_room(chain, samples));
}

/// Computes nearing_ and nearing_constant_, which show how close errors bring the loops to opening. Both are also
/// needed for samples that the kernel solved: if 1 rad weighs as much as 1 m, a solve may find a root although the
/// loops cannot be closed.
void BlockSolver::find_nearing(std::span<const FrameError<double>> errors, std::span<const FrameEntry> varied) {
  nearing_.clear();
  nearing_constant_ = 0.0;
  for (const FrameEntry& entry : varied) nearing_.push_back(assembly_.nearing(entry));
  for_each_constant(errors, varied, [&](const FrameEntry& entry, double error) {
    nearing_constant_ += error * assembly_.nearing(entry);
  });
}

void BlockSolver::add_up_nearing(std::span<const double> values) {
  nearing_of_.assign(count_, nearing_constant_);
  for (std::size_t v = 0; v < nearing_.size(); ++v) {
    const double* of_one = values.data() + v * count_;
    for (std::size_t b = 0; b < count_; ++b) nearing_of_[b] += nearing_[v] * of_one[b];
  }
}

/// Finds the samples that cannot be assembled. Examines the samples without a solution, unless their residual is not
/// finite, and the samples with errors for which the loops may open.
void BlockSolver::review(std::span<const double> values) {
  add_up_nearing(values);
  for (std::size_t b = 0; b < count_; ++b) {
    SolveStatus& status = status_[b];
    if (status == SolveStatus::non_finite || (solved(status) && !(nearing_of_[b] < kNearing))) continue;
    set_frames(values, b);
    if (assembly_.is_impossible(frames_)) status = SolveStatus::not_assembled;
  }
}

/// Sets the fixed frames of one sample, with its errors.
void BlockSolver::set_frames(std::span<const double> values, std::size_t sample) {
  for (std::size_t v = 0; v < entries_.size(); ++v) {
    errors_[entries_[v].frame][static_cast<Eigen::Index>(entries_[v].component)] = values[v * count_ + sample];
  }
  std::size_t frame = 0;
  for (const Limb& limb : chain_->limbs) {
    for (std::size_t j = 0; j < limb.frames(); ++j, ++frame) frames_[frame] = frame_with_error(limb, j, errors_[frame]);
  }
}

void BlockSolver::move_platform(const KernelChain& chain, const KernelSamples& samples, const KernelMap* map,
                                double* scratch) {
  platform_responses_.resize(platform_->rows() * kernel_capacity(samples.count));
  KernelPlatform platform{
      {}, {}, platform_->tool.has_value(), platform_displacements_.data(), map, platform_responses_.data()};
  std::ranges::copy(rows_of(platform_->platform), platform.nominal);
  if (platform.has_tool) std::copy_n(platform_->tool->data(), 3, platform.tool);
  kernels_.move_platform(chain, samples, platform, outcome(nullptr), scratch);
}

void BlockSolver::map(std::span<const double> values, std::size_t count) {
  const KernelChain chain = kernel_chain();
  POESY_EXPECTS(values.size() == varied_ * count);
  const KernelSamples samples{values.data(), varied_, count, count};
  double* scratch = make_room(chain, samples);
  if (is_singular_) {
    std::ranges::fill(status_, SolveStatus::singular);
    std::ranges::fill(iterations_, 1u);
    std::ranges::fill(delta_mu_, kNaN);
    std::ranges::fill(responses_, kNaN);
    if (platform_ != nullptr) platform_responses_.assign(platform_->rows() * kernel_capacity(count), kNaN);
    return;
  }
  const KernelMap map{map_constant_.size(), map_constant_.data(), map_effects_.data(), map_delta_mu_.data()};
  kernels_.map(chain, samples, map, outcome(nullptr), scratch);
  if (platform_ == nullptr) return;
  const KernelMap of_platform{6, platform_constant_.data(), platform_effects_.data(), nullptr};
  move_platform(chain, samples, &of_platform, scratch);
}

void BlockSolver::run(std::span<const double> values, std::size_t count, const KernelOptions& options,
                      double* displacements) {
  POESY_EXPECTS(values.size() == varied_ * count);
  const KernelChain chain = kernel_chain();
  const KernelSamples samples{values.data(), varied_, count, count};
  double* scratch = make_room(chain, samples);
  kernels_.solve(chain, samples, {fits_.data(), fits_.size()}, options, outcome(displacements), scratch);
}

/// Resizes the buffers for these samples. Returns the aligned scratch memory.
double* BlockSolver::make_room(const KernelChain& chain, const KernelSamples& samples) {
  const std::size_t stride = kernel_capacity(samples.count);
  // The extra kMostLanes numbers leave room to begin at an aligned address.
  scratch_.resize(std::max(scratch_.size(), kernel_scratch(chain, samples) + kMostLanes));
  delta_mu_.resize(6 * chain.pairs * stride);
  responses_.resize(3 * stride);
  status_.resize(stride);
  iterations_.resize(stride);
  count_ = samples.count;
  return aligned(scratch_);
}

KernelOutcome BlockSolver::outcome(double* displacements) {
  return {delta_mu_.data(), responses_.data(),  displacements,
          status_.data(),   iterations_.data(), kernel_capacity(count_)};
}

KernelChain BlockSolver::kernel_chain() const {
  return {limbs_.data(),  limbs_.size(),    pairs_.data(),    pairs_.size(),  joints_.data(),
          joints_.size(), segments_.data(), segments_.size(), pieces_.data(), first_order_.idle().data(),
          chain_->idle};
}

}  // namespace poesy::chain
