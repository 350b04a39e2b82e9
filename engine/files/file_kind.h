#pragma once

#include <any>
#include <string_view>
#include <vector>

#include "engine/study/study.h"

namespace poesy {

namespace h5 {
class File;
}
class ResultBuilder;
struct CsvTable;
struct StoredResult;

/// How files keep what a kind of study found: a row for each kind.
struct FileKind {
  /// Adds the names of errors and responses (add_names), and the kind's groups. found: of the type that the kind finds.
  void (*write)(ResultBuilder& result, const Study& study, const std::any& found);
  /// Fills in StoredResult::found, and of the header what the kind's files have. The rest of the header is there.
  void (*read)(const h5::File& file, StoredResult& result);
  /// Appends the tables that `poesy export` writes, all but that of the poses.
  void (*append_tables)(std::vector<CsvTable>& tables, const StoredResult& result);
};

/// Finds the row of this name; null where there is none.
using FindFileKind = const FileKind* (*)(std::string_view name);

}  // namespace poesy
