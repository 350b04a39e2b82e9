#include "engine/kinds/study_file.h"
#include "engine/study/study_kind.h"

#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <set>
#include <sstream>
#include <tuple>

#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

extern const Catalog kKeyCatalog;

/// The fake mechanism with the description of kKeyCatalog. It accepts calibration, which changes nothing.
class CalibratedFake : public test::FakeModel {
 public:
  using FakeModel::FakeModel;

  const ModelDescription& description() const override { return kKeyCatalog.front().description; }

  std::unique_ptr<Evaluator> calibrated_evaluator(const SolverOptions& options) const override {
    return evaluator(options);
  }
};

/// A CalibratedFake whose platform has points, for the platform metric.
class FakeByPlatform final : public CalibratedFake {
 public:
  std::vector<PlatformPoint> metric_points() const override { return {{0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}}; }
};

/// A catalog of the fake mechanism with two fidelities and two metrics, which change nothing. Every mechanism file is
/// read as this mechanism.
Catalog catalog() {
  Catalog two = test::fake_catalog();
  two.from_text = [](const std::string&, const std::string& path) {
    CatalogEntry entry = kKeyCatalog.front();
    entry.file = path;
    return entry;
  };
  two.front().description.separation = SeparationDescription{"of no interest", {}};
  for (const char* name : {"third", "x", "y", "z"}) {
    two.front().description.responses.push_back({name, Dimension::length, "never solved"});
  }
  two.front().build = [](auto geometry, auto) { return std::make_unique<CalibratedFake>(geometry[0]); };
  two.front().description.fidelities = {"exact", "first-order"};
  Feature rod{.name = "rod_1", .label = "rod", .limb = 1, .frame = 0, .kind = FeatureKind::distance};
  rod.middle = {FactorIndex(2)};
  rod.location = Zone{"tolerance", 1e-3, {}};
  two.front().description.features = {rod};
  CatalogEntry by_platform = two.front();
  by_platform.description.metric = "platform";
  by_platform.build = [](auto, auto) { return std::make_unique<FakeByPlatform>(); };
  by_platform.build_with_points = [](auto, auto, auto) { return std::make_unique<FakeByPlatform>(); };
  two.front().description.metric = "published";
  two.front().other_metric = std::make_shared<const CatalogEntry>(std::move(by_platform));
  return two;
}

const Catalog kKeyCatalog = catalog();

constexpr std::string_view kHead = R"(format = "poesy-study"
version = 1
title = "A study"
[[response]]
name = "one"
norm = ["linear_deformation", "third"]
description = "never solved"
[[response]]
name = "two"
sum = { linear_deformation = 1, third = -2 }
relative_to = { z = "-0.2 m", beta = 0, gamma = 0 }
[[response]]
name = "three"
point = "origin"
direction = [0, 3, 4]
[mechanism]
model = "fake"
geometry = { arm = "50 mm" }
fidelity = "exact"
[errors]
linear = { distribution = "normal", sigma = "2 mm", shift = "1 mm", mean = "0 mm" }
angular = { distribution = "truncated-normal", sigma = "1 deg", half_width = "2 deg", shift = "1 deg", mean = "0 deg" }
override = { delta_1 = { distribution = "uniform", half_width = "1 mm", shift = "1 mm", mean = "0 mm", draws = "per machine" }, delta_2 = { distribution = "triangular", half_width = "1 mm", shift = "1 mm", mean = "0 mm" } }
[solver]
metric = "published"
method = "newton"
tolerance = 1e-12
max_iterations = 40
series = false
not_converged = "include"
max_not_converged = 0.5
[run]
seed = 7
)";

constexpr std::string_view kBox =
    R"(workspace = { z = ["-0.3 m", "-0.2 m"], beta = ["-0.1 rad", "0.1 rad"], gamma = ["-0.1 rad", "0.1 rad"] }
limits = { q_1 = ["0 mm", "400 mm"], q_2 = ["-1 rad", "1 rad"] }
max_condition = 1e6
)";

