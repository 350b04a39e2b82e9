#include "engine/study/mechanism_doubts.h"

#include <fmt/format.h>

namespace poesy {

std::string asked_back(std::string_view clause) { return fmt::format("{}; is that meant?", clause); }

std::vector<std::string> mechanism_doubts(const Model& model) {
  std::vector<std::string> list;
  for (const std::string& unusual : model.unusual_geometry()) list.push_back(asked_back(unusual));
  return list;
}

}  // namespace poesy
