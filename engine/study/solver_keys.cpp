#include <fmt/format.h>

#include <limits>

#include "engine/base/text.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

using Method = SolverOptions::Method;

constexpr std::string_view kFormat = "poesy-study";
constexpr std::int64_t kVersion = 1;

void read_format(const StudyValue& value, Study&, const Reading&) {
  if (value.text() == kFormat) return;
  value.fail("is '" + printable(value.text()) + "'",
             value.text() == "poesy-mechanism"
                 ? "this is a mechanism's file, of which 'poesy template FILE' makes a study"
                 : "a study has format = \"poesy-study\"");
}

void read_version(const StudyValue& value, Study&, const Reading&) {
  const std::int64_t number = value.whole_number(1);
  if (number <= kVersion) return;
  value.fail("is " + std::to_string(number) + ", but this poesy knows version 1 only", "use a newer poesy");
}

/// Points of the platform as a TOML list of lists [x, y, z].
std::string points_text(std::span<const PlatformPoint> points, ValueText value) {
  std::vector<std::string> list;
  for (const PlatformPoint& point : points) {
    const auto coordinate = [&](std::size_t c) { return value(point[c], Dimension::length); };
    list.push_back(fmt::format("[{}, {}, {}]", coordinate(0), coordinate(1), coordinate(2)));
  }
  return list_text(list);
}

/// Throws InputError if the study has this key, but the model has no metric. The responses of a model without metric do
/// not combine angles with lengths.
void require_metric(std::string_view key, const Study& study, const Reading& reading) {
  if (!study.model().metric.empty()) return;
  reading.root.section("solver").refuse(
      key, "model \"" + study.model().name + "\", whose responses do not combine angles with lengths");
}

/// Reads the key `metric`, and replaces the mechanism's catalog entry by the one with this metric.
void read_metric(const StudyValue& value, Study& study, const Reading& reading) {
  require_metric("metric", study, reading);
  const std::vector<std::string_view> known = names(row_of(solver_keys(), "metric").value.words);
  const std::string_view metric = known[value.word(known)];
  const CatalogEntry& entry = by_metric(*study.mechanism.entry, metric);
  const std::string& found = entry.description.metric;
  if (found != metric && !(found.empty() && metric == "platform")) {
    value.fail("is '" + std::string(metric) + "', which the mechanism has not",
               metric == "stiffness" ? "give its joints, links or limbs stiffness, or write metric = \"platform\""
                                     : "write metric = " + in_quotes(study.model().metric));
  }
  study.mechanism.entry = &entry;
}

/// Reads a point of the platform: three lengths, in the platform's frame.
PlatformPoint read_point(const StudyValue& value) {
  const std::vector<StudyValue> coordinates = value.list(3, "a point has three, [\"60 mm\", 0, 0]");
  PlatformPoint point{};
  for (std::size_t c = 0; c < point.size(); ++c) {
    point[c] = coordinates[c].is_zero() ? 0.0 : coordinates[c].quantity(Dimension::length);
  }
  return point;
}

void read_points(const StudyValue& value, Study& study, const Reading& reading) {
  require_metric("points", study, reading);
  if (study.model().metric != "platform") {
    value.fail("is for metric = \"platform\"", "write metric = \"platform\" too, or remove it");
  }
  MechanismChoice& choice = study.mechanism;
  choice.points_place = value.place();
  for (const StudyValue& point : value.list()) choice.points.push_back(read_point(point));
  if (choice.points.size() < 3) {
    value.fail("has " + std::to_string(choice.points.size()) + " points", "name three or more that are not on a line");
  }
}

/// Returns true if the study states the metric "platform", but its model has no metric. "platform" leaves out the
/// stiffness in the mechanism's file, and without stiffness only an over-constrained mechanism has a metric.
bool leaves_out_stiffness(const Study& study) {
  const std::optional<MechanismText>& file = study.mechanism.file;
  return study.model().metric.empty() && file && file->entry && !file->entry->description.metric.empty();
}

