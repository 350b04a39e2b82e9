#include "engine/report/signs.h"

#include <algorithm>
#include <utility>

#include "engine/model/feature.h"

namespace poesy {
namespace {

void replace(std::string& text, std::string_view sign, std::string_view word) {
  for (std::size_t at = text.find(sign); at != std::string::npos; at = text.find(sign, at + word.size())) {
    text.replace(at, sign.size(), word);
  }
}

}  // namespace

std::string with_words(std::string_view text) {
  std::string words(text);
  replace(words, kSphereDiameter, "sphere dia ");
  replace(words, kDiameter, "dia ");
  replace(words, kPlusMinus, "+-");
  replace(words, kTimes, "x");
  for (const ZoneTraits& zone : zone_traits()) replace(words, zone.sign, zone.key);
  return words;
}

std::string typographic(std::string_view text) {
  constexpr std::string_view kMinus = "\u2212";
  std::string printed(text);
  replace(printed, "->", "\u2192");
  replace(printed, "+-", kPlusMinus);
  const auto is_digit = [&](std::size_t at) { return at < printed.size() && printed[at] >= '0' && printed[at] <= '9'; };
  for (std::size_t at = printed.find('-'); at != std::string::npos; at = printed.find('-', at + 1)) {
    const bool begins = at == 0 || printed[at - 1] == ' ' || printed[at - 1] == '(';
    const bool is_of_power = at > 1 && printed[at - 1] == 'e' && is_digit(at - 2);
    if ((begins || is_of_power) && is_digit(at + 1)) printed.replace(at, 1, kMinus);
  }
  return printed;
}

std::vector<std::string> frame_boxes(std::string_view sign, std::string zone, std::string_view datums) {
  std::vector<std::string> boxes{std::string(sign), std::move(zone)};
  while (!datums.empty()) {
    const std::size_t end = std::min(datums.find('|'), datums.size());
    boxes.emplace_back(datums.substr(0, end));
    datums.remove_prefix(std::min(end + 1, datums.size()));
  }
  return boxes;
}

void use_words(std::span<Table> tables) {
  for (Table& table : tables) {
    for (std::string& note : table.notes) note = with_words(note);
    for (auto& row : table.rows) {
      for (Cell& cell : row) cell.text = with_words(cell.text);
    }
  }
}

}  // namespace poesy
