#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "models/file/mobility.h"
#include "models/file/model.h"
#include "tests/models/file/files.h"

// Compares mechanisms with tests/data/assembly.json, which another program computed with 50 digits.
namespace poesy::file {
namespace {

using nlohmann::json;

const json& oracle() {
  static const json all = json::parse(std::ifstream(POESY_TEST_DATA "/assembly.json"));
  return all["mechanisms"];
}

/// The text of a mechanism file with its table [load] replaced.
std::string with_load(std::string text, const json& load) {
  const std::size_t begin = text.find("\n[load]");
  if (begin != std::string::npos) {
    const std::size_t end = text.find("\n[", begin + 1);
    text.erase(begin, end == std::string::npos ? end : end - begin);
  }
  text += "\n[load]\n";
  for (const auto& [key, value] : load.items()) text += key + " = " + value.dump() + "\n";
  return text;
}

class AssemblyOracle : public testing::TestWithParam<const char*> {
 protected:
  const json& expected() const { return oracle()[GetParam()]; }
};

TEST_P(AssemblyOracle, HomeFrames) {
  const Mechanism mechanism = from_file(GetParam());
  const auto near = [](const Vector3& found, const json& wanted) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(found[static_cast<Eigen::Index>(k)], wanted[k].get<double>(), 1e-14);
    }
  };
  ASSERT_EQ(mechanism.limbs.size(), expected()["limbs"].size());
  for (std::size_t e = 0; e < mechanism.limbs.size(); ++e) {
    const json& limb = expected()["limbs"][e];
    EXPECT_EQ(mechanism.limbs[e].label, limb["label"].get<std::string>());
    EXPECT_EQ(mechanism.bodies[mechanism.limbs[e].from].name, limb["from"].get<std::string>());
    EXPECT_EQ(mechanism.bodies[mechanism.limbs[e].to].name, limb["to"].get<std::string>());
    ASSERT_EQ(mechanism.limbs[e].joints.size(), limb["joints"].size());
    for (std::size_t j = 0; j < limb["joints"].size(); ++j) {
      const Joint& joint = mechanism.limbs[e].joints[j];
      near(joint.at_home.p, limb["joints"][j]["point"]);
      near(joint.at_home.R.col(2), limb["joints"][j]["z"]);
      near(joint.at_home.R.col(0), limb["joints"][j]["x"]);
    }
  }
  ASSERT_EQ(mechanism.bodies.size() - 1, expected()["bodies"].size());
  for (const assembly::Body& body : mechanism.bodies) {
    if (body.name == "base") continue;
    near(body.home.p, expected()["bodies"][body.name]["origin"]);
    near(body.home.R.col(0), expected()["bodies"][body.name]["x"]);
    near(body.home.R.col(2), expected()["bodies"][body.name]["z"]);
  }
  ASSERT_EQ(mechanism.points.size(), expected()["metric_points"].size());
  for (std::size_t k = 0; k < mechanism.points.size(); ++k) near(mechanism.points[k], expected()["metric_points"][k]);
}

TEST_P(AssemblyOracle, Mobility) {
  const Mobility found = home_mobility(from_file(GetParam()));
  const json& wanted = expected()["mobility"];
  EXPECT_EQ(found.actuated, wanted["actuated"]);
  EXPECT_EQ(found.rank, wanted["rank"]);
  EXPECT_EQ(found.loop_equations, wanted["loop_equations"]);
  EXPECT_EQ(found.freedoms, wanted["freedoms"]);
  EXPECT_EQ(found.over_constraints, wanted["over_constraints"]);
  EXPECT_EQ(found.loop_equations - found.passive_rank, wanted["over_constraints_locked"]);
  EXPECT_EQ(found.platform_freedoms, wanted["platform_freedoms"]);
  EXPECT_EQ(found.idle, wanted["idle"]);
}

/// The responses in the oracle, by the names that the model gives them.
std::map<std::string, double> wanted_of(const json& solution, const std::string& metric) {
  std::map<std::string, double> list;
  for (const auto& [name, value] : solution["response"].items()) list[name] = value;
  for (const auto& [body, motion] : solution["bodies"].items()) {
    for (const auto& [name, value] : motion.items()) list[body + "_" + name] = value;
  }
  if (metric != "stiffness") return list;
  for (const auto& [limb, of] : solution["limbs"].items()) {
    list["force_" + limb] = of["force"];
    list["moment_" + limb] = of["moment"];
  }
  for (const auto& [drive, value] : solution["actuators"].items()) list["actuator_" + drive] = value;
  for (const auto& [joint, reaction] : solution["reactions"].items()) {
    for (const auto& [name, value] : reaction.items()) list["reaction_" + joint + "_" + name] = value;
  }
  return list;
}

TEST_P(AssemblyOracle, Responses) {
  for (const json& one : expected()["cases"]) {
    const std::string metric = one["metric"];
    const std::string text = with_load(text_of(GetParam()), one.value("load", json::object()));
    const CatalogEntry read = catalog_entry(text, "file.toml");
    const CatalogEntry& entry = by_metric(read, metric);
    const ModelDescription& description = entry.description;
    ASSERT_TRUE(description.metric == metric || description.metric.empty());
    std::vector<double> pose;
    for (const PoseCoordinate& coordinate : description.pose_coordinates) pose.push_back(one["pose"][coordinate.name]);
    std::vector<double> errors;
    for (const Factor& factor : description.factors) errors.push_back(one["errors"].value(factor.name, 0.0));
    for (const std::size_t fidelity : {0u, 1u}) {
      SCOPED_TRACE(metric + " " + description.fidelities[fidelity] + " " + one["pose"].dump());
      const auto wanted = wanted_of(one[fidelity == 0 ? "exact" : "first_order"], metric);
      const std::unique_ptr<Model> model = build(entry, fidelity);
      ASSERT_EQ(model->unreachable(pose), std::nullopt);
      std::vector<double> found(description.responses.size());
      SolveStatus status{};
      std::uint32_t iterations = 0;
      const std::vector<FactorIndex> none;
      SolverOptions options;
      options.tolerance = description.tolerance;
      model->evaluator(options)->evaluate({pose, errors, none, {}, 1}, {found, {&status, 1}, {&iterations, 1}, {}});
      EXPECT_TRUE(solved(status)) << kStatusNames[static_cast<std::size_t>(status)];
      double largest = 0.0;
      for (std::size_t r = 0; r < found.size(); ++r) {
        const Dimension dimension = description.responses[r].dimension;
        if (dimension == Dimension::force || dimension == Dimension::moment) {
          largest = std::max(largest, std::abs(found[r]));
        }
      }
      std::size_t compared = 0;
      for (std::size_t r = 0; r < found.size(); ++r) {
        const Response& response = description.responses[r];
        const auto at = wanted.find(response.name);
        if (at == wanted.end()) continue;  // not in the oracle
        ++compared;
        const bool is_force = response.dimension == Dimension::force || response.dimension == Dimension::moment;
        const double tolerance = is_force                                  ? 1e-10 * largest
                                 : response.dimension == Dimension::energy ? 1e-10 * std::abs(at->second)
                                                                           : 1e-11;
        EXPECT_NEAR(found[r], at->second, tolerance) << response.name;
      }
      EXPECT_GE(compared, 10u);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, AssemblyOracle,
                         testing::Values("lift-table", "linear-delta", "upr2-rpu-beams", "delta-parallelogram",
                                         "tripteron-msa"),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace poesy::file
