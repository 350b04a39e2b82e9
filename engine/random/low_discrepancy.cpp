#include "engine/random/low_discrepancy.h"

#include <boost/random/sobol.hpp>

namespace poesy {

struct SobolSequence::Generator {
  boost::random::sobol sequence;
};

SobolSequence::SobolSequence(std::size_t dimensions)
    : generator_(std::make_unique<Generator>(Generator{boost::random::sobol(dimensions)})) {}

SobolSequence::~SobolSequence() = default;

void SobolSequence::next(std::span<double> point) {
  // Boost leaves out the origin. The coordinates of point n are k / 2^m with 2^m > n. So they are never 0 or 1, and
  // exact in a double for the first 2^53 points.
  for (double& coordinate : point) coordinate = static_cast<double>(generator_->sequence()) * 0x1p-64;
}

}  // namespace poesy
