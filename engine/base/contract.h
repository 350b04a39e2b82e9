#pragma once

#include <cstdio>
#include <cstdlib>

namespace poesy::detail {

[[noreturn]] inline void contract_broken(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "poesy: %s:%d: broken contract: %s\n", file, line, condition);
  std::abort();
}

}  // namespace poesy::detail

/// Checks a precondition of a function. A failure is a bug in the program, never bad input. The check exists only if
/// POESY_CONTRACTS is defined (presets `debug`, `asan` and `tsan`), so it costs nothing in release builds.
#ifdef POESY_CONTRACTS
#define POESY_EXPECTS(condition) \
  ((condition) ? static_cast<void>(0) : ::poesy::detail::contract_broken(#condition, __FILE__, __LINE__))
#else
#define POESY_EXPECTS(condition) static_cast<void>(0)
#endif