/// Studies that together use every key of every table, with every kind of study and every selection of poses that allow
/// the key.
std::vector<std::string> studies() {
  const std::string head(kHead);
  const std::string box(kBox);
  std::string both = head;
  both.replace(both.find("\"exact\""), 7, "\"both\"");
  // Without the tolerance, because its default differs for the platform metric.
  std::string by_platform = head;
  by_platform.replace(by_platform.find("tolerance = 1e-12"), 17, "");
  by_platform.replace(by_platform.find("\"published\""), 11,
                      "\"platform\"\npoints = [[\"1 m\", 0, 0], [0, \"1 m\", 0], [0, 0, \"1 m\"]]");
  std::string from_file = head;
  from_file.replace(from_file.find("model = \"fake\""), 14, "file = \"mechanism.toml\"");
  std::string measured = head;
  const std::size_t override_at = measured.find("override = ");
  measured.replace(
      override_at, measured.find('\n', override_at) - override_at,
      "override = { delta_1 = { distribution = \"measured\", file = \"parts.csv\", column = \"hole\" }, "
      "delta_2 = { distribution = \"measured\", values = [\"1 mm\", \"2 mm\", \"3 mm\", \"4 mm\", \"5 mm\", "
      "\"6 mm\", \"7 mm\", \"8 mm\"] } }\n"
      "correlated = [{ factors = [\"delta_1\", \"delta_2\"], correlation = [[1, 0.5], [0.5, 1]] }]");
  std::string between = head;
  const std::size_t errors_at = between.find("linear = {");
  between.replace(errors_at, between.find("[solver]") - errors_at,
                  "linear = { distribution = \"normal\", limits = [0, \"2 mm\"], sigmas = 3 }\n"
                  "angular = { distribution = \"truncated-normal\", sigma = \"1 deg\", limits = [0, \"2 deg\"] }\n"
                  "override = { delta_1 = { distribution = \"uniform\", limits = \"8 h6\" }, "
                  "delta_2 = { distribution = \"triangular\", limits = [\"-1 mm\", 0] } }\n");
  const auto with_zones = [](std::string text, const std::string& use) {
    return text.insert(text.find("override = "), "zones = { distribution = \"normal\", " + use + " }\n");
  };
  by_platform = with_zones(by_platform, "cpk = 1.33");
  both = with_zones(both, "within = 0.99");
  measured = with_zones(measured, "sigmas = 3");
  const auto machines_of = [&](const std::string& machines) {
    std::string given = head;
    given.insert(given.find("[solver]"), "machines = " + machines + "\n");
    return given +
           "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"monte-carlo\"\ndraws = \"per "
           "machine\"\n";
  };
  const std::string background = "background = { factors = \"benign\", linear = \"2 mm\", angular = \"2 deg\" }\n";
  return {
      head + "[poses]\nselect = \"interior\"\ncount = 3\n" + box +
          "[analysis]\nkind = \"sensitivity\"\nfactors = [\"delta_1\"]\nsamples = 50\nconf_level = 0.9\n" + background +
          "reference = { factor = \"delta_1\", tolerance = \"2 mm\" }\n",
      between + "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"sensitivity\"\n",
      machines_of("\"machines.csv\""),
      machines_of("{ columns = [\"delta_2\"], rows = [[0.001], [0.002]] }"),
      from_file + "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"sensitivity\"\n",
      by_platform + "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"sensitivity\"\n",
      both + "[poses]\nselect = \"file\"\nfile = \"poses.csv\"\n[analysis]\nlinearity = 0.02\n",
      head + "[poses]\nselect = \"grid\"\ncount = { z = 2, beta = 3, gamma = 2 }\n" + box +
          "[analysis]\nkind = \"monte-carlo\"\nfactors = \"deforming\"\ndraws = \"per machine\"\ncalibrated = "
          "true\nconf_level = "
          "0.95\nquantiles = [0.1, 0.2]\n" +
          background + "samples = { min = 500, max = 5000, relative_error = 0.1, conf_level = 0.95 }\n",
      head +
          "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"monte-carlo\"\ndraws = \"per pose\"\n"
          "judge = \"rms\"\nlimits = { angular_deformation = \"1 deg\", linear_deformation = \"1 mm\" }\n",
      head +
          "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"monte-carlo\"\ndraws = \"per pose\"\n"
          "judge = \"share\"\nshare = 0.99\nlimits = { angular_deformation = \"1 deg\" }\n",
      head +
          "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"monte-carlo\"\ndraws = \"per machine\"\n"
          "judge = \"yield\"\nyield = 0.99\nlimits = { angular_deformation = \"1 deg\" }\n",
      head +
          "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"monte-carlo\"\ndraws = \"per machine\"\n"
          "limits = { angular_deformation = { from = \"-1 deg\", to = \"2 deg\", share = 0.9 }, linear_deformation = "
          "{ spread = \"1 mm\" } }\n",
      head +
          "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"sobol\"\nfactors = \"deforming\"\nsamples = "
          "160\n"
          "conf_level = 0.9\ngroups = { a = [\"delta_1\"], b = \"epsilon_1\" }\nsecond_order = true\n"
          "design = \"lhs\"\nreplicates = 10\n" +
          background,
      head + "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"sobol\"\ndesign = \"random\"\n",
      head + "[poses]\nselect = \"boundary\"\ncount = 3\n" + box +
          "[analysis]\nkind = \"identification\"\nfactors = \"all\"\npose_share = 0.9\n"
          "groups = [{ name = \"small\", linear = \"2 mm\", angular = \"2 deg\" }]\n",
      head +
          "[poses]\nselect = \"trajectory\"\nmax_condition = 1e6\n"
          "trajectory = { curve = \"wave\", origin = [\"0.21 m\", \"-1 rad\", \"0 rad\"], points = 5, time = [\"0 "
          "s\", \"1 s\"] }\n"
          "[analysis]\nkind = \"evaluate\"\nlimits = { angular_deformation = \"1 deg\" }\n" +
          background +
          "cases = [{ name = \"one\", errors = { linear = \"1 mm\", angular = \"1 deg\", delta_1 = \"2 mm\", "
          "deforming = { linear = \"1 mm\", angular = \"1 deg\" } } }]\n",
      head +
          "[poses]\nselect = \"trajectory\"\n"
          "trajectory = { file = \"curve.csv\", points = 5, time = [\"0 s\", \"1 s\"] }\n"
          "[analysis]\nkind = \"coupling\"\nlinear = [\"1 mm\"]\nangular = [\"1 deg\"]\nlimbs = \"independent\"\n"
          "components = \"independent\"\nworst_case = \"sum\"\nsources = [{ name = \"A\", factors = \"deforming\" }, { "
          "name = \"B\", "
          "factors = "
          "[\"delta_2\"] }]\n",
      measured +
          "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"sobol\"\nshapley = true\n"
          "second_order = false\nfactors = \"all\"\nsamples = 80\nconf_level = 0.9\ndesign = \"lhs\"\n"
          "groups = { one = [\"delta_1\"], other = \"delta_2\" }\nreplicates = 8\n",
      head +
          "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"sobol\"\ndesign = \"lhs\"\n"
          "samples = 80\ngroups = \"limb\"\nshapley = false\n",
      head +
          "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"allocation\"\nfactors = \"all\"\n"
          "samples = 5000\nlimits = { angular_deformation = \"1 deg\" }\nyield = 0.99\nconfidence = 0.9\n"
          "aim = \"least-cost\"\nsigmas = 4\n"
          "parts = [{ name = \"pins\", factors = [\"delta_1\"], each = false, sigmas = 2, shift = 0.1, processes = [{ "
          "name = \"turning\", cost = { law = \"reciprocal\", a = 1, b = 2, unit = \"mm\" }, bounds = [\"1 mm\", "
          "\"2 mm\"] }] }, { factors = [\"epsilon_1\"], cpk = 1, cost = { law = \"exponential\", a = 1, b = 2, tau = "
          "\"1 deg\" }, bounds = [\"1 deg\", \"2 deg\"] }, { factors = [\"delta_2\"], sigmas = 3, cost = { law = "
          "\"reciprocal-power\", a = 1, b = 2, k = 2, unit = \"mm\" }, values = [\"1 mm\"] }]\n",
      head +
          "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"allocation\"\nfactors = [\"delta_1\"]\n"
          "sigmas = 3\nlimits = { angular_deformation = \"1 deg\" }\n" +
          background +
          "parts = [{ factors = [\"delta_1\"], round = \"0.001 mm\", cost = { law = \"reciprocal\", b = 1, unit = "
          "\"mm\" } }]\n",
      head +
          "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"allocation\"\ncpk = 1\ncalibrated = true\n"
          "limits = { angular_deformation = \"1 deg\" }\nparts = [{ factors = \"linear\", each = true, identical_limbs "
          "= [1, "
          "2], grades = [\"IT7\"], nominal_size = \"50 mm\" }, { factors = \"angular\", tolerance = \"1 deg\" }]\n",
      with_zones(head, "sigmas = 3") +
          "[poses]\nselect = \"interior\"\ncount = 3\n[analysis]\nkind = \"allocation\"\n"
          "limits = { angular_deformation = \"1 deg\" }\nparts = [{ zones = [\"rod.tolerance\"], each = true, "
          "tolerance = \"1 mm\" }]\n"};
}

