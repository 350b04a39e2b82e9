#pragma once

#include <cstddef>
#include <string>

namespace poesy::app {

/// Columns of a terminal that does not say, and of a page of help.
inline constexpr std::size_t kUsualWidth = 80;

/// Columns of the terminal behind a file descriptor, now; 0 when it is none, or does not say.
std::size_t terminal_width(int descriptor);

/// Whether a line there can be written over: a terminal, and not one that TERM calls "dumb" or says nothing of.
bool shows_live_lines(int descriptor);

/// Whether colour may be written there: as above, and NO_COLOR is unset or empty (https://no-color.org).
bool shows_colour(int descriptor);

/// Characters that a line of stdout has room for: of a terminal what it says, else what COLUMNS says, else 80. What is
/// no terminal has room for any line.
std::size_t output_width();

enum class Message { note, warning, error };

/// One line on stderr: "poesy: TEXT", "poesy: warning: TEXT". What stands before the text of a warning or an error is
/// coloured where stderr shows colour.
void say(Message kind, const std::string& text);

}  // namespace poesy::app
