#include "engine/kinds/sensitivity/cell_stats.h"

#include <utility>

#include "engine/base/contract.h"

namespace poesy::sensitivity {
namespace {

template <class T>
std::vector<T> part_of(const std::vector<T>& list, const NumberRange& range) {
  const auto begin = list.begin();
  return {begin + static_cast<std::ptrdiff_t>(range.first), begin + static_cast<std::ptrdiff_t>(range.end)};
}

}  // namespace

UnitStats CellStats::at(std::size_t cell) const {
  UnitStats stats{{}, solves[cell], failed[cell]};
  stats.responses.reserve(responses.size());
  for (const std::vector<Moments>& response : responses) stats.responses.push_back(response[cell]);
  return stats;
}

void CellStats::state(Archive& archive, std::size_t cell, std::uint64_t first) {
  for (std::vector<Moments>& response : responses) archive.object(response[cell]);
  ends_state(archive, solves[cell], failed[cell], first);
}

CellStats CellStats::part(const NumberRange& cells) const {
  CellStats some;
  for (const std::vector<Moments>& response : responses) some.responses.push_back(part_of(response, cells));
  some.solves = part_of(solves, cells);
  some.failed = part_of(failed, cells);
  return some;
}

void CellStats::merge(std::size_t cell, const UnitStats& unit) {
  POESY_EXPECTS(unit.responses.size() == responses.size());
  for (std::size_t r = 0; r < responses.size(); ++r) responses[r][cell].merge(unit.responses[r]);
  solves[cell].merge(unit.solves);
  failed[cell].merge(unit.failed);
}

void CellStats::merge(CellStats later) {
  POESY_EXPECTS(later.size() == size() && later.responses.size() == responses.size());
  for (std::size_t r = 0; r < responses.size(); ++r) {
    const std::vector<Moments> added = std::exchange(later.responses[r], {});
    for (std::size_t cell = 0; cell < size(); ++cell) responses[r][cell].merge(added[cell]);
  }
  for (std::size_t cell = 0; cell < size(); ++cell) {
    solves[cell].merge(later.solves[cell]);
    failed[cell].merge(later.failed[cell]);
  }
}

}  // namespace poesy::sensitivity
