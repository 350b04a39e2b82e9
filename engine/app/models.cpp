#include <cstdio>

#include "engine/app/command_line.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/study_file.h"
#include "engine/report/tables.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

/// The mechanism of that name, in capitals or small letters. Throws InputError that lists the known ones.
const CatalogEntry& find_model(const std::string& name) {
  if (const CatalogEntry* entry = find(registry(), name)) return *entry;
  std::vector<std::string_view> known;
  for (const CatalogEntry& entry : registry()) known.push_back(entry.description.name);
  throw InputError({}, "no model '" + printable(name) + "'", suggestion(lower_case(name), known));
}

const StudyKind& kind_named(const std::string& word) {
  if (const StudyKind* kind = find(study_kinds(), word)) return *kind;
  throw InputError({}, "no template of kind '" + printable(word) + "'", suggestion(word, names(study_kinds())));
}

struct TemplateOptions {
  std::string model;
  std::string kind{study_kinds().all.front()->name};
  bool reference = false;
};

int print_template(const TemplateOptions& options) {
  if (options.reference) {
    print(study_reference());
    return kDone;
  }
  const CatalogEntry& entry = find_model(options.model);
  const StudyKind& wanted = kind_named(options.kind);
  ModelDescription as_named = entry.description;
  as_named.name = options.model;
  if (const auto refusal = wanted.no_template != nullptr ? wanted.no_template(as_named) : std::nullopt) {
    throw InputError({}, refusal->problem, refusal->remedy);
  }
  print(template_text(entry, wanted));
  return kDone;
}

int print_models(const std::string& name) {
  print(name.empty() ? models_text(registry()) : model_text(find_model(name)));
  return kDone;
}

}  // namespace

Command& add_models(Command& program) {
  const auto [command, name] = program.add_command("models", "list the mechanisms, or describe one", print_models);
  command.add_value("model", name, "MODEL", "mechanism");
  command.examples = {{"which mechanisms are there?", "poesy models"},
                      {"errors, poses and responses of one", "poesy models 2upr-rpu"}};
  return command;
}

Command& add_template(Command& program) {
  const auto [command, options] =
      program.add_command("template", "print a complete, commented study file", print_template);
  CLI::Option* named = command.add_value("model", options.model, "MODEL", "mechanism");
  command.add_value("kind", options.kind, "KIND", "kind of study: " + either(names(study_kinds())));
  command.add_flag("--reference", options.reference, "print the reference of all keys of study files, as Markdown")
      ->excludes(named);
  command.examples = {{"a sensitivity study", "poesy template 2upr-rpu > study.toml"},
                      {"all errors at once", "poesy template 3-prs monte-carlo > study.toml"},
                      {"every key of a study file, as text", "poesy template --reference"}};
  command.callback([&reference = options.reference, named] {
    if (!reference && named->count() == 0) throw CLI::RequiredError(named->get_type_name());
  });
  return command;
}

}  // namespace poesy::app
