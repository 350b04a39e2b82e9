#pragma once

#include <toml++/toml.h>

#include "engine/schema/given_key.h"

namespace poesy {

/// Sets a key of a parsed file, and adds the tables that its full name needs and the file lacks. Throws InputError if
/// the full name is malformed, or if it leads through something other than a table.
void set_key(toml::table& file, const GivenKey& given);

}  // namespace poesy
