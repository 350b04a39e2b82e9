#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/mpi_ranks.h"
#include "engine/app/terminal.h"
#include "engine/base/address_space.h"
#include "engine/base/error.h"
#include "engine/storage/version.h"

namespace poesy::app {
namespace {

std::string version_text() { return "poesy " + std::string(poesy_version()) + " (" + std::string(git_commit()) + ")"; }

void describe_program(Command& program) {
  program.formatter(help_formatter());
  program.set_help_flag("-h,--help", "print this help");
  program.set_version_flag("-v,--version", version_text(), "print the version");
  program.require_subcommand(1);
  program.notes = {
      "A study file says which mechanism, errors and poses are looked at, and how. poesy draws the errors, "
      "solves the mechanism for every pose and draw, and writes what it found to a result file."};
  program.examples = {{"which mechanisms are there?", "poesy models"},
                      {"a study to start from", "poesy template 2upr-rpu > study.toml"},
                      {"gives study.h5", "poesy run study.toml"},
                      {"the errors that matter most", "poesy show study.h5"}};
}

constexpr const char* kAboutTheProgram = "About the program";

/// Adds all commands to the program, in the groups in which its help shows them.
void add_commands(Command& program) {
  const auto group = [&](const char* title, std::initializer_list<Command& (*)(Command&)> commands) {
    for (const auto add : commands) add(program).group(title);
  };
  group("Prepare a study", {add_models, add_template, add_check});
  group("Compute", {add_run, add_sweep, add_merge, add_evaluate, add_calibrate});
  group("Look at results", {add_show, add_report, add_figure, add_tolerances, add_replay, add_export, add_verify});
  group(kAboutTheProgram, {add_help, add_version, add_completion});
  program.set_help_all_flag("--help-all", "print the help of all commands");
}

/// Throws FileError if there is not enough memory to start; without this check, some versions of HDF5 (1.10) would
/// crash.
void expect_memory() {
  constexpr std::size_t kLeast = std::size_t{24} << 20U;
  constexpr std::uintmax_t kMega = 1'000'000;
  if (has_address_space(kLeast)) return;
  const FileError error("",
                        "this takes " + std::to_string((address_space() + kLeast) / kMega + 1) +
                            " MB of memory at least, and this process may have " +
                            std::to_string(most_address_space() / kMega) + " MB",
                        "raise the limit (ulimit -v)");
  // The ranks are not connected yet, so the first process cannot report this rank's error.
  if (!is_first_process()) say(Message::error, "rank " + std::to_string(find_launch()->rank) + ": " + error.what());
  throw error;
}

/// Throws FileError if the limit on open files is too low, because libraries do not report this problem.
void expect_open_files() {
  constexpr std::size_t kLeast = 16;
  std::vector<int> files;
  bool few = false;
  while (!few && files.size() < kLeast) {
    const int file = ::open("/", O_PATH | O_CLOEXEC);
    if (file >= 0) files.push_back(file);
    few = file < 0;
  }
  for (const int file : files) ::close(file);
  if (!few) return;
  throw FileError("",
                  "this takes " + std::to_string(kLeast) + " open files at once, and this process may have " +
                      std::to_string(files.size()) + " more",
                  "raise the limit on open files (ulimit -n)");
}

int parse_and_run(int argc, char** argv) {
  Command program("", "which manufacturing and assembly errors of a parallel robot matter, how much, and where");
  describe_program(program);
  add_commands(program);
  if (argc < 2) {
    print(program.help());
    return kDone;
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    if (!has_unknown_command(program)) return program.exit(help);
    return complain(command_line_problem(program, help), kBadInput);
  } catch (const CLI::ParseError& error) {
    return complain(command_line_problem(program, error), kBadInput);
  }
  if (const auto problem = impossible_value(program)) return complain(*problem, kBadInput);
  const auto& called = dynamic_cast<const Command&>(*program.get_subcommands().front());
  if (called.get_group() != kAboutTheProgram) {
    expect_memory();
    expect_open_files();
  }
  // Only `run` shares its work between ranks; other commands run on the first process.
  if (called.get_name() != "run" && !is_first_process()) return kDone;
  return called.action();
}

/// Returns the exit code of the command, or that of an error if standard output could not be written.
int flushed(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  say(Message::error, "what was to be printed cannot be written; see whether there is room where it goes");
  return kFileTrouble;
}

}  // namespace
}  // namespace poesy::app

int main(int argc, char** argv) {
  poesy::save_address_space();
  poesy::return_large_lists();
  std::signal(SIGXFSZ, SIG_IGN);  // lets a write beyond the limit on file sizes fail, as on a full disk
  return poesy::app::flushed(poesy::app::exit_code_of([=] { return poesy::app::parse_and_run(argc, argv); }));
}
