#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/results.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/storage/file_writer.h"

namespace poesy::app {
namespace {

struct FigureOptions {
  std::string result;
  std::string figure;
  std::string response;
  std::string size = "85mm";
  std::optional<std::size_t> top;  ///< largest number of bars of a ranking
  std::string python;
};

/// The Python program that draws the figure. It calls the command `figure` of the Python package poesy, and reports an
/// error if Python lacks this package or matplotlib.
constexpr const char* kDraw = R"py(
import sys
sys.path = [folder for folder in sys.path if folder]  # no modules of the present folder
try:
    import matplotlib
    from poesy.__main__ import main
except ImportError as missing:
    print(f"poesy: {sys.argv[3]}: is not drawn: {sys.executable} cannot import {missing.name or missing}; activate the "
          "environment of ./quickstart python, or name a Python that has both by --python or the variable POESY_PYTHON, "
          "or install python3-poesy with python3-matplotlib", file=sys.stderr)
    sys.exit(2)
sys.exit(main(["figure", *sys.argv[1:]]))
)py";

/// Returns true if the file may be replaced: it is empty, or its content says that matplotlib wrote it.
bool may_be_replaced(const std::string& path) {
  const std::optional<std::string> content = content_of(path);
  return content && (content->empty() || content->find("atplotlib") != std::string::npos);
}

constexpr std::size_t kMostBars = 1000;

constexpr const char* kPythonVariable = "POESY_PYTHON";

/// The Python that draws: the one that the option names, otherwise the one in the variable POESY_PYTHON, otherwise
/// python3.
std::string python_of(const FigureOptions& options) {
  if (!options.python.empty()) return options.python;
  const char* const named = std::getenv(kPythonVariable);
  return named == nullptr || *named == '\0' ? "python3" : named;
}

/// Replaces this process by Python, so the exit code is that of Python.
int figure(const FigureOptions& options) {
  const std::string path = check_output_path(options.figure, {"figure", may_be_replaced}, {{options.result}});
  read_result_with_warning(options.result);
  std::fflush(stdout);
  // A path that begins with a dash must not be read as an option.
  const auto plain = [](const std::string& name) { return name.starts_with('-') ? "./" + name : name; };
  const std::string python = python_of(options);
  std::vector<std::string> words{python,     "-c",        kDraw,    plain(options.result),
                                 "--output", plain(path), "--size", options.size};
  if (!options.response.empty()) words.insert(words.end(), {"--response", options.response});
  if (options.top) words.insert(words.end(), {"--top", std::to_string(*options.top)});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execvp(python.c_str(), arguments.data());
  throw InputError(
      {.file = path}, fmt::format("is not drawn: {} cannot be started", printable(python)),
      "install it with the package poesy for Python (./quickstart python), or name a Python with --python");
}

}  // namespace

Command& add_figure(Command& program) {
  const auto [command, options] =
      program.add_command("figure", "the figure of a result that a paper prints, drawn by Python's matplotlib", figure);
  command.add_value("result", options.result, "RESULT.h5", "result file of any kind")->required();
  command.add_value("-o,--output", options.figure, "FIGURE.pdf", "figure; it ends in .pdf, .svg or .png")->required();
  command.add_value("--response", options.response, "NAME",
                    "response, or a sweep's figure of merit; default: the one of poesy show");
  command.add_value("--size", options.size, "WIDTH", "width; default: 85mm, one column of a journal; 170mm are two");
  command.add_whole_number("--top", options.top, "N", "at most N bars of a ranking", 1, kMostBars);
  command.add_value(
      "--python", options.python, "PATH",
      fmt::format("the Python that draws; default: that of the variable {}, or python3", kPythonVariable));
  command.notes = {
      "Python draws it; it needs the package poesy (./quickstart python, or python3-poesy) and matplotlib."};
  command.examples = {
      {"one column wide", "poesy figure result.h5 -o figure.pdf"},
      {"the page's width", "poesy figure result.h5 -o figure.svg --size 170mm --response tip_position"}};
  return command;
}

}  // namespace poesy::app
