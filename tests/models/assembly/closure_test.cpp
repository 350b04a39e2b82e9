// Tests which machines cannot be assembled if limbs branch at bodies: the same ones as for the same mechanism without
// intermediate bodies.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "models/file/model.h"
#include "tests/models/file/files.h"

namespace poesy::file {
namespace {

constexpr std::size_t kMachines = 4000;

/// The text of flat-delta with a body, the carriage, between each rail and rod. elastic: whether the drives have a
/// stiffness.
std::string branched(bool elastic) {
  std::string text = text_of("flat-delta");
  text.resize(text.find("[[limb]]"));
  return text + R"(
[[body]]
name   = "carriage"
copies = { count = 3, about = "z" }
at     = ["R", 0, "e + h"]

[[limb]]
name   = "rail"
copies = { count = 3, about = "z" }
to     = "carriage"
joints = [
  { name = "O", type = "fixed", at = ["R", 0, 0], axis = "z", x = "x" },
  { name = "q", type = "P", at = ["R", 0, "e + h"], axis = "z", actuated = true )" +
         (elastic ? ", stiffness = { z = \"5 N/um\" }" : "") + R"( } ]

[[limb]]
name   = "rod"
copies = { count = 3, about = "z" }
from   = "carriage"
joints = [
  { name = "B", type = "U", at = ["R", 0, "e + h"], axis = "y", axis2 = ["h", 0, "r - R"] },
  { name = "C", type = "U", at = ["r", 0, "e"], axis = ["h", 0, "r - R"], axis2 = "y" } ]

[[error]]
name      = "zero"
limb      = "rod"
frame     = 0
component = "delta_z"

[[error]]
name      = "rod"
limb      = "rod"
frame     = "B"
component = "delta_x"
)";
}

struct Outcomes {
  std::vector<SolveStatus> status;
  std::vector<double> position;
};

/// The outcomes at the home pose of machines with normal errors, sigma = 0.1 mm. The errors are the same for every
/// mechanism.
Outcomes outcomes(const std::string& text) {
  const std::unique_ptr<Model> model = build(catalog_entry(text, "file.toml"));
  const ModelDescription& description = model->description();
  std::vector<FactorIndex> varied;
  for (const char* name : {"zero_1", "zero_2", "zero_3", "rod_1", "rod_2", "rod_3"}) {
    varied.push_back(*description.find_factor(name));
  }
  std::mt19937_64 engine(7);
  std::normal_distribution<double> normal(0.0, 1e-4);
  std::vector<double> values(varied.size() * kMachines);
  for (double& value : values) value = normal(engine);
  const std::vector<double> none(description.factors.size(), 0.0);
  const std::vector<double> pose{0.0, 0.0, 0.2};
  std::vector<double> responses(description.responses.size() * kMachines);
  std::vector<std::uint32_t> iterations(kMachines);
  Outcomes made{std::vector<SolveStatus>(kMachines), {}};
  SolverOptions options;
  options.tolerance = description.tolerance;
  model->evaluator(options)->evaluate({pose, none, varied, values, kMachines},
                                      {responses, made.status, iterations, {}});
  const auto at = std::ranges::find(description.responses, "position", &Response::name);
  const auto row = static_cast<std::size_t>(at - description.responses.begin());
  made.position.assign(responses.begin() + static_cast<std::ptrdiff_t>(row * kMachines),
                       responses.begin() + static_cast<std::ptrdiff_t>((row + 1) * kMachines));
  return made;
}

TEST(Closure, FindsTheMachinesThatTheLimbsWithoutBodiesFind) {
  const Outcomes wanted = outcomes(text_of("flat-delta"));
  EXPECT_GT(std::ranges::count(wanted.status, SolveStatus::not_assembled), 20);
  for (const bool elastic : {false, true}) {
    const Outcomes found = outcomes(branched(elastic));
    std::size_t different = 0;
    for (std::size_t b = 0; b < kMachines; ++b) {
      const bool is_open = wanted.status[b] == SolveStatus::not_assembled;
      different += (found.status[b] == SolveStatus::not_assembled) != is_open || solved(found.status[b]) == is_open;
      if (is_open || !solved(found.status[b])) continue;
      EXPECT_NEAR(found.position[b], wanted.position[b], 1e-9) << b;
    }
    EXPECT_EQ(different, 0u) << (elastic ? "with stiffness" : "without");
  }
}

}  // namespace
}  // namespace poesy::file
