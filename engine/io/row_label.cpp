#include "engine/io/row_label.h"

#include "engine/base/text.h"

namespace poesy {
namespace {

constexpr std::size_t kMostBytes = 60;

}  // namespace

std::optional<std::string> label_problem(std::string_view label) {
  if (label.empty()) return "is empty";
  if (label.size() > kMostBytes) return "is longer than " + std::to_string(kMostBytes) + " bytes";
  if (printable(label, kMostBytes) != label) return "has characters that cannot be printed";
  if (const std::size_t at = label.find_first_of(",;\"'`"); at != std::string_view::npos) {
    return "has a " + std::string(label[at] == ',' ? "comma" : label[at] == ';' ? "semicolon" : "quote");
  }
  if (std::string_view("=+-@").find(label.front()) != std::string_view::npos) {
    return "begins with '" + std::string(1, label.front()) + "'";
  }
  return std::nullopt;
}

}  // namespace poesy