using OnTable = std::function<void(toml::table& table, const std::string& path)>;

void visit(toml::table& table, const std::string& path, const OnTable& on_table);

void visit(toml::array& list, const std::string& path, const OnTable& on_table) {
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (auto* table = list[k].as_table()) visit(*table, path + "[" + std::to_string(k) + "]", on_table);
  }
}

/// Calls `on_table` for every table of a study, always in the same order.
void visit(toml::table& table, const std::string& path, const OnTable& on_table) {
  on_table(table, path);
  for (auto&& [key, value] : table) {
    const std::string below = (path.empty() ? "" : path + ".") + std::string(key.str());
    if (auto* section = value.as_table()) visit(*section, below, on_table);
    if (auto* list = value.as_array()) visit(*list, below, on_table);
  }
}

/// One use of a key in one of the studies().
struct Use {
  const StudyTable* table;
  const StudyKey* key;
  std::size_t study;      ///< index in studies()
  std::size_t visited;    ///< index of the table in the order of visit()
  std::string name;       ///< the key as the study writes it
  std::string full_name;  ///< path and name as in messages
  std::string word;       ///< the value of the table's chooser (e.g. kind) in the study
};

/// Whether a key is a placeholder for names of the model, like SET. Placeholders are in capitals.
bool is_name_of_model(const StudyKey& key) {
  return std::ranges::all_of(key.name, [](unsigned char letter) { return std::isupper(letter) != 0; });
}