std::string metric_line(const Study& study) {
  const std::string metric = leaves_out_stiffness(study) ? "platform" : study.model().metric;
  return metric.empty() ? "" : "metric = " + in_quotes(metric) + "\n";
}

std::string points_line(const Study& study) {
  const std::vector<PlatformPoint>& points = study.mechanism.points;
  return points.empty() ? "" : "points = " + points_text(points, exact_value) + "\n";
}

std::string shown_metric(const TemplateLines& lines, const Study& study) {
  const std::string& metric = study.model().metric;
  return metric.empty() ? "" : lines.explained("solver", "metric", "metric = " + in_quotes(metric));
}

/// The template's line of the key `points`: the points that the metric uses for the mechanism with its published
/// geometry.
std::string shown_points(const TemplateLines& lines, const Study& study) {
  if (study.model().metric.empty()) return {};
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  return lines.explained("solver", "points", "# points = " + points_text(model->metric_points(), readable_value));
}

std::string shown_tolerance(const TemplateLines& lines, const Study& study) {
  return lines.explained("solver", "tolerance", "tolerance = " + shortest(study.model().tolerance));
}

/// The line of the key `series` in the study's resolved_text(). It is empty for the default, so that the text of a
/// study without this key is the same as before the key was added.
std::string series_line(const Study& study) { return study.solver.series ? "" : "series = false\n"; }

std::string shown_series(const TemplateLines& lines, const Study& study) {
  return lines.explained("solver", "series", study.solver.series ? "series = true" : "series = false");
}

/// Reads the key `not_converged`. "fail" means "exclude" with max_not_converged = 0.
void read_not_converged(const StudyValue& value, Study& study, const Reading& reading) {
  const std::vector<std::string_view> known = names(row_of(solver_keys(), "not_converged").value.words);
  const std::string_view word = known[value.word(known)];
  study.not_converged = word == name(NotConverged::include) ? NotConverged::include : NotConverged::exclude;
  if (word != "fail") return;
  reading.root.section("solver").refuse("max_not_converged", "not_converged = \"fail\", which allows none");
  study.max_not_converged = 0.0;
}

std::vector<StudyRow> solver_rows() {
  const NumberBounds share{0.0, 1.0, true, "from 0 to 1", "it is a share of all samples, from 0 to 1, e.g. 0.001"};
  return {
      StudyRow{.name = "metric",
               .value = {.type = "text",
                         .words = {{"platform",
                                    "by how far points of the platform are moved: a length, whatever the unit and the "
                                    "frame"},
                                   {"published", "as in the paper: radians against metres, at the base's origin"},
                                   {"stiffness",
                                    "by the stiffness of joints, links and limbs: in equilibrium, with "
                                    "forces and loads"}}},
               .usual = "`\"published\"`, for mechanisms from files `\"platform\"`, with stiffness `\"stiffness\"`",
               .meaning = "How mismatch of angle is weighed against mismatch of position where limbs work against each "
                          "other; only for models that have such a mismatch.",
               .reader = read_metric,
               .lines = metric_line,
               .shown = shown_metric},
      StudyRow{.name = "points",
               .value = {.type = "list of lists of lengths"},
               .usual = "where the limbs hold the platform",
               .meaning = "Points [x, y, z] in the platform's frame for metric = \"platform\", three or more that are "
                          "not on a line.",
               .reader = read_points,
               .lines = points_line,
               .shown = shown_points},
      StudyRow{.name = "method",
               .value = word_at<Method>({{Method::newton, "the model's own, fast and far-reaching"},
                                         {Method::gauss_newton,
                                          "as published: slower, and more samples do not converge; with metric = "
                                          "\"platform\" or \"stiffness\" the same as newton"}},
                                        &Study::solver, &SolverOptions::method),
               .meaning = "The iteration."},
      StudyRow{.name = "tolerance",
               .value = number_at(above_zero("1e-15"), &Study::solver, &SolverOptions::tolerance),
               .besides = "; with metric = \"platform\" `1e-14`",
               .meaning =
                   "Converged: the residual's largest change (rad, m) in one iteration is below this; with metric "
                   "= \"platform\" its length is below this share of the mechanism's reach.",
               .shown = shown_tolerance},
      StudyRow{.name = "max_iterations",
               .value = whole_at(1, std::numeric_limits<int>::max(), &Study::solver, &SolverOptions::max_iterations),
               .meaning = "Iterations after which a sample counts as not converged."},
      StudyRow{
          .name = "series",
          .value = value_at(
              "true or false", "", [](const StudyValue& value) { return value.yes_or_no(); },
              [](bool value) { return std::string(value ? "true" : "false"); }, &Study::solver, &SolverOptions::series),
          .meaning = "A study of kind \"sensitivity\": whether certified series replace solves. Only at full "
                     "fidelity, and not with metric = \"published\".",
          .lines = series_line,
          .shown = shown_series},
      StudyRow{.name = "not_converged",
               .value = {.type = "text",
                         .words = {{name(NotConverged::exclude), "they are left out of all statistics"},
                                   {name(NotConverged::include), "the last iterate counts"},
                                   {"fail", "exclude, with max_not_converged = 0"}},
                         .text = [](const Study& study) { return in_quotes(name(study.not_converged)); }},
               .meaning = "What becomes of samples that did not converge.",
               .reader = read_not_converged},
      StudyRow{.name = "max_not_converged",
               .value = number_at(share, &Study::max_not_converged),
               .meaning = "Share of all samples; if more fail, the run ends with exit code 5, its result kept."}};
}

