#pragma once

#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/model/model.h"
#include "models/simd/isa.h"

namespace poesy::bench {

/// Selects the instruction set of all evaluators that are built after this call.
inline void choose_instruction_set(const std::string& name) { setenv("POESY_ISA", name.c_str(), 1); }

/// An evaluator that uses this instruction set. Several threads may call this function at the same time.
inline std::unique_ptr<Evaluator> evaluator_with(const std::string& isa, const Model& model,
                                                 const SolverOptions& options) {
  static std::mutex environment;
  const std::lock_guard lock(environment);
  choose_instruction_set(isa);
  return model.evaluator(options);
}

/// The instruction sets that this computer supports, the slowest first.
inline std::vector<std::string> instruction_sets() {
  std::vector<std::string> found;
  for (const char* name : {"plain", "neon", "avx2", "avx512"}) {
    choose_instruction_set(name);
    try {
      simd::selected_isa();
      found.emplace_back(name);
    } catch (const InputError&) {
      // This computer does not support the instruction set.
    }
  }
  unsetenv("POESY_ISA");
  return found;
}

}  // namespace poesy::bench
