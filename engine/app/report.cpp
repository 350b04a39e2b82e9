#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/pdf.h"
#include "engine/app/results.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/study_file.h"
#include "engine/report/report_kind.h"
#include "engine/storage/file_writer.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

struct ReportOptions {
  std::vector<std::string> results;
  std::string report;
};

/// The default path of a report, in the folder of the first result: result.html for result.h5, or before-after.html for
/// several results from before.h5 to after.h5.
std::string default_path(const std::vector<std::string>& results) {
  const std::filesystem::path first(results.front());
  std::string name = first.stem().string();
  if (results.size() > 1) name += "-" + std::filesystem::path(results.back()).stem().string();
  return (first.parent_path() / (name + ".html")).string();
}

bool may_be_replaced(const std::string& path) { return is_marked(path, kReportMark); }

/// Throws InputError if a path has an ending that is not that of a report.
void check_ending(const std::string& path) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  if (ending.empty() || ending == ".html" || ending == ".htm" || is_pdf(path)) return;
  throw InputError({path}, "is not a name of a report", "reports are HTML or PDF: name it REPORT.html or REPORT.pdf");
}

/// Reads a result file, and makes the model and the study that a report needs in addition.
ReportedResult reported(const std::string& path) {
  ReportedResult result{read_result_with_warning(path), path};
  if (std::optional<Study> study = study_in(result.stored, registry())) {
    result.model = build_model(study->mechanism);
    result.study = std::make_shared<const Study>(*std::move(study));
  }
  return result;
}

int report(const ReportOptions& options) {
  const std::string named = options.report.empty() ? default_path(options.results) : options.report;
  const bool pdf = is_pdf(named);
  const std::string path = check_output_path(named, {"report", pdf ? is_pdf_report : may_be_replaced}, options.results);
  check_ending(named);
  std::vector<ReportedResult> results;
  for (const std::string& result : options.results) results.push_back(reported(result));
  const std::string page = html_report(kind_of(results.front().stored).report, results);
  if (!pdf) {
    write_text(path, page);
  } else if (!write_pdf(path, page)) {
    return complain("interrupted: " + path + " is not written", kInterrupted);
  }
  print(printable_line(path) + "\n");
  return kDone;
}

}  // namespace

Command& add_report(Command& program) {
  const auto [command, options] = program.add_command(
      "report", "one HTML file with figures and tables of a result, or of several compared", report);
  command
      .add_value("results", options.results, "RESULT.h5",
                 "result file, or several of one kind, A, B, ..., which are compared with A")
      ->required()
      ->expected(1, kMostResults);
  command.add_value("-o,--output", options.report, "REPORT.html",
                    "report; default: RESULT.html beside the result, A-B.html beside A for several, B the last; "
                    "REPORT.pdf is printed by "
                    "Chromium where it is installed");
  command.examples = {{"gives result.html", "poesy report result.h5"},
                      {"two compared, before-after.html", "poesy report before.h5 after.h5"},
                      {"printed, where Chromium is installed", "poesy report result.h5 -o result.pdf"}};
  return command;
}

}  // namespace poesy::app
