#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "engine/kinds/sobol/result.h"
#include "engine/random/latin_hypercube.h"
#include "engine/random/scrambled_sobol.h"
#include "engine/study/plan.h"

namespace poesy {

/// Consecutive samples of a panel, which are solved at all poses.
struct PanelUnit {
  std::size_t replicate;  ///< replicate of the design; 0 for random draws
  std::size_t first;      ///< sample within the replicate
  std::size_t count;      ///< B
  std::size_t number;     ///< number of the first sample among all of the study
};

/// The two independent samples of which a panel is made.
enum class PanelSample { A, B };

/// A design of points; none for random draws.
using PanelPoints = std::variant<std::monostate, LatinHypercube, ScrambledSobol>;

/// The points of a study of Sobol' indices in the space of the errors, and their division into units of work. The same
/// for any number of threads and ranks.
class PanelDesign {
 public:
  /// The largest number of samples of a unit; milestones of adaptive samples are whole units.
  static constexpr std::size_t kUnitSamples = 125;

  /// Refers to the plan.
  PanelDesign(const Plan& plan, const SobolOptions& asked);

  /// Whether all samples are independent; otherwise only those of different replicates are.
  bool independent() const { return std::holds_alternative<std::monostate>(points_); }
  std::size_t replicates() const { return replicates_; }  ///< The number of replicates; 1 for random draws.
  std::size_t units_per_replicate() const;                ///< The units of each replicate.
  std::size_t units() const { return replicates_ * units_per_replicate(); }  ///< The units of the whole study.
  PanelUnit unit(std::size_t n) const;                                       ///< The n-th unit, replicate by replicate.

  /// The number of units for the first samples. Precondition: samples are independent.
  std::size_t units_for(std::size_t samples) const { return (samples + kUnitSamples - 1) / kUnitSamples; }

  /// [B] Fills in the uniforms of one error in the unit's samples. slot: position among the plan's factors. Sample A of
  /// random draws is that of a Monte Carlo study with draws per machine and the same seed.
  void fill(PanelSample which, std::size_t slot, const PanelUnit& unit, std::span<double> uniforms) const;

 private:
  const Plan* plan_;
  std::size_t replicates_;
  std::size_t samples_;  ///< of each replicate
  PanelPoints points_;
};

}  // namespace poesy
