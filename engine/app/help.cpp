#include <cstdio>

#include "engine/app/command.h"
#include "engine/app/command_line_problem.h"
#include "engine/app/description.h"
#include "engine/app/ending.h"
#include "engine/app/help_text.h"

namespace poesy::app {
namespace {

int print_help(const CLI::App& program, const std::string& name) {
  const auto named = program.get_subcommands([&](const CLI::App* command) { return command->get_name() == name; });
  if (!name.empty() && named.empty()) return complain(unknown_command(name, program), kBadInput);
  std::fputs(help_text(name.empty() ? program : *named.front(), help_width()).c_str(), stdout);
  return kDone;
}

}  // namespace

void add_help(CLI::App& program, Action& action) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("help", "explain a command, or list all of them");
  command->add_option("command", *name, "command to explain")->type_name("COMMAND");
  command->footer(footer("", {{"what can poesy do?", "poesy help"}, {"the options of a run", "poesy help run"}}));
  command->callback([name, &program, &action] { action = [name, &program] { return print_help(program, *name); }; });
}

void add_version(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("version", "print the version");
  command->footer(footer("", {{"version and commit", "poesy version"}}));
  command->callback([&program, &action] {
    action = [&program] {
      std::puts(program.version().c_str());
      return kDone;
    };
  });
}

}  // namespace poesy::app
