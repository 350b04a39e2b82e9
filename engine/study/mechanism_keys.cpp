#include "engine/base/text.h"
#include "engine/study/study.h"
#include "engine/study/study_kind.h"
#include "engine/study/text_file.h"

namespace poesy {
namespace {

constexpr std::size_t kMostBytes = 1 << 20;

void take_entry(const CatalogEntry* entry, MechanismChoice& choice) {
  choice.entry = entry;
  for (const GeometryParameter& parameter : entry->description.geometry) {
    choice.geometry.push_back(parameter.published);
  }
}

void read_model(const StudyValue& value, Study& study, const Reading& reading) {
  const std::string written = value.text();
  std::vector<std::string_view> known;
  for (const CatalogEntry& entry : reading.catalog) known.push_back(entry.description.name);
  const CatalogEntry* const entry = find(reading.catalog, written);
  if (entry == nullptr && written.ends_with(".toml")) {
    value.fail("is '" + printable(written) + "', which is unknown", "write file = \"" + printable(written) + "\"");
  }
  if (entry == nullptr) {
    value.fail("is '" + printable(written) + "', which is unknown", suggestion(lower_case(written), known));
  }
  take_entry(entry, study.mechanism);
}

void read_file(const StudyValue& value, Study& study, const Reading& reading) {
  reading.root.section("mechanism").refuse("model", "a mechanism from a file");
  if (reading.catalog.from_text == nullptr) value.fail("cannot be read here", "name a model");
  MechanismText file{.name = value.text(), .text = {}, .entry = {}};
  const bool kept = reading.mechanism_text != nullptr;
  const std::string path = kept ? file.name : named_file(value);
  file.text = kept ? *reading.mechanism_text : read_text(path, "mechanism", kMostBytes);
  file.entry = std::make_shared<const CatalogEntry>(reading.catalog.from_text(file.text, path));
  take_entry(file.entry.get(), study.mechanism);
  study.mechanism.file = std::move(file);
}

std::string model_line(const Study& study) {
  return study.mechanism.file ? "" : "model = " + in_quotes(study.model().name) + "\n";
}

std::string file_line(const Study& study) {
  return study.mechanism.file ? "file = " + in_quotes(study.mechanism.file->name) + "\n" : "";
}

void read_geometry(const StudyValue& value, Study& study, const Reading&) {
  const std::vector<GeometryParameter>& parameters = study.model().geometry;
  study.mechanism.place = value.place();
  read_named(value.section(), parameters, "parameter", [&](std::size_t g, const StudyValue& own) {
    study.mechanism.geometry[g] = own.quantity(parameters[g].dimension);
  });
}

/// Reads loads that replace the loads of the mechanism file, and makes the catalog entry with these loads the study's
/// entry.
void read_load(const StudyValue& value, Study& study, const Reading&) {
  MechanismChoice& choice = study.mechanism;
  if (!choice.entry->with_load) {
    value.fail("is for mechanisms of files", "remove it, or describe the mechanism in a file");
  }
  choice.file->entry = std::make_shared<const CatalogEntry>(choice.entry->with_load(value));
  choice.entry = choice.file->entry.get();
}

std::string load_lines(const Study& study) {
  const std::string& load = study.mechanism.entry->load;
  return load.empty() ? "" : "\n[mechanism.load]\n" + load;
}

/// Reads the key `fidelity`. The word "both" sets MechanismChoice::compared. Only models with two fidelities accept it.
void read_fidelity(const StudyValue& value, Study& study, const Reading& reading) {
  const ModelDescription& model = study.model();
  if (model.fidelities.empty()) {
    reading.root.section("mechanism").refuse("fidelity", "model \"" + model.name + "\", which offers no choice of it");
  }
  std::vector<std::string_view> words(model.fidelities.begin(), model.fidelities.end());
  if (words.size() == 2) words.push_back(kBothFidelities);
  const std::size_t word = value.word(words);
  if (word < model.fidelities.size()) {
    study.mechanism.fidelity = word;
  } else {
    study.mechanism.compared = 1;
  }
}

std::string geometry_lines(const Study& study) {
  const std::vector<GeometryParameter>& parameters = study.model().geometry;
  std::string text = parameters.empty() ? "" : "\n[mechanism.geometry]\n";
  for (std::size_t g = 0; g < parameters.size(); ++g) {
    text += parameters[g].name + " = " + exact_value(study.mechanism.geometry[g], parameters[g].dimension) + "\n";
  }
  return text;
}

std::string fidelity_line(const Study& study) {
  const std::vector<std::string>& fidelities = study.model().fidelities;
  if (fidelities.empty()) return {};
  const MechanismChoice& choice = study.mechanism;
  return "fidelity = " + in_quotes(choice.compared ? kBothFidelities : std::string_view(fidelities[choice.fidelity])) +
         "\n";
}

}  // namespace

const StudyRows& mechanism_keys() {
  static const StudyRows keys{
      .paths = {"mechanism"},
      .meaning = "The mechanism and its geometry.",
      .rows = {
          StudyRow{.name = "model",
                   .value = {.type = "text"},
                   .missing = "write model = \"NAME\"; 'poesy models' lists the names",
                   .besides = " without `file`",
                   .meaning = "Name of the mechanism; 'poesy models' lists them.",
                   .reader = read_model,
                   .lines = model_line},
          StudyRow{.name = "file",
                   .value = {.type = "text"},
                   .usual = "",
                   .meaning = "Instead of model: a mechanism's file, relative to the study's folder.",
                   .reader = read_file,
                   .lines = file_line},
          StudyRow{.name = "geometry",
                   .value = {.type = "table"},
                   .usual = "as published, or as in the file",
                   .meaning = "Parameters of the geometry that differ from the published ones; where they do, look at "
                              "the workspace too.",
                   .reader = read_geometry,
                   .lines = geometry_lines,
                   .late = 1},
          StudyRow{.name = "load",
                   .value = {.type = "table"},
                   .usual = "as in the file",
                   .meaning = "Loads that replace those of the mechanism's file.",
                   .reader = read_load,
                   .lines = load_lines,
                   .late = 1},
          StudyRow{.name = "fidelity",
                   .value = {.type = "text"},
                   .usual = "the first of them",
                   .meaning =
                       "One of the model's ways to solve a sample, for models that offer a choice; of two, "
                       "\"both\" solves each on the same draws in a sensitivity study and tells which errors are "
                       "linear.",
                   .reader = read_fidelity,
                   .lines = fidelity_line}}};
  return keys;
}

StudyTables mechanism_tables() {
  return {described(mechanism_keys()),
          {.paths = {"mechanism.geometry"},
           .meaning = "'poesy models MODEL' lists the parameters.",
           .keys = {{.name = "PARAMETER",
                     .type = "quantity",
                     .usual = "its published value",
                     .meaning = "A parameter of the geometry."}}},
          {.paths = {"mechanism.load"},
           .meaning = "The keys of [load] of a mechanism file. Only mechanisms with stiffness are loaded.",
           .keys = {{.name = "gravity", .type = "vector", .usual = "none", .meaning = "Acceleration on every mass."},
                    {.name = "body", .type = "text", .usual = "`\"platform\"`", .meaning = "The body that is loaded."},
                    {.name = "at", .type = "point", .usual = "the tool, or its origin", .meaning = "Where."},
                    {.name = "force", .type = "vector", .usual = "none", .meaning = "In the base's axes."},
                    {.name = "moment", .type = "vector", .usual = "none", .meaning = "In the base's axes."}}}};
}

void read_mechanism(Study& study, const Reading& reading) {
  const StudySection section = reading.root.require("mechanism").section();
  study.mechanism.place = section.place();
  section.allow();
  if (!section.find("file")) static_cast<void>(section.require("model"));
  read_keys(mechanism_keys(), section, study, reading, Extent::partial);
}

}  // namespace poesy
