#include <cstdio>

#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/results.h"
#include "engine/base/error.h"

namespace poesy::app {
namespace {

struct ExportOptions {
  std::string result;
  std::string folder;
};

int export_result(const ExportOptions& options) {
  const StoredResult result = read_result_warily(options.result);
  for (const std::string& file : export_tables(result, options.folder)) std::puts(file.c_str());
  return kDone;
}

int verify(const std::string& path) {
  const Verification hashes = verify_result(path);
  if (!hashes.matches()) {
    throw FileError(path, "content hash " + hashes.computed + " does not match the stored " + hashes.stored,
                    "the file was changed or damaged; run the study again");
  }
  std::printf("%s: content_sha256 %s matches\n", path.c_str(), hashes.computed.c_str());
  return kDone;
}

}  // namespace

void add_export(CLI::App& program, Action& action) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = program.add_subcommand("export", "write every table of a result as CSV");
  command->add_option("result", options->result, "result file")->required()->type_name("RESULT.h5");
  command->add_option("-d,--directory", options->folder, "folder for the tables, made if missing")
      ->required()
      ->type_name("DIR");
  command->footer(footer("", {{"tables/global.csv and others", "poesy export result.h5 -d tables"}}));
  command->callback([options, &action] { action = [options] { return export_result(*options); }; });
}

void add_verify(CLI::App& program, Action& action) {
  auto result = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("verify", "recompute a result's content hash; exit 3 if it differs");
  command->add_option("result", *result, "result file")->required()->type_name("RESULT.h5");
  command->footer(footer("", {{"unchanged since it was written?", "poesy verify result.h5"}}));
  command->callback([result, &action] { action = [result] { return verify(*result); }; });
}

}  // namespace poesy::app
