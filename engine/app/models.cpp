#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/study_file.h"
#include "engine/report/mechanism_picture.h"
#include "engine/report/tables.h"
#include "engine/storage/file_writer.h"
#include "engine/study/brief_template.h"
#include "engine/study/text_file.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

/// The largest size of a mechanism file, bytes.
constexpr std::size_t kMostBytes = 1 << 20;

/// The built-in mechanism of this name (upper and lower case do not matter), or the mechanism of the file at this path.
/// Throws InputError with the known names if there is none.
CatalogEntry find_model(const std::string& name) {
  if (const CatalogEntry* entry = find(registry(), name)) return *entry;
  if (name.find_first_of("./") != std::string::npos) {
    return registry().from_text(read_text(name, "mechanism", kMostBytes), name);
  }
  std::vector<std::string_view> known;
  for (const CatalogEntry& entry : registry()) known.push_back(entry.description.name);
  throw InputError({}, "no model '" + printable(name) + "'",
                   std::filesystem::exists(name + ".toml") ? "for the file of that name write '" + name + ".toml'"
                                                           : suggestion(lower_case(name), known));
}

const StudyKind& kind_named(const std::string& word) {
  if (const StudyKind* kind = find(study_kinds(), word)) return *kind;
  throw InputError({}, "no template of kind '" + printable(word) + "'", suggestion(word, names(study_kinds())));
}

struct TemplateOptions {
  std::string model;
  std::string kind{study_kinds().all.front()->name};
  bool full = false;
  bool reference = false;
};

int print_template(const TemplateOptions& options) {
  if (options.reference) {
    print(study_reference() + registry().file_reference());
    return kDone;
  }
  const CatalogEntry entry = find_model(options.model);
  const StudyKind& wanted = kind_named(options.kind);
  ModelDescription as_named = entry.description;
  if (entry.file.empty()) as_named.name = options.model;
  if (const auto refusal = wanted.no_template != nullptr ? wanted.no_template(as_named) : std::nullopt) {
    throw InputError({}, refusal->problem, refusal->remedy);
  }
  const std::string text = template_text(entry, wanted);
  print(options.full ? text : brief_template(text, study_kinds().tables, wanted.name));
  return kDone;
}

void write_picture(const CatalogEntry& entry, const std::string& path) {
  if (!path.ends_with(".svg"))
    throw InputError({path}, "is not a name of a picture", "pictures are SVG: name it PICTURE.svg");
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  const std::optional<Sketch> sketch = entry.build(geometry, 0)->sketch({});
  if (!sketch) {
    throw InputError({}, "there is no picture of '" + entry.description.name + "'", "its model has no sketch");
  }
  const auto is_picture = [](const std::string& existing) { return is_marked(existing, kPictureMark); };
  const std::string output = check_output_path(path, {"picture", is_picture}, {{entry.file}});
  write_text(output, mechanism_picture(*sketch, entry.description.title));
}

/// The folder of the installed mechanism files. Empty if there is no such folder, as for a program in its build folder
/// or on a system without /proc.
std::filesystem::path installed_mechanisms() {
  std::error_code none;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", none);
  const auto folder = (program.parent_path() / POESY_MECHANISMS).lexically_normal();
  return std::filesystem::is_directory(folder, none) ? folder : std::filesystem::path();
}

/// The files FOLDER/NAME/NAME.toml of all folders NAME in a folder, each on a line. Empty for an empty path.
std::string files_text(const std::filesystem::path& folder) {
  if (folder.empty()) return "";
  std::vector<std::string> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const auto file = entry.path() / (entry.path().filename().string() + ".toml");
    if (std::filesystem::exists(file, none)) files.push_back(file.string());
  }
  std::sort(files.begin(), files.end());
  std::string text = files.empty() ? "" : "\nfiles of mechanisms, each with a study beside it\n";
  for (const std::string& file : files) text += "  " + file + "\n";
  return text;
}

struct ModelsOptions {
  std::string model;
  std::string picture;
};

int print_models(const ModelsOptions& options) {
  if (options.model.empty()) {
    print(models_text(registry()) + files_text(installed_mechanisms()));
    return kDone;
  }
  const CatalogEntry entry = find_model(options.model);
  if (!options.picture.empty()) write_picture(entry, options.picture);
  print(model_text(entry));
  return kDone;
}

}  // namespace

Command& add_models(Command& program) {
  const auto [command, options] = program.add_command("models", "list the mechanisms, or describe one", print_models);
  CLI::Option* named = command.add_value("model", options.model, "MODEL", "mechanism, or its file");
  command.add_value("-o,--output", options.picture, "PICTURE.svg", "picture of the mechanism")->needs(named);
  command.examples = {{"which mechanisms are there?", "poesy models"},
                      {"errors, poses and responses of one", "poesy models 2upr-rpu"},
                      {"what was understood of a mechanism's file", "poesy models rps3.toml -o rps3.svg"}};
  return command;
}

Command& add_template(Command& program) {
  const auto [command, options] = program.add_command("template", "print a study file to start from", print_template);
  CLI::Option* named = command.add_value("model", options.model, "MODEL", "mechanism, or its file");
  command.add_value("kind", options.kind, "KIND", "kind of study: " + either(names(study_kinds())));
  command.add_flag("--full", options.full, "every key, explained")->needs(named);
  command.add_flag("--reference", options.reference, "print the reference of all keys of study files, as Markdown")
      ->excludes(named);
  command.examples = {
      {"a sensitivity study", "poesy template 2upr-rpu > study.toml"},
      {"all errors at once, every key explained", "poesy template 3-prs monte-carlo --full > study.toml"},
      {"every key of a study file, as text", "poesy template --reference"}};
  command.callback([&reference = options.reference, named] {
    if (!reference && named->count() == 0) throw CLI::RequiredError(named->get_type_name());
  });
  return command;
}

}  // namespace poesy::app
