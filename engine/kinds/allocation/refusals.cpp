/// What a search says where no tolerances keep the limits.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/kinds/allocation/search.h"

namespace poesy {

/// "gap at pose 12".
std::string ToleranceSearch::row_text(std::size_t row) const {
  const std::size_t poses = run_.poses.size();
  const ResponseLimit& limit = run_.study.analysis.limits[row / poses];
  return fmt::format("{} at pose {}", run_.study.model().responses[limit.response].name, row % poses);
}

void ToleranceSearch::refuse(const Infeasible& broken) const {
  const std::size_t poses = run_.poses.size();
  const ResponseLimit& limit = run_.study.analysis.limits[broken.limit / poses];
  const Response& response = run_.study.model().responses[limit.response];
  const double fixed = limit.most * limit.most - broken.room;  // what belongs to no part
  const auto text = [&](double square) {
    return readable_text({std::sqrt(std::max(0.0, square)), response.dimension}, 4);
  };
  const std::string limit_text = readable_text({limit.most, response.dimension}, 6);
  if (broken.room <= 0.0) {
    throw InputError({},
                     fmt::format("the limit of {} on {} cannot be kept: the background and the errors of no part alone "
                                 "give a root mean square of {}",
                                 limit_text, row_text(broken.limit), text(fixed)),
                     "widen the limit, make these errors smaller, or list them as parts");
  }
  throw InputError({},
                   fmt::format("the limit of {} on {} cannot be kept: with every tolerance at its lowest the root mean "
                               "square is {}",
                               limit_text, row_text(broken.limit), text(fixed + broken.need)),
                   "widen the limit, or lower the bounds of parts");
}

void ToleranceSearch::refuse_lowest() const {
  throw InputError(
      {},
      fmt::format("{} % of the machines within the limits cannot be had: with every tolerance at its lowest, {} of {} "
                  "machines are not within them, and {} may be",
                  100.0 * asked_.yield, trial_.rejects(), trial_.load.size(), allowed_.design),
      "widen a limit, ask for a smaller yield, or lower the bounds of parts");
}

void ToleranceSearch::refuse_unbounded(std::uint64_t rejects) const {
  throw InputError({},
                   fmt::format("no tolerances were found with which {} % of the machines are within the limits: of the "
                               "finest that were tried, {} of {} machines are not within them, and {} may be",
                               100.0 * asked_.yield, rejects, trial_.load.size(), allowed_.design),
                   "widen a limit, give the parts bounds, or leave out poses where machines cannot be solved");
}

void ToleranceSearch::refuse_endless(const Unbounded& endless) const {
  throw InputError({},
                   fmt::format("part '{}' has no effect on any limit, and no upper bound",
                               programme_.parts()[endless.parts.front()].name),
                   "give it bounds, or leave it out of the parts");
}

}  // namespace poesy
