#include "engine/kinds/result_kinds.h"

#include <algorithm>
#include <array>

#include "engine/base/contract.h"
#include "engine/kinds/evaluate/stored.h"
#include "engine/kinds/sensitivity/set_tolerances.h"

namespace poesy {
namespace {

constexpr std::array kResultKinds{
    ResultKind{.file = kSensitivityFile, .report = kSensitivityReport, .set_tolerances = set_sensitivity_tolerances},
    ResultKind{.file = kMonteCarloFile, .report = kMonteCarloReport},
    ResultKind{.file = kIdentificationFile, .report = kIdentificationReport},
    ResultKind{.file = kCouplingFile, .report = kCouplingReport},
    ResultKind{.file = kEvaluationFile, .report = kEvaluationReport, .given_errors = evaluated_errors}};

}  // namespace

const ResultKind* find_result_kind(std::string_view name) {
  const auto* const found =
      std::ranges::find(kResultKinds, name, [](const ResultKind& kind) { return kind.file.name; });
  return found == kResultKinds.end() ? nullptr : found;
}

const ResultKind& kind_of(const StoredResult& result) {
  const ResultKind* const kind = find_result_kind(result.kind);
  POESY_EXPECTS(kind != nullptr);
  return *kind;
}

std::string kinds_that_rank() {
  std::string names;
  for (const ResultKind& kind : kResultKinds) {
    if (kind.report.two_rankings != nullptr) names += (names.empty() ? "'" : ", '") + std::string(kind.file.name) + "'";
  }
  return names;
}

}  // namespace poesy
