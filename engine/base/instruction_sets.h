#pragma once

#include "engine/base/sanitizers.h"

// A macro before the definition of a function. The function is compiled for each instruction set, and the program
// chooses a copy when it is loaded. All copies give the same bits if the file is compiled without contraction of
// multiply-adds (-ffp-contract=off). Sanitizers do not support this choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(POESY_SANITIZED)
#define POESY_EACH_INSTRUCTION_SET __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define POESY_EACH_INSTRUCTION_SET
#endif
