#include "bench/peak_kernel.h"

namespace poesy::bench {

using Vector [[gnu::vector_size(16)]] = double;

std::uint64_t multiply_adds_plain(std::uint64_t repetitions) { return multiply_adds<Vector>(repetitions); }
double sum_plain(std::span<const double> numbers) { return sum<Vector>(numbers); }

}  // namespace poesy::bench