/// The description of a section such as [poses], which another function reads.
StudyRow table_row(std::string_view name, std::string missing, std::string usual, std::string_view meaning) {
  return {.name = name,
          .value = {.type = "table"},
          .missing = std::move(missing),
          .usual = std::move(usual),
          .meaning = meaning};
}

}  // namespace

const StudyRows& file_keys() {
  static const StudyRows keys{
      .paths = {""},
      .meaning = "Before the first section, and the sections.",
      .rows = {StudyRow{.name = "format",
                        .value = {.type = "text", .text = [](const Study&) { return in_quotes(kFormat); }},
                        .missing = "begin a study with {}",
                        .example = in_quotes(kFormat),
                        .meaning = "Always \"poesy-study\".",
                        .reader = read_format},
               StudyRow{.name = "version",
                        .value = {.type = "integer",
                                  .bounds = "at least 1",
                                  .text = [](const Study&) { return std::to_string(kVersion); }},
                        .missing = "write {}",
                        .example = std::to_string(kVersion),
                        .meaning = "The version of the format, 1.",
                        .reader = read_version},
               StudyRow{.name = "title", .value = text_at(&Study::title), .meaning = "Free text; the result keeps it."},
               table_row("mechanism", "add the section [mechanism] with the key model", "", "Which mechanism."),
               response_row(),
               table_row("poses", "add the section [poses] with the key count", "", "At which poses of the platform."),
               table_row("errors", "", "as shown there", "How errors scatter."),
               table_row("analysis", "", "", "What is asked, of which errors."),
               table_row("solver", "", "as shown there", "How samples are solved."),
               table_row("run", "", "as shown there", "Where draws begin.")}};
  return keys;
}

const StudyRows& solver_keys() {
  static const StudyRows keys{.paths = {"solver"},
                              .meaning = "How samples are solved, and what becomes of those that are not.",
                              .rows = solver_rows()};
  return keys;
}

const StudyRows& run_keys() {
  static const StudyRows keys{
      .paths = {"run"},
      .meaning = "Nothing here depends on the machine.",
      .rows = {StudyRow{.name = "seed",
                        .value = whole_at(0, std::numeric_limits<std::int64_t>::max(), &Study::seed),
                        .meaning = "The same seed gives the same bits on any number of threads."}}};
  return keys;
}

void read_solver(Study& study, const Reading& reading) {
  const StudySection section = reading.root.section("solver");
  read_keys(solver_keys(), section, study, reading);
  if (!section.find("tolerance")) study.solver.tolerance = study.model().tolerance;
}

}  // namespace poesy
