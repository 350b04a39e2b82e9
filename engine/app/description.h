#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace poesy::app {

/// What a shell may offer where a value stands.
struct Offer {
  enum class Kind { nothing, words, files, folders };
  Kind kind = Kind::nothing;
  std::vector<std::string> words;
  std::string extension;  ///< of files, without the dot
};

struct DescribedOption {
  std::vector<std::string> names;  ///< "-o", "--output"; empty: an argument that its place tells
  std::string value;               ///< "RESULT.h5"; empty: a flag
  std::string about;
  std::string group;
  bool required = false;
  bool repeated = false;  ///< takes several values
  Offer offer;

  bool by_place() const { return names.empty(); }
};

struct Example {
  std::string about;
  std::string command;
};

struct DescribedCommand {
  std::string name;  ///< empty: the program itself
  std::string about;
  std::string group;
  std::vector<DescribedOption> options;  ///< as they were added
  std::vector<std::string> notes;        ///< paragraphs
  std::vector<Example> examples;
};

struct DescribedProgram {
  DescribedCommand program;
  std::vector<DescribedCommand> commands;
};

/// The command line as CLI11 knows it, in plain values, for all who write about it: help, completion, manual.
DescribedProgram describe(const CLI::App& program);
DescribedCommand describe_command(const CLI::App& command);

/// A footer that describe() takes apart again. Notes: paragraphs, each on a line of its own.
std::string footer(const std::string& notes, const std::vector<Example>& examples);

/// "poesy evaluate STUDY.toml --poses P.csv --errors E.csv [options]"
std::string synopsis(const DescribedCommand& command);

/// "-o, --output RESULT.h5", "SHARD.h5 ..."
std::string heading(const DescribedOption& option);

}  // namespace poesy::app
