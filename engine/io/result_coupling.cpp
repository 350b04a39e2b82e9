#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "engine/base/units.h"
#include "engine/io/result_parts.h"
#include "engine/run/coupling.h"

namespace poesy {
namespace {

const Axes kPoseAxes{"response", "size", "subset", "pose"};
const Axes kSummaryAxes{"response", "size", "subset"};
constexpr const char* kUnit = "SI: response unit, see /responses/unit";

/// A member of a result with the name and label of its dataset.
template <class Value>
struct Dataset {
  const char* name;
  std::vector<Value> CouplingResult::*member;
  const char* unit;
  const char* description;
};

const Dataset<double> kCurves[]{
    {"effect", &CouplingResult::effect, kUnit, "All errors of the subset's sources at once"},
    {"sum", &CouplingResult::sum, kUnit, "Sum over the sources of the effect of each alone"},
    {"interaction", &CouplingResult::interaction, kUnit, "effect - sum"},
    {"worst_case", &CouplingResult::worst_case, kUnit,
     "Sum over the sources' blocks of |effect of the block alone|; errors of a block move together"},
    {"root_sum_square", &CouplingResult::root_sum_square, kUnit, "Root of the sum of the squares of these"},
    {"cancellation", &CouplingResult::cancellation, "1",
     "1 - |sum| / sum of |effect of a source|: 0 no source opposes another, 1 they cancel"}};

const Dataset<double> kSummaries[]{
    {"effect_max", &CouplingResult::effect_max, kUnit, "Largest |effect| over the poses that count"},
    {"interaction_max", &CouplingResult::interaction_max, kUnit, "Largest |interaction| over the poses that count"},
    {"worst_case_max", &CouplingResult::worst_case_max, kUnit, "Largest worst case over the poses that count"},
    {"root_sum_square_max", &CouplingResult::root_sum_square_max, kUnit,
     "Largest root sum square over the poses that count"},
    {"opposed_share", &CouplingResult::opposed_share, "1",
     "Share of the poses that count where |sum| is below the largest |effect of a source|"},
    {"cancellation_max", &CouplingResult::cancellation_max, "1", "Largest cancellation over the poses that count"}};

const Dataset<std::int64_t> kPoses[]{
    {"effect_max_pose", &CouplingResult::effect_max_pose, "1", "First pose of the largest |effect|; -1: there is none"},
    {"cancellation_max_pose", &CouplingResult::cancellation_max_pose, "1",
     "First pose of the largest cancellation; -1: there is none"}};

const Dataset<std::uint64_t> kCounts[]{
    {"count", &CouplingResult::count, "1", "Poses that count: those where all that the subset rests on is solved"}};

template <class Datasets>
void add_all(ResultBuilder& result, const Axes& axes, const CouplingResult& found, const Datasets& datasets) {
  for (const auto& each : datasets) {
    result.add(std::string("/coupling/") + each.name, axes, found.*each.member, {each.unit, each.description});
  }
}

template <class Value, std::size_t Count>
void read_all(const h5::File& file, std::size_t cells, const Dataset<Value> (&datasets)[Count], CouplingResult& found) {
  for (const auto& each : datasets) {
    found.*each.member = read_exactly<Value>(file, std::string("/coupling/") + each.name, cells);
  }
}

/// "0.1 mm", or "0.1 mm, 0.1 deg".
std::vector<std::string> size_names(const CouplingStudy& study) {
  std::vector<std::string> names;
  for (std::size_t z = 0; z < study.sizes(); ++z) {
    std::string& name = names.emplace_back();
    if (!study.linear.empty()) name = readable_text({study.linear[z], Dimension::length});
    if (study.angular.empty()) continue;
    name += (name.empty() ? "" : ", ") + readable_text({study.angular[z], Dimension::angle});
  }
  return names;
}

std::vector<double> or_nan(std::vector<double> sizes, std::size_t count) {
  if (sizes.empty()) sizes.assign(count, std::numeric_limits<double>::quiet_NaN());
  return sizes;
}

/// 1 where a subset has a source, [K x sources].
std::vector<std::uint8_t> members(std::size_t sources) {
  std::vector<std::uint8_t> list;
  for (const std::vector<std::size_t>& subset : source_subsets(sources)) {
    for (std::size_t s = 0; s < sources; ++s) list.push_back(std::ranges::binary_search(subset, s) ? 1 : 0);
  }
  return list;
}

/// The source of each factor of the result, and the factor's block in it, by their positions.
struct Membership {
  std::vector<std::uint64_t> source, block;
};

Membership membership(const Study& study) {
  const CouplingStudy& coupling = study.analysis.coupling;
  std::map<FactorIndex, std::pair<std::size_t, std::size_t>> places;
  for (std::size_t s = 0; s < coupling.sources.size(); ++s) {
    const auto blocks = error_blocks(coupling.sources[s], coupling.pattern, study.model());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      for (const FactorIndex factor : blocks[b]) places[factor] = {s, b};
    }
  }
  Membership found;
  for (const FactorIndex factor : study.analysis.factors) {
    found.source.push_back(places.at(factor).first);
    found.block.push_back(places.at(factor).second);
  }
  return found;
}

void add_axes(ResultBuilder& result, const Study& study) {
  const CouplingStudy& coupling = study.analysis.coupling;
  result.add_axis("size", size_names(coupling), {"1", "Size of the errors"});
  result.add_axis("source", texts(coupling.sources, &ErrorSource::name), {"1", "Name of the source of errors"});
  result.add_axis("subset", subset_names(coupling.sources), {"1", "Sources that act at once, joined by +"});
  result.show_axes("/coupling", {"response", "size", "subset", "pose", "source", "factor"});
  result.add("/coupling/size_linear", {"size"}, or_nan(coupling.linear, coupling.sizes()),
             {"m", "Size of errors that are lengths; NaN where there is none"});
  result.add("/coupling/size_angular", {"size"}, or_nan(coupling.angular, coupling.sizes()),
             {"rad", "Size of errors that are angles; NaN where there is none"});
  result.add("/coupling/subset_sources", {"subset", "source"}, members(coupling.sources.size()),
             {"1", "1: the source is in the subset"});
  const Membership of_factors = membership(study);
  result.add("/coupling/factor_source", {"factor"}, of_factors.source,
             {"1", "Source of the error, by its position from 0"});
  result.add("/coupling/factor_block", {"factor"}, of_factors.block,
             {"1", "Block of its source that the error belongs to, from 0; errors of a block move together"});
}

}  // namespace

