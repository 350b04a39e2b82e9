#pragma once

#include <optional>
#include <string>

#include "engine/schema/keys_section.h"

/// The keys of [errors.override]. A key is the name of an error, or a pattern that matches names of errors. If several
/// keys fit an error, the last one counts.
namespace poesy {

/// Returns true if a key of [errors.override] fits this error: it is the error's name, or a pattern that matches it.
bool is_key_of(const std::string& key, const std::string& factor);

/// The last key in [errors.override] that fits an error; none if no key fits. Keys that were given on the command line
/// or in Python are later than those of the file.
std::optional<std::string> override_key(const StudySection& overrides, const std::string& factor);

/// The value of the override_key() of an error; none if no key fits.
std::optional<StudyValue> override_of(const StudySection& overrides, const std::string& factor);

}  // namespace poesy
