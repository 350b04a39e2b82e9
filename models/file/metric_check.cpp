#include "models/file/metric_check.h"

#include <cmath>
#include <string>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "models/chain/metric.h"

namespace poesy::file {

void check_metric(const MechanismFile& file, const Mechanism& made) {
  const std::string why = chain::why_no_metric(made.points, made.reach);
  if (why.empty()) return;
  // A power of ten (m) of the order of magnitude of the mechanism's reach.
  const double size = std::pow(10.0, std::floor(std::log10(0.5 * made.reach)));
  const std::string length = "\"" + readable_text({size, Dimension::length}) + "\"";
  throw InputError(file.platform.place, "the metric has no meaning: " + why,
                   "write in [platform] three or more of its points that are not on one line, e.g. "
                   "metric_points = [[" +
                       length + ", 0, 0], [0, " + length + ", 0], [0, 0, " + length + "]]");
}

}  // namespace poesy::file
