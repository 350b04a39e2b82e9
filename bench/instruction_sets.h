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

/// Makes evaluators that are built from now on use this instruction set.
inline void choose_instruction_set(const std::string& name) { setenv("POESY_ISA", name.c_str(), 1); }

/// An evaluator that uses this instruction set. Threads may ask at the same time.
inline std::unique_ptr<Evaluator> evaluator_with(const std::string& isa, const Model& model,
                                                 const SolverOptions& options) {
  static std::mutex environment;
  const std::lock_guard lock(environment);
  choose_instruction_set(isa);
  return model.evaluator(options);
}

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
