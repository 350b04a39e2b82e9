#include "engine/model/feature.h"

#include <algorithm>

#include "engine/base/contract.h"

namespace poesy {

std::vector<FactorIndex> Feature::errors() const {
  std::vector<FactorIndex> all = middle;
  all.insert(all.end(), tilt.begin(), tilt.end());
  return all;
}

const std::vector<ZoneTraits>& zone_traits() {
  using enum ZoneClass;
  static const std::vector<ZoneTraits> kAll{
      {"position", location, "\u2316"},       {"coaxiality", location, "\u25ce"},
      {"symmetry", location, "\u232f"},       {"profile", location, "\u2313"},
      {"flatness", location, "\u23e5"},       {"perpendicularity", orientation, "\u27c2"},
      {"parallelism", orientation, "\u2225"}, {"angularity", orientation, "\u2220"},
      {"runout", orientation, "\u2197"},      {"total_runout", orientation, "\u2330"},
      {"tolerance", size, "\u00b1"}};
  return kAll;
}

const ZoneTraits& zone_traits(std::string_view key) {
  const auto found = std::ranges::find(zone_traits(), key, &ZoneTraits::key);
  POESY_EXPECTS(found != zone_traits().end());
  return *found;
}

ZoneClass zone_class(std::string_view key, FeatureKind kind) {
  const bool is_runout = key == "runout" || key == "total_runout";
  return is_runout && kind == FeatureKind::axis ? ZoneClass::location : zone_traits(key).of;
}

}  // namespace poesy
