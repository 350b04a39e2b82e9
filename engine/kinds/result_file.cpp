#include "engine/kinds/result_file.h"

#include <algorithm>
#include <utility>

#include "engine/base/error.h"
#include "engine/kinds/registry.h"

namespace poesy {

void write_result(const std::string& path, const Study& study, const SelectedPoses& poses, std::any found,
                  const RunFacts& facts, const DrawingResult* drawing) {
  write_result(path, study.analysis.kind->name, kind_of(study).file, study, poses, std::move(found), facts, drawing);
}

StoredResult as_stored(const Study& study, const SelectedPoses& poses, std::any found, const DrawingResult* drawing) {
  return as_stored(study.analysis.kind->name, kind_of(study).file, study, poses, std::move(found), drawing);
}

StoredResult read_result(const std::string& path) {
  return read_result(path, [](std::string_view name) -> const FileKind* {
    const Kind* const kind = find_kind(name);
    return kind == nullptr ? nullptr : &kind->file;
  });
}

std::vector<std::string> export_tables(const StoredResult& result, const std::string& folder) {
  return export_tables(result, kind_of(result).file, folder);
}

std::vector<std::string> export_tables(const std::string& result_path, const std::string& folder) {
  return export_tables(read_result(result_path), folder);
}

std::string set_tolerances(const StoredResult& result, const TolerancesOptions& options, const Catalog& catalog,
                           std::size_t width) {
  const SetTolerances set = kind_of(result).set_tolerances;
  if (set != nullptr) return set(result, options, catalog, width);
  const auto has_tolerances = [](const Kind* kind) { return kind->set_tolerances != nullptr; };
  const std::string able((*std::ranges::find_if(kinds(), has_tolerances))->study.name);
  throw InputError({options.result}, "tolerances need indices, but this is a result of kind '" + result.kind + "'",
                   "give the result of a " + able + " study");
}

}  // namespace poesy
