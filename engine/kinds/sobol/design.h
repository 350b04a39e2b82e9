#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "engine/kinds/sobol/result.h"
#include "engine/random/latin_hypercube.h"
#include "engine/random/scrambled_sobol.h"
#include "engine/study/plan.h"

namespace poesy::sobol {

/// A unit of work: consecutive samples of a panel (IndexPanel), which are solved at all poses. A sample of a panel
/// consists of a set of errors A, another set B, and mixtures of the two.
struct PanelUnit {
  std::size_t replicate;  ///< number of the replicate of the design that has the samples; 0 for random draws
  std::size_t first;      ///< position of the first sample within the replicate
  std::size_t count;      ///< number of samples
  std::size_t number;     ///< position of the first sample among all samples of the study
};

/// The two independent samples that a panel (IndexPanel) mixes.
enum class PanelSample { A, B };

/// The points of a design; std::monostate for random draws.
using PanelPoints = std::variant<std::monostate, LatinHypercube, ScrambledSobol>;

/// The points of a study of Sobol' indices in the space of the errors, divided into units of work. They are the same
/// for any number of threads and ranks.
class PanelDesign {
 public:
  /// The largest number of samples in a unit. Adaptive sampling decides only after whole units.
  static constexpr std::size_t kUnitSamples = 125;

  /// Keeps a reference to the plan.
  PanelDesign(const Plan& plan, const Options& asked);

  /// Whether all samples are independent. If not, only samples of different replicates are.
  bool independent() const { return std::holds_alternative<std::monostate>(points_); }
  std::size_t replicates() const { return replicates_; }  ///< The number of replicates; 1 for random draws.
  std::size_t units_per_replicate() const;                ///< The number of units in each replicate.
  /// The number of units of the whole study.
  std::size_t units() const { return replicates_ * units_per_replicate(); }
  PanelUnit unit(std::size_t n) const;  ///< Unit n, counted replicate by replicate.

  /// The number of units that contain the first `samples` samples of the study. Precondition: samples are independent.
  std::size_t units_for(std::size_t samples) const { return (samples + kUnitSamples - 1) / kUnitSamples; }

  /// Sets `uniforms` [samples] to the uniform numbers from which one error of the unit's samples is computed. slot:
  /// position of the error in Plan::factors(). With random draws, sample A equals the sample of a Monte Carlo study
  /// with draws per machine and the same seed.
  void fill(PanelSample which, std::size_t slot, const PanelUnit& unit, std::span<double> uniforms) const;

 private:
  const Plan* plan_;
  std::size_t replicates_;
  std::size_t samples_;  ///< number of samples in each replicate
  PanelPoints points_;
};

}  // namespace poesy::sobol
