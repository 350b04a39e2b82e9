#include "engine/base/error.h"

#include "engine/base/text.h"

namespace poesy {
namespace {

std::string sentence(const std::string& place, std::string_view problem, std::string_view remedy) {
  std::string text = place;
  if (!text.empty()) text += ": ";
  text += problem;
  if (!remedy.empty()) {
    text += "; ";
    text += remedy;
  }
  return printable_line(text);  // the text may quote file names and user input with control characters or line ends
}

}  // namespace

std::string to_string(const Place& place) {
  std::string text = place.file;
  if (text.empty() || place.line == 0) return text;
  text += ":" + std::to_string(place.line);
  if (place.column != 0) text += ":" + std::to_string(place.column);
  return text;
}

InputError::InputError(const Place& place, std::string_view problem, std::string_view remedy)
    : std::runtime_error(sentence(to_string(place), problem, remedy)) {}

FileError::FileError(std::string_view path, std::string_view problem, std::string_view remedy)
    : std::runtime_error(sentence(std::string(path), problem, remedy)) {}

}  // namespace poesy
