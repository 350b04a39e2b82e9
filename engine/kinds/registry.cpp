#include "engine/kinds/registry.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "engine/base/contract.h"
#include "engine/kinds/allocation/kind.h"
#include "engine/kinds/calibration/kind.h"
#include "engine/kinds/coupling/kind.h"
#include "engine/kinds/evaluate/kind.h"
#include "engine/kinds/identification/kind.h"
#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/kinds/sobol/kind.h"
#include "engine/kinds/sweep/kind.h"

namespace poesy {
namespace {

constexpr std::array kAll{&sensitivity::kKind, &identification::kKind, &evaluate::kKind, &monte_carlo::kKind,
                          &sobol::kKind,       &allocation::kKind,     &coupling::kKind};

/// The order of the keys of [analysis] in the reference of study files. Keys that are not listed here come last.
constexpr std::array<std::string_view, 31> kKeys{
    "kind",      "factors",   "samples", "draws",        "calibrated", "conf_level", "background", "reference",
    "linearity", "quantiles", "groups",  "second_order", "design",     "replicates", "pose_share", "cases",
    "limits",    "judge",     "share",   "yield",        "confidence", "aim",        "sigmas",     "cpk",
    "parts",     "linear",    "angular", "limbs",        "components", "sources",    "calibration"};

}  // namespace

std::span<const Kind* const> kinds() { return kAll; }

const StudyKinds& study_kinds() {
  static const StudyKinds all = [] {
    std::vector<const StudyKind*> list;
    for (const Kind* kind : kAll) list.push_back(&kind->study);
    return study_kinds_of(std::move(list), kKeys);
  }();
  return all;
}

const Kind* find_kind(std::string_view name) {
  for (const Kind* kind : {&calibration::kKind, &sweep::kKind}) {  // results have these kinds, but studies do not
    if (name == kind->study.name) return kind;
  }
  const auto* const found = std::ranges::find(kAll, name, [](const Kind* kind) { return kind->study.name; });
  return found == kAll.end() ? nullptr : *found;
}

const Kind& kind_of(const Study& study) {
  const Kind* const kind = find_kind(study.analysis.kind->name);
  POESY_EXPECTS(kind != nullptr);
  return *kind;
}

const Kind& kind_of(const StoredResult& result) {
  const Kind* const kind = find_kind(result.kind);
  POESY_EXPECTS(kind != nullptr);
  return *kind;
}

std::string_view replayable_kinds() { return "sensitivity, Monte Carlo or evaluate"; }

}  // namespace poesy
