#include <cstdio>

#include "engine/app/changed_result.h"
#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/exit_code.h"
#include "engine/io/result_file.h"

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

}  // namespace poesy::app
