#include "engine/run/result.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace poesy {
SolveCounts total_of(const std::vector<SolveCounts>& cells) {
  SolveCounts sum;
  for (const SolveCounts& cell : cells) sum.merge(cell);
  return sum;
}

std::uint64_t SolveCounts::total() const {
  return std::accumulate(by_status.begin(), by_status.end(), std::uint64_t{0});
}

std::uint64_t SolveCounts::not_converged() const {
  std::uint64_t count = 0;
  for (std::size_t s = 0; s < by_status.size(); ++s) {
    if (!solved(static_cast<SolveStatus>(s))) count += by_status[s];
  }
  return count;
}

void SolveCounts::add(SolveStatus status, std::uint32_t sample_iterations) {
  ++by_status[static_cast<std::size_t>(status)];
  iterations += sample_iterations;
  most_iterations = std::max(most_iterations, sample_iterations);
}

void SolveCounts::merge(const SolveCounts& other) {
  for (std::size_t s = 0; s < by_status.size(); ++s) by_status[s] += other.by_status[s];
  iterations += other.iterations;
  most_iterations = std::max(most_iterations, other.most_iterations);
}

void SolveCounts::write(ByteWriter& to) const {
  for (const std::uint64_t count : by_status) to.number(count);
  to.number(iterations);
  to.number(most_iterations);
}

SolveCounts SolveCounts::read(ByteReader& from) {
  SolveCounts solves;
  for (std::uint64_t& count : solves.by_status) {
    count = from.number_up_to(std::numeric_limits<std::uint64_t>::max() - solves.total());
  }
  solves.iterations = from.number();
  solves.most_iterations = static_cast<std::uint32_t>(from.number_up_to(std::numeric_limits<std::uint32_t>::max()));
  return solves;
}

bool LimitVerdicts::passed() const {
  return std::ranges::all_of(limits, [](const LimitVerdict& one) { return one.passed; });
}

}  // namespace poesy