/// The description of a key in a table whose chooser has the value `word`: that of the key itself, or that of the
/// placeholder for names of the model.
const StudyKey* description(const StudyTable& table, const std::string& name, const std::string& word) {
  if (const StudyKey* key = table.find(name, word)) return key;
  const bool is_set = kKeyCatalog.front().description.find_set(name) != nullptr;
  for (const StudyKey& key : table.keys) {
    if (is_name_of_model(key) && (key.name == "SET") == is_set) return &key;
  }
  return nullptr;
}

std::string word_of(const toml::table& table, const StudyTable& described) {
  if (described.chooser.empty()) return {};
  const std::string_view usual = described.find(described.chooser)->usual;
  const std::string_view written = usual.size() > 4 ? usual.substr(2, usual.size() - 4) : usual;
  return std::string(table[described.chooser].value_or(written));
}

std::vector<Use> uses() {
  std::vector<Use> found;
  const std::vector<std::string> texts = studies();
  for (std::size_t s = 0; s < texts.size(); ++s) {
    toml::table study = toml::parse(texts[s]);
    std::size_t visited = 0;
    visit(study, "", [&](toml::table& table, const std::string& path) {
      const StudyTable* described = find_table(study_kinds().tables, path);
      if (described == nullptr) throw std::logic_error("no description of [" + path + "]");
      const std::string word = word_of(table, *described);
      for (auto&& [key, value] : table) {
        const std::string name(key.str());
        found.push_back({described, description(*described, name, word), s, visited, name,
                         (path.empty() ? "" : path + ".") + name, word});
      }
      ++visited;
    });
  }
  return found;
}

const std::vector<Use>& all_uses() {
  static const std::vector<Use> found = uses();
  return found;
}

/// The study of a use with the key set to this TOML value. Empty value: without the key.
std::string changed(const Use& use, std::string_view value) {
  toml::table study = toml::parse(studies()[use.study]);
  std::size_t visited = 0;
  toml::table* changed = nullptr;
  visit(study, "", [&](toml::table& table, const std::string&) {
    if (visited++ == use.visited) changed = &table;
  });
  if (value.empty()) {
    changed->erase(use.name);
  } else {
    const toml::table parsed = toml::parse("x = " + std::string(value));
    changed->insert_or_assign(use.name, *parsed.get("x"));
  }
  std::ostringstream text;
  text << study;
  return text.str();
}

/// Reads the study. Returns its resolved text, with every default filled in.
std::string read(const std::string& text) {
  static const test::TempFolder folder;
  static const std::string poses = folder.write("poses.csv", "z,beta,gamma\n-0.2,0,0\n");
  static const std::string parts =
      folder.write("parts.csv", "part,hole [mm]\na,1\nb,2\nc,3\nd,4\ne,5\nf,6\ng,7\nh,8\n");
  static const std::string machines = folder.write("machines.csv", "delta_2 [mm]\n1\n2\n");
  static const std::string mechanism = folder.write("mechanism.toml", "of no interest");
  static const std::string curve = folder.write("curve.csv", "t,z,beta,gamma\n0,-0.2,0,0\n1,-0.2,0.1,0\n");
  return resolved_text(read_study(folder.write("study.toml", text), kKeyCatalog, StudyUse::run));
}

