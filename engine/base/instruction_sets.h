#pragma once

#include "engine/base/sanitizers.h"

// A copy of a function for each instruction set, chosen when the program is loaded: put before its definition. Where
// the file is compiled without contraction of multiply-adds (-ffp-contract=off), all copies give the same bits.
// Sanitizers do not get on with the choosing.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(POESY_SANITIZED)
#define POESY_EACH_INSTRUCTION_SET __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define POESY_EACH_INSTRUCTION_SET
#endif
