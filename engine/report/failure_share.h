#pragma once

namespace poesy {

/// Share of samples without a solution above which statistics of the others mislead (engine/README.md, D8).
inline constexpr double kManyNotConverged = 0.01;

/// Share of samples without a solution above which a reader is warned of them: the share that the study allows
/// (solver.max_not_converged), or 0.1 % where it sets no limit, which is 1.
constexpr double unremarkable_failure_share(double allowed) {
  constexpr double kUsual = 0.001;
  return allowed < 1.0 ? allowed : kUsual;
}

}  // namespace poesy
