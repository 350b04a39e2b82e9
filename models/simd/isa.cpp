#include "models/simd/isa.h"

#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

#include "engine/base/error.h"

namespace poesy::simd {
namespace {

bool has(Isa isa) {
  switch (isa) {
    case Isa::plain:
      return true;
    case Isa::avx2:
#ifdef __x86_64__
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
#else
      return false;
#endif
    case Isa::avx512:
#ifdef __x86_64__
      return has(Isa::avx2) && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
             __builtin_cpu_supports("avx512cd");
#else
      return false;
#endif
    case Isa::neon:
#ifdef __aarch64__
      return true;
#else
      return false;
#endif
  }
  return false;
}

struct NamedIsa {
  std::string_view name;
  Isa isa;
};
constexpr std::array<NamedIsa, 4> kBestFirst{
    {{"avx512", Isa::avx512}, {"avx2", Isa::avx2}, {"neon", Isa::neon}, {"plain", Isa::plain}}};

}  // namespace

Isa selected_isa() {
  const char* wanted = std::getenv("POESY_ISA");
  std::string known;
  for (const NamedIsa& each : kBestFirst) {
    if (!has(each.isa)) continue;
    if (wanted == nullptr || *wanted == '\0' || each.name == wanted) return each.isa;
    known += (known.empty() ? "" : ", ") + std::string(each.name);
  }
  throw InputError({}, "POESY_ISA is '" + std::string(wanted) + "', which this machine does not have",
                   "unset it, or choose from " + known);
}

}  // namespace poesy::simd
