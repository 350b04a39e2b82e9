#include "engine/kinds/result_file.h"

#include "engine/kinds/registry.h"

namespace poesy {
namespace {

const FileKind* find_file_kind(std::string_view name) {
  const Kind* const kind = find_kind(name);
  return kind == nullptr ? nullptr : &kind->file;
}

}  // namespace

void write_result(const std::string& path, const Study& study, const SelectedPoses& poses, const std::any& found,
                  const RunFacts& facts) {
  write_result(path, study.analysis.kind->name, kind_of(study).file, study, poses, found, facts);
}

StoredResult read_result(const std::string& path) { return read_result(path, find_file_kind); }

std::vector<std::string> export_tables(const StoredResult& result, const std::string& folder) {
  return export_tables(result, kind_of(result).file, folder);
}

std::vector<std::string> export_tables(const std::string& result_path, const std::string& folder) {
  return export_tables(read_result(result_path), folder);
}

}  // namespace poesy
