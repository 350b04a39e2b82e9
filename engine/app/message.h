#pragma once

#include <string>

namespace poesy::app {

enum class Message { note, warning, error };

/// One line on stderr: "poesy: TEXT", "poesy: warning: TEXT". What stands before the text of a warning or an error is
/// coloured where stderr shows colour.
void say(Message kind, const std::string& text);

}  // namespace poesy::app
