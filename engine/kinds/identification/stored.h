#pragma once

#include <vector>

#include "engine/files/file_kind.h"
#include "engine/files/result_file.h"
#include "engine/kinds/identification/identification.h"
#include "engine/kinds/identification/options.h"
#include "engine/report/report_kind.h"
#include "engine/report/tables.h"
#include "engine/run/result.h"

/// What a file keeps of an identification.
namespace poesy {

/// What an identification says, read back.
struct StoredIdentification : IdentificationResult {
  std::vector<ErrorSize> sizes;  ///< [G] of the errors, by group
};

/// Precondition: the result of an identification.
inline const StoredIdentification& identification_of(const StoredResult& result) {
  return found_of<StoredIdentification>(result);
}

/// The errors that deform, limb by limb as far as their order goes, with the counts of poses
/// behind the verdicts; then the couplings, where there are any.
std::vector<Table> identification_tables(const StoredResult& result, const TableOptions& options = {});

/// How files keep what such a study found, and how reports show it.
/// @{
extern const FileKind kIdentificationFile;
extern const ReportKind kIdentificationReport;
/// @}

}  // namespace poesy
