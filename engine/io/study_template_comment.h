#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace poesy {

/// What a template says about keys, from their descriptions (engine/io/study_keys.h). All are whole lines of TOML.

/// Text of any number of lines as comment lines.
std::string comment(std::string_view text);

/// A line that shows this key, with its explanation: behind it where that fits, else in comment lines before it, with
/// the words that it takes.
std::string explained(std::string_view table, std::string_view key, std::string_view line);

/// "KEY: explanation" in comment lines, and below it the words that the key takes.
std::string explanation_lines(std::string_view table, std::string_view key);

/// The same for every key of a table, `depth` steps further in: what may stand in an inline table.
std::string keys_lines(std::string_view table, std::size_t depth = 1);

/// What is said of a table as a whole.
std::string_view table_meaning(std::string_view table);

}  // namespace poesy
