#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/ending.h"
#include "engine/app/shell_scripts.h"
#include "engine/app/shells.h"
#include "engine/base/error.h"
#include "engine/base/text.h"

namespace poesy::app {
namespace {

int print_completion(const CLI::App& program, const std::string& shell) {
  const DescribedProgram described = describe(program);
  if (shell == "bash") {
    std::fputs(bash_completion(described).c_str(), stdout);
  } else if (shell == "zsh") {
    std::fputs(zsh_completion(described).c_str(), stdout);
  } else {
    throw InputError({}, "no completion for '" + printable(shell) + "'",
                     fmt::format("give {}", fmt::join(kShells, " or ")));
  }
  return kDone;
}

}  // namespace

void add_completion(CLI::App& program, Action& action) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command =
      program.add_subcommand("completion", "print a script with which a shell completes poesy's command line");
  command->add_option("shell", *shell, "bash or zsh")->required()->type_name("SHELL");
  command->footer(footer("", {{"in ~/.bashrc: completion in every shell", "eval \"$(poesy completion bash)\""},
                              {"the same for zsh, in a folder of $fpath", "poesy completion zsh > ~/.zfunc/_poesy"}}));
  command->callback(
      [shell, &program, &action] { action = [shell, &program] { return print_completion(program, *shell); }; });
}

}  // namespace poesy::app
