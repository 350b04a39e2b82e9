#pragma once

#include "engine/base/sanitizers.h"

// Put before a definition, compiles the function for each instruction set; the copy is chosen when the program is
// loaded. All copies give the same bits if the file is compiled without contraction of multiply-adds
// (-ffp-contract=off). Sanitizers do not support this choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(POESY_SANITIZED)
#define POESY_EACH_INSTRUCTION_SET __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define POESY_EACH_INSTRUCTION_SET
#endif
