#include "engine/io/result_parts.h"

namespace poesy {
namespace {

void add_groups(ResultBuilder& result, const std::vector<ErrorSize>& groups) {
  const Axes axes{"group"};
  result.add_axis("group", texts(groups, &ErrorSize::name), {"1", "Name of the group of sizes"});
  result.show_axes("/identification", {"group", "factor"});
  std::vector<double> linear;
  std::vector<double> angular;
  for (const ErrorSize& group : groups) {
    linear.push_back(group.linear);
    angular.push_back(group.angular);
  }
  result.add("/identification/group_linear", axes, linear, {"m", "Size of the group's linear errors"});
  result.add("/identification/group_angular", axes, angular, {"rad", "Size of the group's angular errors"});
}

void add_verdicts(ResultBuilder& result, const IdentificationResult& found) {
  const Axes all{"factor"};
  const Axes each{"group", "factor"};
  result.add("/identification/single", all, found.single, {"1", "1: deforms alone, in any group (Table 6)"});
  result.add("/identification/coupled", all, found.coupled,
             {"1", "1: deforms alone or as named member of a coupling, in any group (Table 7)"});
  result.add("/identification/single_by_group", each, found.single_by_group, {"1", "single, for each group"});
  result.add("/identification/coupled_by_group", each, found.coupled_by_group, {"1", "coupled, for each group"});
}

void add_counts(ResultBuilder& result, const IdentificationResult& found) {
  const Axes axes{"group", "factor"};
  result.add(
      "/identification/single_below", axes, found.single_below,
      {"1", "Poses where the error alone gives no more than rounding; with required_poses of them it is harmless"});
  result.add(
      "/identification/single_max", axes, found.single_max,
      {"SI: unit of the measure of deformation", "Largest deformation by the error alone; NaN where not solved"});
  result.add("/identification/not_solved", axes, found.not_solved,
             {"1", "Poses without a solution for the error alone; they count as deformed"});
  result.add("/identification/coupled_below", axes, found.coupled_below,
             {"1", "Poses where the errors tried together in its frame give no more than rounding; 0 if it was not"});
  result.add("/identification/coupled_reduced", axes, found.coupled_reduced,
             {"1", "Poses where setting it to zero takes nine tenths of its frame's deformation away"});
}

/// Columns of couplings, one row each.
struct CouplingColumns {
  std::vector<std::uint64_t> group, first, second, poses;
};

void add_couplings(ResultBuilder& result, const std::vector<Coupling>& couplings) {
  CouplingColumns columns;
  for (const Coupling& coupling : couplings) {
    columns.group.push_back(coupling.group);
    columns.first.push_back(coupling.first);
    columns.second.push_back(coupling.second);
    columns.poses.push_back(coupling.deforming_poses);
  }
  const Axes axes{"coupling"};
  result.add_axis("coupling", positions(couplings.size()), {"1", "Number of the coupling, from 0"});
  result.show_axes("/identification", {"coupling"});
  result.add("/identification/coupling_group", axes, columns.group, {"1", "Group, by its position from 0"});
  result.add("/identification/coupling_first", axes, columns.first, {"1", "One error, by its position from 0"});
  result.add("/identification/coupling_second", axes, columns.second, {"1", "The other, by its position from 0"});
  result.add("/identification/coupling_poses", axes, columns.poses, {"1", "Poses where the two deform together"});
}

std::vector<Coupling> read_couplings(const h5::File& file, const IdentificationResult& found) {
  const std::size_t count = axis_length(file, "coupling");
  const auto read = [&](const char* name) {
    return read_exactly<std::uint64_t>(file, std::string("/identification/coupling_") + name, count);
  };
  const CouplingColumns columns{read("group"), read("first"), read("second"), read("poses")};
  std::vector<Coupling> couplings;
  for (std::size_t k = 0; k < count; ++k) {
    if (columns.group[k] >= found.groups || columns.first[k] >= found.factors || columns.second[k] >= found.factors) {
      throw h5::Error("/identification/coupling_* name an unknown group or error");
    }
    couplings.push_back({columns.group[k], columns.first[k], columns.second[k], columns.poses[k]});
  }
  return couplings;
}

}  // namespace

void add_identification(ResultBuilder& result, const Study& study, const IdentificationResult& found) {
  h5::File& file = result.file();
  file.make_group("/identification");
  file.set_attribute("/identification", "description",
                     std::string("Which errors deform the mechanism (Du et al. 2022, Section 5.1)"));
  file.set_attribute("/identification", "rounding", found.rounding);
  file.set_attribute("/identification", "required_poses", static_cast<std::int64_t>(found.required_poses));
  const std::vector<std::uint64_t> by_status(found.solves.by_status.begin(), found.solves.by_status.end());
  result.add_axis("status", texts(kStatusNames, std::identity()), {"1", "How a solve ended"});
  add_groups(result, study.analysis.groups);
  add_verdicts(result, found);
  add_counts(result, found);
  add_couplings(result, found.couplings);
  result.show_axes("/identification", {"status"});
  result.add("/identification/solves_by_status", {"status"}, by_status, {"1", "Solves of both stages that ended so"});
}

void read_identification(const h5::File& file, StoredResult& result) {
  IdentificationResult& found = result.identification;
  const auto names = file.read<std::string>("/group");
  found.factors = result.factors.size();
  found.groups = names.size();
  found.poses = result.poses.size();
  found.rounding = file.attribute<double>("/identification", "rounding").at(0);
  found.required_poses =
      static_cast<std::uint64_t>(file.attribute<std::int64_t>("/identification", "required_poses").at(0));
  const auto linear = read_exactly<double>(file, "/identification/group_linear", found.groups);
  const auto angular = read_exactly<double>(file, "/identification/group_angular", found.groups);
  for (std::size_t g = 0; g < found.groups; ++g) result.groups.push_back({names[g], linear[g], angular[g]});
  const std::size_t cells = found.groups * found.factors;
  const auto counts = [&](const char* name) {
    return read_exactly<std::uint64_t>(file, std::string("/identification/") + name, cells);
  };
  const auto verdicts = [&](const char* name, std::size_t count) {
    return read_exactly<std::uint8_t>(file, std::string("/identification/") + name, count);
  };
  found.single_below = counts("single_below");
  found.single_max = read_exactly<double>(file, "/identification/single_max", cells);
  found.not_solved = counts("not_solved");
  found.coupled_below = counts("coupled_below");
  found.coupled_reduced = counts("coupled_reduced");
  found.single_by_group = verdicts("single_by_group", cells);
  found.coupled_by_group = verdicts("coupled_by_group", cells);
  found.single = verdicts("single", found.factors);
  found.coupled = verdicts("coupled", found.factors);
  found.couplings = read_couplings(file, found);
  const auto by_status =
      read_exactly<std::uint64_t>(file, "/identification/solves_by_status", found.solves.by_status.size());
  std::ranges::copy(by_status, found.solves.by_status.begin());
}

}  // namespace poesy
