// Fuzzes result files and shards. A result that can be read is printed, reported and exported; no other file may be
// read. A crash or a hang of HDF5 in the child process that reads first (engine/storage/poesy_file.h) is allowed, but
// not in this process.
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <vector>

#include "engine/base/error.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/result_file.h"
#include "engine/report/report_kind.h"
#include "engine/report/table.h"
#include "engine/report/tables.h"
#include "engine/result/shard_file.h"
#include "engine/storage/output_folder.h"
#include "tests/fuzz/h5_checksums.h"
#include "tests/fuzz/other_file.h"
#include "tests/fuzz/shared_coverage.h"
#include "tests/fuzz/target.h"
#include "tests/support/temp_folder.h"

namespace {

using namespace poesy;

/// The folder for exported tables, the same for all inputs.
const test::TempFolder& folder() {
  static const test::TempFolder only;
  return only;
}

/// Limits the CPU time of child processes to less than the fuzzer allows for an input.
void limit_children() {
  pthread_atfork(nullptr, nullptr, [] {
    constexpr rlim_t kSeconds = 2;
    const rlimit limits{.rlim_cur = kSeconds, .rlim_max = kSeconds};
    ::setrlimit(RLIMIT_CPU, &limits);
  });
}

void use(const std::string& path) {
  const StoredResult result = read_result(path);
  const ReportKind& kind = kind_of(result).report;
  const SolveTally tally = kind.tally(result);
  static_cast<void>(summary_text(result, tally, 80));
  static_cast<void>(failures_text(result, tally, path, 80));
  const std::vector<Table> tables = result_tables(kind, result, {default_ranking(result)});
  for (const std::size_t width : {std::size_t{1}, std::size_t{80}, kUnlimitedWidth}) {
    static_cast<void>(text_of(tables, width));
  }
  static_cast<void>(json_of(result, tally.total(), tables));
  const ReportedResult reported{result, path};
  static_cast<void>(html_report(kind, {&reported, 1}));
  for (const std::string& table : export_tables(path, folder().path())) {
    fuzz::expect(std::filesystem::path(table).parent_path() == folder().path(), "tables lie in the named folder");
    ::unlink(table.c_str());
  }
  ::unlink((folder() / kManifest).c_str());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bool once = (fuzz::share_coverage(), limit_children(), true);
  static_cast<void>(once);
  const fuzz::OtherFile& other = fuzz::other_file();
  std::vector<std::uint8_t> bytes(data, data + size);
  fuzz::repair_checksums(bytes);
  const fuzz::MemoryFile file(bytes);
  fuzz::accepted<FileError>([&] { static_cast<void>(verify_result(file.path())); });
  fuzz::accepted<FileError>([&] { use(file.path()); });
  fuzz::accepted<FileError>([&] { static_cast<void>(read_shard(file.path())); });
  fuzz::expect(!other.was_read(), "a result reads nothing but itself");
  return 0;
}
