#include <algorithm>

#include "engine/report/display.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/sections.h"

namespace poesy {
namespace {

bool described(const std::vector<NamedUnit>& things) {
  return std::ranges::any_of(things, [](const NamedUnit& thing) { return !thing.description.empty(); });
}

/// A description as a sentence of its own.
std::string sentence(const NamedUnit& thing) {
  std::string text = thing.description;
  if (text.empty()) return "-";
  if (text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text + (text.back() == '.' ? "" : ".");
}

std::vector<std::pair<std::string, std::string>> definitions(const StoredResult& result,
                                                             std::span<const std::size_t> responses) {
  std::vector<std::pair<std::string, std::string>> list;
  for (const std::size_t r : responses) list.emplace_back(result.responses[r].name, sentence(result.responses[r]));
  return list;
}

Table table_of(std::string name, std::string word, std::string caption, const std::vector<NamedUnit>& things) {
  Table table{.name = std::move(name),
              .caption = std::move(caption),
              .columns = {text_column("name", std::move(word)), text_column("unit", "unit"),
                          text_column("description", "what it is")}};
  for (const NamedUnit& thing : things) {
    table.rows.push_back({text_cell(thing.name), text_cell(unit_text(thing)), text_cell(thing.description)});
  }
  return table;
}

}  // namespace

void add_responses(const StoredResult& result, Page& page) {
  if (!described(result.responses)) return;
  for (const NamedUnit& response : result.responses) page.figures.about.emplace(response.name, response.description);
  std::vector<std::size_t> shown = headline_order(result);
  for (const std::size_t r : result.signed_headline) {
    if (std::ranges::find(shown, r) == shown.end()) shown.push_back(r);
  }
  page.add_section("what-is-measured", "What is measured").definitions(definitions(result, shown));
}

void add_glossary(const StoredResult& result, Page& page) {
  const std::vector<NamedUnit>& errors = result.factors;
  const std::vector<NamedUnit>& coordinates = result.pose_coordinates;
  if (!described(errors) && !described(coordinates)) return;
  for (const NamedUnit& error : errors) page.figures.about.emplace(error.name, error.description);
  Section& section = page.add_section("names", "What the names mean");
  if (described(coordinates))
    section.table(table_of("coordinates", "coordinate", "Coordinates of a pose", coordinates));
  if (described(errors)) section.table(table_of("errors", "error", "Errors", errors));
}

}  // namespace poesy
