#include <cstdio>

#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/exit_code.h"
#include "engine/app/find_model.h"
#include "engine/report/tables.h"
#include "models/registry.h"

namespace poesy::app {

void add_models(CLI::App& program, Action& action) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("models", "list the mechanisms, or describe one");
  command->add_option("model", *name, "mechanism")->type_name("MODEL");
  command->footer(footer("", {{"which mechanisms are there?", "poesy models"},
                              {"errors, poses and responses of one", "poesy models 2upr-rpu"}}));
  command->callback([name, &action] {
    action = [name] {
      std::fputs((name->empty() ? models_text(registry()) : model_text(find_model(*name))).c_str(), stdout);
      return kDone;
    };
  });
}

}  // namespace poesy::app
