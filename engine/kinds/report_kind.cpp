#include "engine/kinds/report_kind.h"

namespace poesy {

const ReportKind& kind_of(const StoredResult& result) {
  for (const ReportKind* kind : {&kSensitivityReport, &kMonteCarloReport, &kIdentificationReport, &kCouplingReport}) {
    if (kind->name == result.kind) return *kind;
  }
  return kEvaluationReport;
}

}  // namespace poesy
