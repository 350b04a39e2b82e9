#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/base/index.h"

namespace poesy {

/// What a stream's draws are used for. Part of every address, so that purposes never share draws.
enum class Purpose : std::uint64_t {
  error_samples = 1,
  sampling_design = 2,
  scrambled_sobol = 3,
  latin_hypercube = 4,
  second_error_samples = 5,  ///< independent of error_samples, of the same errors
  seed_of_others = 6,        ///< seeds of additional sets of machines that a study tries
  calibration = 7            ///< what is not known of a machine after its measurement, and noise of measurements
};

/// The address of a sequence of draws: one factor at one pose. The sample index completes it.
struct StreamAddress {
  std::uint64_t seed = 0;                    ///< seed of the study
  Purpose purpose = Purpose::error_samples;  ///< draws for different purposes are independent
  FactorIndex factor;                        ///< position among all factors of the model
  PoseIndex pose;                            ///< position among the study's poses
};

/// The 64 random bits at (address, sample): a pure function, Philox4x64-10 (Salmon et al. 2011)
/// with key (seed, purpose) and counter (factor, pose, sample / 4, 0), word sample mod 4.
std::uint64_t random_bits(const StreamAddress& address, SampleIndex sample);

/// The random bits of samples 4 block to 4 block + 3. All four cost as much as one of them.
std::array<std::uint64_t, 4> random_block(const StreamAddress& address, std::uint64_t block);

/// Fills uniforms[k] with the draw of sample first + k, strictly inside (0, 1): the middle of one of 2^53 cells, which
/// the upper bits select. Equal to uniform_from_bits(random_bits(address, first + k)).
void fill_uniforms(const StreamAddress& address, SampleIndex first, std::span<double> uniforms);

/// Maps 64 bits to (cell + 0.5) / 2^53 with cell the upper 53 bits, kept below 1.
double uniform_from_bits(std::uint64_t bits);

}  // namespace poesy
