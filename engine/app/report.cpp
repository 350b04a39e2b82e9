#include <cstdio>
#include <filesystem>
#include <system_error>
#include <vector>

#include "engine/app/changed_result.h"
#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/exit_code.h"
#include "engine/io/file_writer.h"
#include "engine/io/output_path.h"
#include "engine/report/html/report.h"

namespace poesy::app {
namespace {

struct Options {
  std::vector<std::string> results;
  std::string report;
};

/// result.h5 gives result.html beside it.
std::string default_path(const std::string& result) {
  return std::filesystem::path(result).replace_extension(".html").string();
}

/// Whether a file is named like a report; an empty one holds nothing.
bool may_be_replaced(const std::string& path) {
  const std::filesystem::path extension = std::filesystem::path(path).extension();
  std::error_code ignored;
  return extension == ".html" || extension == ".htm" || std::filesystem::file_size(path, ignored) == 0;
}

void write_whole(const std::string& path, const std::string& html) {
  FileWriter file(path);
  file.expect(html.size());
  file.write(html);
  file.commit();
}

int report(const Options& options) {
  const std::string path = options.report.empty() ? default_path(options.results.front()) : options.report;
  check_output_path(path, {"report", may_be_replaced}, options.results);
  std::vector<ReportedResult> results;
  for (const std::string& result : options.results) results.push_back({read_result_warily(result), result});
  write_whole(path, html_report(results));
  std::puts(path.c_str());
  return kDone;
}

}  // namespace

void add_report(CLI::App& program, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      program.add_subcommand("report", "one HTML file with figures and tables of a result, or of two compared");
  command->add_option("results", options->results, "result file, or two to be compared")
      ->required()
      ->expected(1, 2)
      ->type_name("RESULT.h5");
  command->add_option("-o,--output", options->report, "report; default: RESULT.html beside the result")
      ->type_name("REPORT.html");
  command->footer(footer("", {{"gives result.html", "poesy report result.h5"},
                              {"two results compared", "poesy report before.h5 after.h5 -o change.html"}}));
  command->callback([options, &action] { action = [options] { return report(*options); }; });
}

}  // namespace poesy::app
