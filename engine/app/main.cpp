#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include "engine/app/command.h"
#include "engine/app/exit_code.h"
#include "engine/base/error.h"
#include "engine/io/version.h"

namespace {

using namespace poesy::app;

int complain(const char* text, ExitCode code) {
  std::fprintf(stderr, "poesy: %s\n", text);
  return code;
}

std::string version_text() {
  return "poesy " + std::string(poesy::poesy_version()) + " (" + std::string(poesy::git_commit()) + ")";
}

int parse_and_run(int argc, char** argv) {
  CLI::App program("poesy: which manufacturing and assembly errors of a parallel robot matter, how much, and where");
  program.set_version_flag("--version", version_text());
  program.require_subcommand(1);
  program.footer("Start with: poesy models; poesy template 2upr-rpu > study.toml; poesy run study.toml");
  Action action;
  for (const auto add : {add_run, add_merge, add_check, add_evaluate, add_show, add_export, add_verify, add_models,
                         add_template, add_tolerances}) {
    add(program, action);
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    return complain((std::string(error.what()) + "; see poesy --help").c_str(), kBadInput);
  }
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file over the limit is an error of its write, as is a full disk
  try {
    return parse_and_run(argc, argv);
  } catch (const poesy::InputError& error) {
    return complain(error.what(), kBadInput);
  } catch (const poesy::FileError& error) {
    return complain(error.what(), kFileTrouble);
  } catch (const std::exception& error) {
    return complain((std::string("internal error: ") + error.what() + "; please report it").c_str(), kInternalError);
  }
}
