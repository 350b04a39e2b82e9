#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/base/index.h"

namespace poesy {

/// What draws are used for. The purpose is part of every address, so that draws for different purposes are different.
enum class Purpose : std::uint64_t {
  error_samples = 1,
  sampling_design = 2,
  scrambled_sobol = 3,
  latin_hypercube = 4,
  second_error_samples = 5,  ///< a second sample of the same errors, independent of error_samples
  seed_of_others = 6,        ///< seeds for further sets of machines that a study tries
  calibration = 7,   ///< the remaining uncertainty of a machine after it was measured, and the noise of measurements
  zone_attempts = 8  ///< further draws of a feature after inspection has rejected one
};

/// The address of a sequence of draws, for one factor at one pose. A draw of the sequence is found by the sample index.
struct StreamAddress {
  std::uint64_t seed = 0;                    ///< seed of the study
  Purpose purpose = Purpose::error_samples;  ///< use of the draws; draws for different purposes are independent
  FactorIndex factor;                        ///< index in the list of all factors of the model
  PoseIndex pose;                            ///< index in the list of the study's poses
};

/// The 64 random bits at an address and sample. A pure function: word (sample mod 4) of Philox4x64-10 (Salmon et al.
/// 2011) with key (seed, purpose) and counter (factor, pose, sample / 4, 0).
std::uint64_t random_bits(const StreamAddress& address, SampleIndex sample);

/// The random bits of samples 4 block to 4 block + 3. They take as much time as those of one sample.
std::array<std::uint64_t, 4> random_block(const StreamAddress& address, std::uint64_t block);

/// The smallest uniform that fill_uniforms() draws.
inline constexpr double kSmallestUniform = 0x1p-54;

/// Fills uniforms[k] with the draw of sample first + k, strictly inside (0, 1): the middle of one of 2^53 equal cells
/// of the interval (0, 1); the upper 53 random bits select the cell. Equal to uniform_from_bits(random_bits(address,
/// first + k)).
void fill_uniforms(const StreamAddress& address, SampleIndex first, std::span<double> uniforms);

/// Maps 64 bits to (cell + 0.5) / 2^53 with cell the upper 53 bits, kept below 1.
double uniform_from_bits(std::uint64_t bits);

}  // namespace poesy
