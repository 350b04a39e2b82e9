#include <cstdio>

#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/ending.h"
#include "engine/app/man_page.h"

namespace poesy::app {

void add_man(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("man", "print the manual page, for man");
  command->footer(footer("", {{"read it", "poesy man | man -l -"}}));
  command->callback([&program, &action] {
    action = [&program] {
      std::fputs(man_page(describe(program)).c_str(), stdout);
      return kDone;
    };
  });
}

}  // namespace poesy::app
