#include "engine/app/message.h"

#include <unistd.h>

#include <cstdio>

#include "engine/app/terminal.h"

namespace poesy::app {
namespace {

constexpr const char* kRed = "\033[1;31m";
constexpr const char* kYellow = "\033[1;33m";
constexpr const char* kPlain = "\033[0m";

std::string beginning(Message kind) {
  const std::string words = kind == Message::warning ? "poesy: warning:" : "poesy:";
  if (kind == Message::note || !shows_colour(STDERR_FILENO)) return words;
  return (kind == Message::warning ? kYellow : kRed) + words + kPlain;
}

}  // namespace

void say(Message kind, const std::string& text) { std::fputs((beginning(kind) + " " + text + "\n").c_str(), stderr); }

}  // namespace poesy::app
