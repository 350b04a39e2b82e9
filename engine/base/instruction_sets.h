#pragma once

#include "engine/base/sanitizers.h"

// Put this macro before the definition of a function. The function is then compiled once for each instruction set, and
// the fastest copy that the processor supports is chosen when the program is loaded. All copies give the same bits if
// the file is compiled with -ffp-contract=off. With sanitizers, which do not support such copies, the macro is empty.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(POESY_SANITIZED)
#define POESY_EACH_INSTRUCTION_SET __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define POESY_EACH_INSTRUCTION_SET
#endif
