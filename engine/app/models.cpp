#include <cstdio>

#include "engine/app/command_line.h"
#include "engine/app/ending.h"
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

int print_template(const std::string& model, const std::string& kind) {
  const CatalogEntry& entry = find_model(model);
  const StudyKind& wanted = kind_named(kind);
  ModelDescription as_named = entry.description;
  as_named.name = model;
  if (const auto refusal = wanted.no_template != nullptr ? wanted.no_template(as_named) : std::nullopt) {
    throw InputError({}, refusal->problem, refusal->remedy);
  }
  std::fputs(template_text(entry, wanted).c_str(), stdout);
  return kDone;
}

int print_reference() {
  std::fputs(study_reference().c_str(), stdout);
  return kDone;
}

}  // namespace

Command& add_models(Command& program) {
  const auto name = std::make_shared<std::string>();
  Command& command = program.add_command("models", "list the mechanisms, or describe one");
  command.add_value("model", *name, "MODEL", "mechanism");
  command.examples = {{"which mechanisms are there?", "poesy models"},
                      {"errors, poses and responses of one", "poesy models 2upr-rpu"}};
  command.action = [name] {
    std::fputs((name->empty() ? models_text(registry()) : model_text(find_model(*name))).c_str(), stdout);
    return kDone;
  };
  return command;
}

Command& add_template(Command& program) {
  const auto model = std::make_shared<std::string>();
  const auto kind = std::make_shared<std::string>(study_kinds().all.front()->name);
  const auto reference = std::make_shared<bool>(false);
  Command& command = program.add_command("template", "print a complete, commented study file");
  CLI::Option* named = command.add_value("model", *model, "MODEL", "mechanism");
  command.add_value("kind", *kind, "KIND", "kind of study: " + either(names(study_kinds())));
  command.add_flag("--reference", *reference, "print the reference of all keys of study files, as Markdown")
      ->excludes(named);
  command.examples = {{"a sensitivity study", "poesy template 2upr-rpu > study.toml"},
                      {"all errors at once", "poesy template 3-prs monte-carlo > study.toml"},
                      {"every key of a study file, as text", "poesy template --reference"}};
  command.callback([=] {
    if (!*reference && named->count() == 0) throw CLI::RequiredError(named->get_type_name());
  });
  command.action = [=] { return *reference ? print_reference() : print_template(*model, *kind); };
  return command;
}

}  // namespace poesy::app
