#include <csignal>
#include <cstdio>
#include <string>

#include "engine/app/command.h"
#include "engine/app/exit_code_of.h"
#include "engine/app/launch.h"
#include "engine/io/version.h"

namespace {

using namespace poesy::app;

std::string version_text() {
  return "poesy " + std::string(poesy::poesy_version()) + " (" + std::string(poesy::git_commit()) + ")";
}

int parse_and_run(int argc, char** argv) {
  CLI::App program("poesy: which manufacturing and assembly errors of a parallel robot matter, how much, and where");
  program.set_version_flag("--version", version_text());
  program.require_subcommand(1);
  program.footer("Start with: poesy models; poesy template 2upr-rpu > study.toml; poesy run study.toml");
  Action action;
  for (const auto add : {add_run, add_check, add_evaluate, add_show, add_report, add_replay, add_merge, add_export, add_verify,
                         add_models, add_template, add_tolerances}) {
    add(program, action);
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    return complain(std::string(error.what()) + "; see poesy --help", kBadInput);
  }
  // Nothing else knows how to share its work; under a launcher the first process does it.
  if (!program.got_subcommand("run") && find_launch().value_or(Launch()).rank != 0) return kDone;
  return action();
}

/// The exit code, unless what was printed did not arrive.
int flushed(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  std::fputs("poesy: what was to be printed cannot be written; see whether there is room where it goes\n", stderr);
  return kFileTrouble;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file over the limit is an error of its write, as is a full disk
  return flushed(exit_code_of([=] { return parse_and_run(argc, argv); }));
}
