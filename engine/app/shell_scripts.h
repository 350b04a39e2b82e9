#pragma once

#include <string>

#include "engine/app/description.h"

namespace poesy::app {

/// Completion of the program's command line, as a script to be sourced by bash 4 or newer. It needs nothing else.
std::string bash_completion(const DescribedProgram& described);

/// The same for zsh: a function for $fpath, or to be sourced after compinit.
std::string zsh_completion(const DescribedProgram& described);

}  // namespace poesy::app
