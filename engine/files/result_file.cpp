#include "engine/files/result_file.h"

#include <array>
#include <filesystem>
#include <fstream>

#include "engine/base/error.h"
#include "engine/files/content_hash.h"
#include "engine/files/file_writer.h"
#include "engine/files/output_folder.h"
#include "engine/files/output_path.h"
#include "engine/files/poesy_file.h"
#include "engine/files/result_parts.h"
#include "engine/files/shard_file.h"
#include "engine/run/evaluation.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

void write_file(const std::string& path, h5::File& file) {
  file.set_attribute("/", "content_sha256", content_sha256(file));
  const auto image = file.image();
  FileWriter writer(path);
  writer.expect(image.size());
  writer.write(image);
  writer.commit();
}

/// Composes what every file has, with compose(file) for the rest, and writes it.
template <class Compose>
void compose_and_write(const std::string& path, std::string_view filetype, std::string_view kind, const Study& study,
                       const SelectedPoses& poses, const RunFacts& facts, const Compose& compose) {
  try {
    ResultBuilder result;
    add_header(result, filetype, kind, study, poses);
    compose(result);
    add_facts(result, facts);
    write_file(path, result.file());
  } catch (const h5::Error& error) {
    throw FileError(path, std::string("cannot be composed: ") + error.what(), "report this as a bug of poesy");
  }
}

/// Whether a file is named like a result, or is one: then a newer result may replace it. An empty file holds nothing.
bool may_be_replaced(const std::string& path) {
  if (std::filesystem::path(path).extension() == ".h5") return true;
  constexpr std::array kSignature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  std::array<char, kSignature.size()> begin{};
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), begin.size());
  return file.gcount() == 0 || begin == kSignature;
}

}  // namespace

void write_result(const std::string& path, std::string_view name, const FileKind& kind, const Study& study,
                  const SelectedPoses& poses, const std::any& found, const RunFacts& facts) {
  compose_and_write(path, kResultFile, name, study, poses, facts,
                    [&](ResultBuilder& result) { kind.write(result, study, found); });
}

void write_shard(const std::string& path, const Study& study, const SelectedPoses& poses, const Shard& shard,
                 std::span<const Bytes> stages, const RunFacts& facts) {
  compose_and_write(path, kShardFile, study.analysis.kind->name, study, poses, facts,
                    [&](ResultBuilder& file) { add_shard(file, shard, stages); });
}

void check_result_path(const std::string& path, std::span<const std::string> inputs) {
  check_output_path(path, {"result", may_be_replaced}, inputs);
}

StoredResult read_result(const std::string& path, FindFileKind find_kind) {
  return with_poesy_file(path, [&](const h5::File& file) {
    expect_filetype(path, file, kResultFile);
    StoredResult result;
    read_header(file, result);
    const FileKind* kind = find_kind(result.kind);
    if (kind == nullptr) throw h5::Error("its kind '" + result.kind + "' is unknown");
    kind->read(file, result);
    return result;
  });
}

Verification verify_result(const std::string& path) {
  return with_poesy_file(path, [](const h5::File& file) {
    return Verification{.stored = stored_hash(file), .computed = content_sha256(file)};
  });
}

std::vector<std::string> export_tables(const StoredResult& result, const FileKind& kind, const std::string& folder) {
  CsvTables tables{pose_table(result)};
  kind.append_tables(tables, result);
  OutputFolder output(folder);
  for (const CsvTable& table : tables) output.claim(table.name + ".csv");
  output.open();
  std::vector<std::string> paths;
  for (const CsvTable& table : tables) paths.push_back(write_csv(folder, table));
  output.close();
  return paths;
}

}  // namespace poesy
