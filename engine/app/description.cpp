#include "engine/app/description.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "engine/app/shells.h"
#include "engine/report/ranking.h"
#include "engine/study/study.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

constexpr const char* kExamples = "Examples:";
constexpr const char* kIndent = "  ";
constexpr const char* kDeeper = "      ";

/// Names of the responses of all mechanisms by all metrics, each once.
std::vector<std::string> known_responses() {
  std::vector<std::string> names;
  const auto add = [&](const CatalogEntry& entry) {
    for (const Response& response : entry.description.responses) {
      if (std::ranges::find(names, response.name) == names.end()) names.push_back(response.name);
    }
  };
  for (const CatalogEntry& entry : registry()) {
    add(entry);
    if (entry.by_platform) add(*entry.by_platform);
  }
  return names;
}

std::vector<std::string> words_for(const std::string& value) {
  std::vector<std::string> words;
  if (value == "MODEL") {
    for (const CatalogEntry& entry : registry()) words.push_back(entry.description.name);
  } else if (value == "RESPONSE") {
    words = known_responses();
  } else if (value == "KIND") {
    for (const Analysis::Kind kind : kKinds) words.emplace_back(name(kind));
  } else if (value == "SHELL") {
    words.assign(kShells.begin(), kShells.end());
  } else if (value == "KEY") {
    words.assign(kRowOrders.begin(), kRowOrders.end());
  }
  return words;
}

/// What a value is called says what it is.
Offer offer_for(const std::string& value) {
  if (value == "DIR") return {Offer::Kind::folders, {}, {}};
  for (const char* extension : {"toml", "h5", "csv", "html"}) {
    if (value.ends_with(std::string(".") + extension)) return {Offer::Kind::files, {}, extension};
  }
  auto words = words_for(value);
  return {words.empty() ? Offer::Kind::nothing : Offer::Kind::words, std::move(words), {}};
}

DescribedOption describe_option(const CLI::Option& option) {
  DescribedOption described;
  for (const std::string& name : option.get_snames()) described.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) described.names.push_back("--" + name);
  if (option.get_items_expected_max() != 0) {
    const std::string type = option.get_type_name();
    described.value = type.substr(0, type.find(':'));  // CLI11 adds what it checks
  }
  described.about = option.get_description();
  described.group = option.get_group();
  described.required = option.get_required();
  described.repeated = option.get_expected_max() > 1;
  described.offer = offer_for(described.value);
  return described;
}

/// A footer's lines, where they belong.
void take_apart(const std::string& footer, DescribedCommand& command) {
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line == kExamples) continue;
    if (line.starts_with(kDeeper)) {
      command.examples.back().about = line.substr(std::string(kDeeper).size());
    } else if (line.starts_with(kIndent)) {
      command.examples.push_back({{}, line.substr(std::string(kIndent).size())});
    } else {
      command.notes.push_back(line);
    }
  }
}

/// The commands' names, wherever a command is asked for.
void offer_commands(DescribedProgram& described) {
  std::vector<std::string> names;
  for (const DescribedCommand& command : described.commands) names.push_back(command.name);
  for (DescribedCommand& command : described.commands) {
    for (DescribedOption& option : command.options) {
      if (option.value == "COMMAND") option.offer = {Offer::Kind::words, names, {}};
    }
  }
}

}  // namespace

DescribedCommand describe_command(const CLI::App& command) {
  DescribedCommand described;
  if (command.get_parent() != nullptr) described.name = command.get_name();
  described.about = command.get_description();
  described.group = command.get_group();
  for (const CLI::Option* option : command.get_options()) described.options.push_back(describe_option(*option));
  take_apart(command.get_footer(), described);
  return described;
}

DescribedProgram describe(const CLI::App& program) {
  DescribedProgram described{describe_command(program), {}};
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    described.commands.push_back(describe_command(*command));
  }
  offer_commands(described);
  return described;
}

std::string footer(const std::string& notes, const std::vector<Example>& examples) {
  std::string text = notes + kExamples + "\n";
  for (const auto& [about, command] : examples) text += kIndent + command + "\n" + kDeeper + about + "\n";
  return text;
}

std::string heading(const DescribedOption& option) {
  std::string text;
  for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + name;
  if (!option.value.empty()) text += (text.empty() ? "" : " ") + option.value;
  return option.repeated ? text + " ..." : text;
}

std::string synopsis(const DescribedCommand& command) {
  std::string text = "poesy " + command.name;
  for (const DescribedOption& option : command.options) {
    if (!option.by_place()) continue;
    text += option.required ? " " + heading(option) : " [" + heading(option) + "]";
  }
  for (const DescribedOption& option : command.options) {
    if (option.by_place() || !option.required) continue;
    text += " " + option.names.front() + " " + option.value;
  }
  return text + " [options]";
}

}  // namespace poesy::app
