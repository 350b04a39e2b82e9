#pragma once

#include <string>
#include <vector>

#include "engine/files/file_kind.h"
#include "engine/files/result_file.h"
#include "engine/kinds/coupling/coupling.h"
#include "engine/report/report_kind.h"
#include "engine/report/tables.h"
#include "engine/run/result.h"

/// What a file keeps of a coupling study.
namespace poesy {

/// What a coupling study found, with the names of its axes.
struct StoredCoupling {
  CouplingResult found;                 ///< the numbers
  std::vector<std::string> size_names;  ///< [Z] "0.1 mm"
  std::vector<double> linear;           ///< [Z] m; NaN where no error is a length
  std::vector<double> angular;          ///< [Z] rad; NaN where no error is an angle
  std::vector<std::string> sources;     ///< [S] names
  std::vector<std::string> subsets;     ///< [K] "FS+T"
};

/// Precondition: a coupling result.
inline const StoredCoupling& coupling_of(const StoredResult& result) { return found_of<StoredCoupling>(result); }

/// For each size and each response that a summary shows: a table with a row for each subset of
/// the sources. Columns: the largest |effect| over the poses and the pose where it is, by number and coordinates, the
/// largest root sum square, worst case and |interaction|, and where sources oppose each other: at which share of the
/// poses, and the pose where they cancel most, with the cancellation there. What the words mean is below the last
/// one.
std::vector<Table> coupling_tables(const StoredResult& result, const TableOptions& options = {});

/// How files keep what such a study found, and how reports show it.
/// @{
extern const FileKind kCouplingFile;
extern const ReportKind kCouplingReport;
/// @}

}  // namespace poesy