/// The message with which the study is refused. Empty if it is accepted.
std::string refusal(const std::string& text) {
  return test::refusal_of([&] { read(text); });
}

std::string literal(std::string_view usual) {
  return usual.starts_with('`') ? std::string(usual.substr(1, usual.find('`', 1) - 1)) : std::string();
}

/// Whether the studies of this test cannot use a key. Loads, and sizes of errors without a unit (`relative`), need a
/// mechanism from a file. Keys of calibration are for other commands than `poesy run`
/// (tests/program/calibrate_test.py).
bool is_used_elsewhere(const StudyTable& table, const StudyKey& key) {
  const std::string_view path = table.paths.front();
  const bool is_load = path == "mechanism.load" || (path == "mechanism" && key.name == "load");
  return is_load || key.name == "relative" || path.starts_with("analysis.calibration") ||
         (path == "analysis" && key.name == "calibration");
}

TEST(StudyKeys, AreAllUsedByTheStudiesOfThisTest) {
  std::set<std::tuple<const StudyKey*, std::string>> used;
  for (const Use& use : all_uses()) {
    ASSERT_NE(use.key, nullptr) << use.full_name;
    used.insert({use.key, ""});
    used.insert({use.key, use.word});
  }
  for (const StudyTable& table : study_kinds().tables) {
    for (const StudyKey& key : table.keys) {
      if (is_used_elsewhere(table, key)) continue;
      EXPECT_TRUE(used.contains({&key, ""})) << table.paths.front() << " " << key.name;
      for (const std::string_view word : key.only_for) {
        EXPECT_TRUE(used.contains({&key, std::string(word)})) << table.paths.front() << " " << key.name << " " << word;
      }
    }
  }
  for (const std::string& study : studies()) EXPECT_EQ(refusal(study), "") << study;
}

/// No key accepts a date. So a key that is set to a date and not refused was not read.
TEST(StudyKeys, AreAllRead) {
  for (const Use& use : all_uses()) {
    const std::string reason = refusal(changed(use, "2026-01-31"));
    EXPECT_NE(reason.find(" " + use.full_name + " is a date or time"), std::string::npos)
        << use.full_name << ": " << reason;
  }
}

TEST(StudyKeys, AreRequiredWhereTheySayIt) {
  for (const Use& use : all_uses()) {
    if (!use.key->required) continue;
    const std::string reason = refusal(changed(use, ""));
    const bool missing = reason.find("'" + use.name + "' is missing") != std::string::npos;
    EXPECT_TRUE(missing || reason.find("at least one case") != std::string::npos) << use.full_name << ": " << reason;
  }
}

/// If a key may be left out, the study is the same as with the stated default.
TEST(StudyKeys, HaveTheDefaultsThatTheyName) {
  std::set<const StudyKey*> left_out;
  for (const Use& use : all_uses()) {
    const std::string without = changed(use, "");
    if (use.key->usual.empty() || !refusal(without).empty()) continue;
    left_out.insert(use.key);
    const std::string usual = literal(use.key->usual);
    EXPECT_EQ(read(without), read(usual.empty() ? without : changed(use, usual))) << use.full_name;
  }
  for (const StudyTable& table : study_kinds().tables) {
    for (const StudyKey& key : table.keys) {
      if (is_used_elsewhere(table, key)) continue;
      // The default of a required key only states where the key may be left out.
      EXPECT_EQ(left_out.contains(&key), !key.required && !key.usual.empty()) << table.paths.front() << " " << key.name;
    }
  }
}

TEST(StudyKeys, TakeTheWordsThatTheyName) {
  for (const Use& use : all_uses()) {
    if (use.key->words.empty()) continue;
    std::string known;
    for (const StudyWord& word : use.key->words) known += (known.empty() ? "known: " : ", ") + std::string(word.name);
    const std::string reason = refusal(changed(use, "\"?\""));
    EXPECT_TRUE(reason.ends_with(known)) << reason << " but " << known;
  }
}

/// Values just outside some stated bounds, as TOML of different types, and a part of the message that refuses them.
struct Outside {
  std::string_view bounds;
  std::vector<std::string> values;
  std::string says;
};

