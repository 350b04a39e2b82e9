#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace poesy::app {

/// What the program does once its command line is understood. Returns the exit code.
using Action = std::function<int()>;

// Each adds one subcommand, with its options, to the program and sets the action when it is called.
void add_run(CLI::App& program, Action& action);
void add_check(CLI::App& program, Action& action);
void add_evaluate(CLI::App& program, Action& action);
void add_show(CLI::App& program, Action& action);
void add_report(CLI::App& program, Action& action);
void add_replay(CLI::App& program, Action& action);
void add_export(CLI::App& program, Action& action);
void add_merge(CLI::App& program, Action& action);
void add_verify(CLI::App& program, Action& action);
void add_models(CLI::App& program, Action& action);
void add_template(CLI::App& program, Action& action);
void add_tolerances(CLI::App& program, Action& action);
void add_completion(CLI::App& program, Action& action);
void add_man(CLI::App& program, Action& action);
void add_help(CLI::App& program, Action& action);
void add_version(CLI::App& program, Action& action);

}  // namespace poesy::app
