#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "models/simd/isa.h"

namespace poesy::bench {

/// Makes evaluators that are built from now on use this instruction set.
inline void choose_instruction_set(const std::string& name) { setenv("POESY_ISA", name.c_str(), 1); }

/// The instruction sets that this machine has, slowest first.
inline std::vector<std::string> instruction_sets() {
  std::vector<std::string> found;
  for (const char* name : {"plain", "neon", "avx2", "avx512"}) {
    choose_instruction_set(name);
    try {
      simd::selected_isa();
      found.emplace_back(name);
    } catch (const InputError&) {
      // Not on this machine.
    }
  }
  unsetenv("POESY_ISA");
  return found;
}

}  // namespace poesy::bench