TEST(StudyKeys, HaveTheBoundsThatTheyName) {
  const std::array known{
      Outside{"at least 0", {"-1", "\"-1 mm\"", "\"-1 deg\""}, "it must be at least 0"},
      Outside{"at least 1", {"0"}, "it must be at least 1"},
      Outside{"at least 2", {"1"}, "it must be at least 2"},
      Outside{"greater than 0",
              {"0", "\"0 mm\"", "\"0 deg\"", "[\"0 mm\"]", "[\"0 deg\"]"},
              "it must be greater than zero"},
      Outside{"at least 1e-30 m or rad",
              {"\"9.99e-31 m\"", "\"9.99e-31 rad\""},
              "it must be at least 1e-30 m or 1e-30 rad"},
      Outside{"the smaller one first", {"[\"1 mm\", 0]", "[\"1 deg\", 0]"}, "the smaller limit first"},
      Outside{"greater than 0 and less than 1e6", {"0", "1e6"}, "it must lie between 0 and 1e6"},
      Outside{"greater than 1", {"1"}, "it must be greater than 1"},
      Outside{"between 0 and 1", {"0", "1", "[0]", "[1]"}, "it must lie between 0 and 1"},
      Outside{"at least 8", {"7", "[\"1 mm\"]"}, "at least 8"},
      Outside{"symmetric, ones on its diagonal, positive definite", {"[[1, 2], [2, 1]]"}, "between -1 and 1"},
      Outside{"above 0 and at most 1", {"0", "1.001"}, "above 0 and at most 1"},
      Outside{"from 0 to 1", {"-0.001", "1.001"}, "from 0 to 1"}};
  for (const Use& use : all_uses()) {
    if (use.key->bounds.empty()) continue;
    const auto outside = std::ranges::find(known, use.key->bounds, &Outside::bounds);
    ASSERT_NE(outside, known.end()) << use.full_name;
    const bool refused = std::ranges::any_of(outside->values, [&](const std::string& value) {
      const std::string reason = refusal(changed(use, value));
      return reason.find(use.full_name) != std::string::npos && reason.find(outside->says) != std::string::npos;
    });
    EXPECT_TRUE(refused) << use.full_name;
  }
}

TEST(StudyKeys, AreFoundAtEveryPathOfAStudy) {
  EXPECT_EQ(find_table(study_kinds().tables, "errors.override.delta_1"),
            find_table(study_kinds().tables, "errors.linear"));
  EXPECT_EQ(find_table(study_kinds().tables, "analysis.cases[12].errors.all"),
            find_table(study_kinds().tables, "analysis.cases.errors.SET"));
  EXPECT_EQ(find_table(study_kinds().tables, "")->keys.front().name, "format");
  EXPECT_EQ(find_table(study_kinds().tables, "analysis.cases.errors.all.more"), nullptr);
  EXPECT_EQ(find_table(study_kinds().tables, "analysi"), nullptr);
}

/// The words of a text without '#' signs, separated by single spaces.
std::string words_of(const std::string& text) {
  std::istringstream in(text);
  std::string words;
  for (std::string word; in >> word;) {
    if (word != "#") words += " " + word;
  }
  return words + " ";
}

/// Whether templates explain a key. They do not explain placeholders, for which they write the names of the model, and
/// sections.
bool in_templates(const StudyTable& table, const StudyKey& key) {
  return !(table.paths.front().empty() && key.type == "table") && !is_name_of_model(key);
}

TEST(Template, ExplainsEveryKeyInTheWordsOfItsDescription) {
  std::string all;
  for (const StudyKind* kind : study_kinds().all) all += words_of(template_text(kKeyCatalog.front(), *kind));
  for (const StudyTable& table : study_kinds().tables) {
    for (const StudyKey& key : table.keys) {
      if (!in_templates(table, key) || is_used_elsewhere(table, key)) continue;
      EXPECT_NE(all.find(words_of(explanation(table, key))), std::string::npos)
          << table.paths.front() << " " << key.name;
    }
  }
}

TEST(Reference, HasEveryKeyAndNoUndividedRow) {
  std::istringstream lines(study_reference());
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("| `")) ++rows;
    EXPECT_TRUE(line.empty() || line.back() != ' ') << line;
  }
  std::size_t keys = 0;
  for (const StudyTable& table : study_kinds().tables) keys += table.keys.size();
  EXPECT_EQ(rows, keys);
}

}  // namespace
}  // namespace poesy
