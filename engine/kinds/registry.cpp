#include "engine/kinds/registry.h"

#include <algorithm>
#include <array>

#include "engine/base/contract.h"
#include "engine/kinds/coupling/kind.h"
#include "engine/kinds/evaluate/kind.h"
#include "engine/kinds/identification/kind.h"
#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/sensitivity/kind.h"

namespace poesy {
namespace {

constexpr std::array kAll{&kSensitivityKind, &kIdentificationKind, &kMonteCarloKind, &kEvaluateKind, &kCouplingKind};

}  // namespace

std::span<const Kind* const> kinds() { return kAll; }

const Kind* find_kind(std::string_view name) {
  const auto* const found = std::ranges::find(kAll, name, [](const Kind* kind) { return kind->file.name; });
  return found == kAll.end() ? nullptr : *found;
}

const Kind& kind_of(const Study& study) {
  const Kind* const kind = find_kind(name(study.analysis.kind));
  POESY_EXPECTS(kind != nullptr);
  return *kind;
}

const Kind& kind_of(const StoredResult& result) {
  const Kind* const kind = find_kind(result.kind);
  POESY_EXPECTS(kind != nullptr);
  return *kind;
}

std::string_view replayable_kinds() { return "sensitivity, Monte Carlo or evaluate"; }

std::string kinds_that_rank() {
  std::string names;
  for (const Kind* kind : kAll) {
    if (kind->report.two_rankings != nullptr) names += (names.empty() ? "'" : ", '") + std::string(kind->file.name) + "'";
  }
  return names;
}

}  // namespace poesy
