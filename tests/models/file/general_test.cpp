#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/models/file/files.h"
#include "tests/models/file/wrong.h"

// Tests zones that a drawing leaves to the general tolerances of ISO 2768.
namespace poesy::file {
namespace {

constexpr const char* kName = "linear-delta-drawing";

const std::string kRail =
    "position = { zone = \"0.05 mm\", datums = \"A|B\" }, perpendicularity = { zone = \"0.02 mm\", datums = \"A\" }";
const std::string kRod = "tolerance = \"0.02 mm\" },\n  { name = \"rod_bore\"";

/// The text of the Delta's file with these general tolerances.
std::string with(const std::string& general) {
  return replaced(text_of(kName), {"[platform]", "[drawing]\ngeneral = " + general + "\n[platform]"});
}

/// The same text with other zones of the rail, or with another rod.
/// @{
std::string with_rail(const std::string& zones,
                      const std::string& general = "[\"ISO 2768-1:1989 m\", \"ISO 2768-2:1989 K\"]") {
  return replaced(with(general), {kRail, zones});
}
std::string with_rod(const std::string& keys,
                     const std::string& general = "[\"ISO 2768-1:1989 m\", \"ISO 2768-2:1989 K\"]") {
  return replaced(with(general), {kRod, keys + " },\n  { name = \"rod_bore\""});
}
/// @}

Feature feature(const std::string& text, const std::string& name) {
  const MechanismFile file = read_mechanism_file(text, "m.toml");
  const Mechanism made = mechanism(file, default_geometry(file));
  return *std::ranges::find(made.features, name, &Feature::name);
}

TEST(GeneralTolerances, HaveTheSizeOfTheirStandard) {
  const Feature rod = feature(with_rod("nominal_size = \"340 mm\", tolerance = \"general\""), "rod_2");
  EXPECT_DOUBLE_EQ(rod.location->size, 0.5e-3);
  EXPECT_DOUBLE_EQ(rod.size[0], 0.34);
  EXPECT_DOUBLE_EQ(
      feature(with_rod("nominal_size = \"sqrt(h*h + (R-r)*(R-r))\", tolerance = \"general\"", "\"ISO 2768-1:1989 f\""),
              "rod_1")
          .location->size,
      0.2e-3);
  const Feature rail =
      feature(with_rail("symmetry = { zone = \"general\", datums = \"B\" }, perpendicularity = \"general\""), "rail_1");
  EXPECT_DOUBLE_EQ(rail.location->size, 0.8e-3);
  EXPECT_EQ(rail.location->datums, "B");
  EXPECT_DOUBLE_EQ(rail.orientation->size, 0.8e-3);
  EXPECT_DOUBLE_EQ(feature(with_rail("runout = \"general\"", "[\"ISO 2768-2:1989 L\"]"), "rail_1").location->size,
                   0.5e-3);
  const std::string face = "parallelism = { zone = \"0.01 mm\", datums = \"A\" } },";
  EXPECT_DOUBLE_EQ(
      feature(replaced(with("[\"ISO 2768-2:1989 H\"]"), {face, "flatness = \"general\" },"}), "face_1").location->size,
      0.1e-3);
}

TEST(GeneralTolerances, AreRefusedWhereNoStandardHasThem) {
  const auto expect = [](const std::string& text, const std::string& problem, const std::string& remedy) {
    const std::string found = problem_of(text);
    EXPECT_NE(found.find(problem), std::string::npos) << found;
    EXPECT_NE(found.find("; " + remedy), std::string::npos) << found;
  };
  const std::string state = "write the length that is meant, because nothing is assumed in silence";
  for (const char* zone : {"position", "coaxiality", "angularity", "total_runout"}) {
    expect(with_rail(std::string(zone) + " = \"general\""),
           "is \"general\", but ISO 2768-2 never held for position, coaxiality, angularity, profile and total run-out",
           state);
  }
  expect(with_rail("parallelism = \"general\""), "ISO 2768-2 limits a parallelism by the tolerance of the distance",
         state);
  expect(with_rail("perpendicularity = \"general\"", "\"ISO 2768-1:1989 m\""),
         "limb[0].features[1].perpendicularity is \"general\", but the file does not say of which class",
         "write general = \"ISO 2768-2:1989 K\" in [drawing]");
  expect(with_rod("tolerance = \"general\""), "but the distance has no nominal_size", "write it");
  expect(with_rod("nominal_size = \"5 m\", tolerance = \"general\""),
         "but ISO 2768-1 has no value for this class at 5000 mm", state);
  expect(replaced(text_of(kName), {kRail, "perpendicularity = \"general\""}), "does not say of which class",
         "write general");
  for (const char* general : {"\"ISO 2768-mK\"", "\"ISO 2768-2 K\"", "\"ISO 2768-1:1989 K\"", "\"ISO 22081\""}) {
    expect(with(general), "m.toml:6:11: drawing.general is '", "write \"ISO 2768-1:1989 m\"");
  }
  expect(with("[\"ISO 2768-1:1989 m\", \"ISO 2768-1:1989 f\"]"), "names a part of ISO 2768 twice", "keep one");
}

}  // namespace
}  // namespace poesy::file
