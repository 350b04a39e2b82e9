#include "engine/report/signs.h"

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
  for (const ZoneTraits& zone : zone_traits()) replace(words, zone.sign, zone.key);
  return words;
}

void use_words(std::span<Table> tables) {
  for (Table& table : tables) {
    for (auto& row : table.rows) {
      for (Cell& cell : row) cell.text = with_words(cell.text);
    }
  }
}

}  // namespace poesy
