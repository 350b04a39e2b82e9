#include "bench/peak_kernel.h"

namespace poesy::bench {

using Vector [[gnu::vector_size(64)]] = double;

std::uint64_t multiply_adds_avx512(std::uint64_t repetitions) { return multiply_adds<Vector>(repetitions); }
double sum_avx512(std::span<const double> numbers) { return sum<Vector>(numbers); }

}  // namespace poesy::bench
