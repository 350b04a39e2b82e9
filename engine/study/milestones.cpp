#include "engine/study/milestones.h"

#include "engine/study/plan.h"

namespace poesy {

std::vector<std::size_t> milestones(std::size_t min, std::size_t max) {
  std::vector<std::size_t> list;
  std::size_t units = Plan::units_for(min);
  while (units * Plan::kUnitSamples < max) {
    list.push_back(units * Plan::kUnitSamples);
    units += (units + 1) / 2;
  }
  return list;
}

}  // namespace poesy
