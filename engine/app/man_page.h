#pragma once

#include <string>

#include "engine/app/description.h"

namespace poesy::app {

/// The manual page poesy(1), with the macros of man(7).
std::string man_page(const DescribedProgram& described);

}  // namespace poesy::app
