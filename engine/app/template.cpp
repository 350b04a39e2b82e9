#include <cstdio>

#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/exit_code.h"
#include "engine/app/find_model.h"
#include "engine/base/error.h"
#include "engine/io/study_file.h"
#include "engine/io/wording.h"

namespace poesy::app {
namespace {

Analysis::Kind kind_named(const std::string& word) {
  std::vector<std::string_view> known;
  for (const Analysis::Kind kind : kKinds) {
    if (name(kind) == word) return kind;
    known.push_back(name(kind));
  }
  throw InputError({}, "no template of kind '" + printable(word) + "'", suggestion(word, known));
}

int print_template(const std::string& model, const std::string& kind) {
  const CatalogEntry& entry = find_model(model);
  const Analysis::Kind wanted = kind_named(kind);
  if (wanted == Analysis::Kind::identification && !entry.description.deformation) {
    throw InputError({}, "nothing deforms in model '" + model + "', so it has no identification",
                     "choose another kind");
  }
  if (wanted == Analysis::Kind::coupling && entry.description.sources.empty()) {
    throw InputError({}, "model '" + model + "' suggests no sources of errors, so its coupling has no template",
                     "choose another kind, or write [[analysis.sources]] in a study of this kind");
  }
  std::fputs(template_text(entry, wanted).c_str(), stdout);
  return kDone;
}

int print_reference() {
  std::fputs(study_reference().c_str(), stdout);
  return kDone;
}

}  // namespace

void add_template(CLI::App& program, Action& action) {
  auto model = std::make_shared<std::string>();
  auto kind = std::make_shared<std::string>("sensitivity");
  auto reference = std::make_shared<bool>(false);
  CLI::App* command = program.add_subcommand("template", "print a complete, commented study file");
  CLI::Option* named = command->add_option("model", *model, "mechanism")->type_name("MODEL");
  command->add_option("kind", *kind, "kind of study: sensitivity, identification, evaluate, monte-carlo or coupling")
      ->type_name("KIND");
  command->add_flag("--reference", *reference, "print the reference of all keys of study files, as Markdown")
      ->excludes(named);
  command->footer(footer("", {{"a sensitivity study", "poesy template 2upr-rpu > study.toml"},
                              {"all errors at once", "poesy template 3-prs monte-carlo > study.toml"},
                              {"every key of a study file, as text", "poesy template --reference"}}));
  command->callback([=, &action] {
    if (*reference) {
      action = print_reference;
      return;
    }
    if (named->count() == 0) throw CLI::RequiredError(named->get_type_name());
    action = [model, kind] { return print_template(*model, *kind); };
  });
}

}  // namespace poesy::app
