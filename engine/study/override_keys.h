#pragma once

#include <optional>
#include <string>

#include "engine/schema/keys_section.h"

/// Which key of [errors.override] counts for an error. A key is the name of an error, or a pattern that matches names.
namespace poesy {

/// Returns true if a key of [errors.override] is for this error: its name, or a pattern that matches its name.
bool is_key_of(const std::string& key, const std::string& factor);

/// The key in [errors.override] that counts for an error, the last one that is for it; none if no key is. Keys that
/// were given on the command line or in Python are later than those of the file.
std::optional<std::string> override_key(const StudySection& overrides, const std::string& factor);

/// The value of the key that counts for an error; none if no key is for it.
std::optional<StudyValue> override_of(const StudySection& overrides, const std::string& factor);

}  // namespace poesy