void add_coupling(ResultBuilder& result, const Study& study, const CouplingResult& found) {
  h5::File& file = result.file();
  file.make_group("/coupling");
  file.set_attribute("/coupling", "description",
                     std::string("Single and coupled error sources (San et al. 2023, Section 5.2)"));
  add_axes(result, study);
  add_all(result, kPoseAxes, found, kCurves);
  add_all(result, kSummaryAxes, found, kSummaries);
  add_all(result, kSummaryAxes, found, kPoses);
  add_all(result, kSummaryAxes, found, kCounts);
  add_solver(result, {"size", "pose"}, found.solves);
}

void read_coupling(const h5::File& file, StoredResult& result) {
  StoredCoupling& stored = result.coupling;
  stored.size_names = file.read<std::string>("/size");
  stored.sources = file.read<std::string>("/source");
  stored.subsets = file.read<std::string>("/subset");
  CouplingResult& found = stored.found;
  found.responses = result.responses.size();
  found.sizes = stored.size_names.size();
  found.subsets = stored.subsets.size();
  found.poses = result.poses.size();
  stored.linear = read_exactly<double>(file, "/coupling/size_linear", found.sizes);
  stored.angular = read_exactly<double>(file, "/coupling/size_angular", found.sizes);
  const std::size_t cells = found.responses * found.sizes * found.subsets;
  read_all(file, cells * found.poses, kCurves, found);
  read_all(file, cells, kSummaries, found);
  read_all(file, cells, kPoses, found);
  read_all(file, cells, kCounts, found);
  found.solves = read_solver(file, found.sizes * found.poses);
}

}  // namespace poesy
