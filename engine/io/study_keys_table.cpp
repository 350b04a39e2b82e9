#include "engine/io/study_keys.h"
#include "engine/study/study.h"

namespace poesy {
namespace {

using Kind = Analysis::Kind;
using Select = PoseSelection::Select;
using Shape = Distribution::Shape;
using Method = SolverOptions::Method;

constexpr std::string_view kLinearDefault = "`{ distribution = \"normal\", sigma = \"1 mm\" }`";
constexpr std::string_view kAngularDefault = "`{ distribution = \"normal\", sigma = \"1 deg\" }`";

StudyTable file_itself() {
  return {.paths = {""},
          .meaning = "Before the first section, and the sections.",
          .keys = {
              {.name = "format", .type = "text", .required = true, .meaning = "Always \"poesy-study\"."},
              {.name = "version",
               .type = "integer",
               .bounds = "at least 1",
               .required = true,
               .meaning = "The version of the format, 1."},
              {.name = "title", .type = "text", .usual = "`\"\"`", .meaning = "Free text; the result keeps it."},
              {.name = "mechanism", .type = "table", .required = true, .meaning = "Which mechanism."},
              {.name = "poses", .type = "table", .required = true, .meaning = "At which poses of the platform."},
              {.name = "errors", .type = "table", .usual = "as shown there", .meaning = "How errors scatter."},
              {.name = "analysis",
               .type = "table",
               .usual = "a sensitivity study",
               .meaning = "What is asked, of which errors."},
              {.name = "solver", .type = "table", .usual = "as shown there", .meaning = "How samples are solved."},
              {.name = "run", .type = "table", .usual = "as shown there", .meaning = "Where draws begin."},
          }};
}

StudyTable mechanism() {
  return {.paths = {"mechanism"},
          .meaning = "The mechanism and its geometry.",
          .keys = {
              {.name = "model",
               .type = "text",
               .required = true,
               .meaning = "Name of the mechanism; 'poesy models' lists them."},
              {.name = "geometry",
               .type = "table",
               .usual = "as published",
               .meaning = "Parameters of the geometry that differ from the published ones; where they do, look at the "
                          "workspace too."},
              {.name = "fidelity",
               .type = "text",
               .usual = "the first of them",
               .meaning = "One of the model's ways to solve a sample, for models that offer a choice; of two, \"both\" "
                          "solves each on the same draws in a sensitivity study and tells which errors are linear."},
          }};
}

StudyTable geometry() {
  return {.paths = {"mechanism.geometry"},
          .meaning = "'poesy models MODEL' lists the parameters.",
          .keys = {{.name = "PARAMETER",
                    .type = "quantity",
                    .usual = "its published value",
                    .meaning = "A parameter of the geometry."}}};
}

StudyTable poses() {
  const std::vector<std::string_view> of_box{name(Select::interior), name(Select::boundary), name(Select::grid)};
  std::vector<std::string_view> of_model = of_box;
  of_model.push_back(name(Select::trajectory));
  return {
      .paths = {"poses"},
      .meaning = "The poses of the platform.",
      .chooser = "select",
      .keys = {
          {.name = "select",
           .type = "text",
           .words = {{name(Select::interior),
                      "points of a Sobol' sequence in the workspace; more poses begin with the same ones"},
                     {name(Select::file),
                      "the poses of a CSV file: a line of names, all pose coordinates or those of a chart, then a line "
                      "of numbers in SI units for each pose"},
                     {name(Select::boundary),
                      "points on the boundary of the feasible part of the workspace, uniform by area"},
                     {name(Select::grid), "the feasible points of a regular grid"},
                     {name(Select::trajectory), "poses along a curve, in the order of time"}},
           .usual = "`\"interior\"`",
           .meaning = "How poses are chosen."},
          {.name = "count",
           .type = "integer, for a grid also a table",
           .bounds = "at least 1",
           .required = true,
           .only_for = of_box,
           .meaning = "How many poses; of a grid so many of its points, or all points with a number for every pose "
                      "coordinate."},
          {.name = "workspace",
           .type = "table",
           .usual = "the model's own workspace",
           .only_for = of_box,
           .meaning = "A range for every pose coordinate."},
          {.name = "limits",
           .type = "table",
           .usual = "none",
           .only_for = of_box,
           .meaning = "Ranges of joint displacements from home; poses that leave them are rejected."},
          {.name = "max_condition",
           .type = "number",
           .bounds = "greater than 1",
           .usual = "`1e8`",
           .only_for = of_model,
           .meaning = "A pose whose condition number is above it counts as singular: it is rejected, or on a "
                      "trajectory an error."},
          {.name = "file",
           .type = "text",
           .required = true,
           .only_for = {name(Select::file)},
           .meaning = "CSV file of poses, relative to the study's folder."},
          {.name = "trajectory",
           .type = "table",
           .required = true,
           .only_for = {name(Select::trajectory)},
           .meaning = "The curve: one of the model's, or a file."},
      }};
}

StudyTable grid() {
  return {.paths = {"poses.count"},
          .meaning = "For select = \"grid\": a regular grid, of which all feasible points are poses.",
          .keys = {{.name = "COORDINATE",
                    .type = "integer",
                    .bounds = "at least 1",
                    .required = true,
                    .meaning = "Points along this pose coordinate, evenly spaced, both ends included; 1 is the "
                               "middle."}}};
}

StudyTable workspace() {
  return {.paths = {"poses.workspace"},
          .meaning = "The box in which poses are sought.",
          .keys = {{.name = "COORDINATE",
                    .type = "list of two quantities",
                    .required = true,
                    .meaning = "Lower and upper end of the range of this pose coordinate."}}};
}

StudyTable limits() {
  return {.paths = {"poses.limits"},
          .meaning = "Limits of joints.",
          .keys = {{.name = "JOINT",
                    .type = "list of two quantities",
                    .usual = "none",
                    .meaning = "Lower and upper end of the range of this joint's displacement."}}};
}

StudyTable trajectory() {
  return {.paths = {"poses.trajectory"},
          .meaning = "Exactly one of curve and file.",
          .keys = {
              {.name = "curve", .type = "text", .meaning = "Name of one of the model's curves."},
              {.name = "file",
               .type = "text",
               .meaning = "CSV file with a column t (s) and pose coordinates, SI units, relative to the study's "
                          "folder; between its points it is read by modified Akima splines, or by straight lines "
                          "where it has two or three."},
              {.name = "origin",
               .type = "list of quantities",
               .usual = "the curve's own",
               .meaning = "Where a curve lies: a value for each coordinate in which it is given. A file has none."},
              {.name = "points",
               .type = "integer",
               .bounds = "at least 2",
               .usual = "201; the file's own points where neither points nor time is given",
               .meaning = "Number of poses, evenly spaced in time."},
              {.name = "time",
               .type = "list of two times",
               .usual = "the whole curve",
               .meaning = "Start and end of the part that is taken."},
          }};
}

StudyTable errors() {
  return {.paths = {"errors"},
          .meaning = "How the errors that vary scatter about zero, by their dimension.",
          .keys = {
              {.name = "linear", .type = "table", .usual = kLinearDefault, .meaning = "Distribution of every length."},
              {.name = "angular", .type = "table", .usual = kAngularDefault, .meaning = "Distribution of every angle."},
              {.name = "override",
               .type = "table",
               .usual = "none",
               .meaning = "Single errors with a distribution of their own."},
          }};
}

StudyTable overrides() {
  return {.paths = {"errors.override"},
          .meaning = "'poesy models MODEL' lists the errors.",
          .keys = {{.name = "FACTOR",
                    .type = "table",
                    .usual = "that of its dimension",
                    .meaning = "Distribution of this error."}}};
}

StudyTable distribution() {
  const std::string_view normal = name(Shape::normal);
  const std::string_view truncated = name(Shape::truncated_normal);
  const std::string_view uniform = name(Shape::uniform);
  const std::string_view triangular = name(Shape::triangular);
  return {.paths = {"errors.linear", "errors.angular", "errors.override.FACTOR"},
          .meaning = "A distribution about zero.",
          .chooser = "distribution",
          .keys = {
              {.name = "distribution",
               .type = "text",
               .words = {{normal, "with sigma"},
                         {truncated, "with sigma, cut off at -half_width and half_width"},
                         {uniform, "between -half_width and half_width"},
                         {triangular, "likeliest at 0, down to nothing at -half_width and half_width"}},
               .required = true,
               .meaning = "Shape of the distribution."},
              {.name = "sigma",
               .type = "quantity",
               .bounds = "at least 1e-30 m or rad",
               .required = true,
               .only_for = {normal, truncated},
               .meaning = "Standard deviation, before it is cut off."},
              {.name = "half_width",
               .type = "quantity",
               .bounds = "at least 1e-30 m or rad",
               .required = true,
               .only_for = {truncated, uniform, triangular},
               .meaning = "Largest possible size of the error."},
          }};
}

std::vector<StudyKey> keys_of_several_kinds() {
  const std::string_view sensitivity = name(Kind::sensitivity);
  const std::string_view monte_carlo = name(Kind::monte_carlo);
  return {
      {.name = "kind",
       .type = "text",
       .words = {{sensitivity, "what each error does on its own"},
                 {name(Kind::identification), "which errors deform the mechanism at all"},
                 {name(Kind::evaluate), "what named cases of fixed errors do"},
                 {monte_carlo, "what all errors do together"},
                 {name(Kind::coupling), "what sources of errors do one by one and together"}},
       .usual = "`\"sensitivity\"`",
       .meaning = "The kind of study."},
      {.name = "factors",
       .type = "text or list of texts",
       .usual = "in a sensitivity study deforming, where the model has that set; else all",
       .only_for = {sensitivity, name(Kind::identification), monte_carlo},
       .may_stay = true,
       .meaning = "The errors that vary or are tried: a factor set, all, or a list of factors."},
      {.name = "samples",
       .type = "integer or table",
       .bounds = "at least 2",
       .usual = "`1000`",
       .only_for = {sensitivity, monte_carlo},
       .may_stay = true,
       .meaning = "Samples at each pose, of each varied error alone or of all together; or as many as it takes."},
      {.name = "conf_level",
       .type = "number",
       .bounds = "between 0 and 1",
       .usual = "`0.95`",
       .only_for = {sensitivity, monte_carlo},
       .may_stay = true,
       .meaning = "Level of the confidence intervals."},
      {.name = "background",
       .type = "table",
       .usual = "none",
       .only_for = {sensitivity, monte_carlo, name(Kind::evaluate)},
       .meaning = "Errors held constant while others vary; what varies, or what a case sets, is not held."},
  };
}

std::vector<StudyKey> keys_of_one_kind() {
  const std::string_view sensitivity = name(Kind::sensitivity);
  const std::string_view identification = name(Kind::identification);
  return {
      {.name = "reference",
       .type = "table",
       .usual = "the error of smallest effect, at 1 mm or 1 deg",
       .only_for = {sensitivity},
       .meaning = "The error from which tolerances of equal effect are counted, and its own tolerance."},
      {.name = "linearity",
       .type = "number",
       .bounds = "between 0 and 1",
       .usual = "`0.01`",
       .only_for = {sensitivity},
       .meaning = "With fidelity = \"both\": an error whose effects differ by no more than this share is linear."},
      {.name = "quantiles",
       .type = "list of numbers",
       .bounds = "between 0 and 1",
       .usual = "`[0.05, 0.5, 0.95]`",
       .only_for = {name(Kind::monte_carlo)},
       .meaning = "Shares of the samples that lie below, ascending."},
      {.name = "groups",
       .type = "list of tables",
       .usual = "`[{ name = \"group 1\", linear = \"1 mm\", angular = \"1 deg\" }]`",
       .only_for = {identification},
       .meaning = "The sizes at which errors are set; each group gives verdicts of its own."},
      {.name = "pose_share",
       .type = "number",
       .bounds = "between 0 and 1",
       .usual = "`0.95`",
       .only_for = {identification},
       .meaning = "The share of the poses that a verdict asks for."},
      {.name = "cases",
       .type = "list of tables",
       .required = true,
       .only_for = {name(Kind::evaluate)},
       .meaning = "Fixed errors, each case with a name."},
  };
}

std::vector<StudyKey> keys_of_limits() {
  const std::string_view monte_carlo = name(Kind::monte_carlo);
  return {
      {.name = "limits",
       .type = "table",
       .usual = "none",
       .only_for = {monte_carlo, name(Kind::evaluate)},
       .meaning =
           "Limits of responses. The run ends with PASS or FAIL for each of them, and with exit code 6 if one is "
           "not kept."},
      {.name = "judge",
       .type = "text",
       .words = {{name(Judge::rms),
                  "the response's root mean square over the draws of all poses is within the limit; "
                  "draws that were not solved are left out"},
                 {name(Judge::share),
                  "at every pose at least a share of the draws is within the limit; draws that "
                  "were not solved are not"}},
       .usual = "`\"rms\"`",
       .only_for = {monte_carlo},
       .meaning = "When a limit is kept. (In an evaluation, if each case is within it at every pose.)"},
      {.name = "share",
       .type = "number",
       .bounds = "between 0 and 1",
       .only_for = {monte_carlo},
       .meaning = "With judge = \"share\", and required there: the share of the draws."},
  };
}

std::vector<StudyKey> keys_of_coupling() {
  const std::vector<std::string_view> coupling{name(Kind::coupling)};
  return {
      {.name = "linear",
       .type = "list of lengths",
       .bounds = "greater than 0",
       .only_for = coupling,
       .meaning = "Sizes of lengths: each is a run of its own, in which every error is at once as large as that. "
                  "Required where a source has lengths; as many as of angular, if there are both."},
      {.name = "angular",
       .type = "list of angles",
       .bounds = "greater than 0",
       .only_for = coupling,
       .meaning = "Sizes of angles, in the same way."},
      {.name = "limbs",
       .type = "text or integer",
       .usual = "`\"all\"`",
       .only_for = coupling,
       .meaning = "all: errors of every limb, together; a number: of that limb alone; independent: each limb on its "
                  "own, in the worst case and the root sum square."},
      {.name = "components",
       .type = "text or list of texts",
       .usual = "`\"all\"`",
       .only_for = coupling,
       .meaning = "all: every component of an error, together; a list such as [\"x\", \"z\"]: those and scalars; "
                  "independent: each component of each error on its own, as for limbs."},
      {.name = "sources",
       .type = "list of tables",
       .usual = "those of the literature, where the model has them",
       .only_for = coupling,
       .meaning = "2 to 8 sources of errors: each alone, and every combination of them at once."},
  };
}

StudyTable analysis() {
  std::vector<StudyKey> keys = keys_of_several_kinds();
  for (const auto& more : {keys_of_one_kind(), keys_of_limits(), keys_of_coupling()})
    keys.insert(keys.end(), more.begin(), more.end());
  return {.paths = {"analysis"}, .meaning = "What is asked.", .chooser = "kind", .keys = std::move(keys)};
}

StudyTable response_limits() {
  return {.paths = {"analysis.limits"},
          .meaning = "'poesy models MODEL' lists the responses.",
          .keys = {{.name = "RESPONSE",
                    .type = "quantity",
                    .bounds = "greater than 0",
                    .usual = "none",
                    .meaning = "A value of this response is good up to here; one that has a sign, by its magnitude."}}};
}

StudyTable adaptive_samples() {
  return {.paths = {"analysis.samples"},
          .meaning = "As many samples as it takes until every interval is narrow enough.",
          .keys = {
              {.name = "min",
               .type = "integer",
               .bounds = "at least 2",
               .usual = "`1000`",
               .meaning = "Samples before the first decision."},
              {.name = "max",
               .type = "integer",
               .bounds = "at least 2",
               .required = true,
               .meaning = "The most samples at each pose."},
              {.name = "relative_error",
               .type = "number",
               .bounds = "between 0 and 1",
               .required = true,
               .meaning = "Half the width of an interval over the value it belongs to, at the most."},
              {.name = "conf_level",
               .type = "number",
               .bounds = "between 0 and 1",
               .usual = "that of [analysis]",
               .meaning = "Level of the confidence intervals, if it is not set in [analysis]."},
          }};
}

StudyTable background() {
  return {.paths = {"analysis.background"},
          .meaning = "Errors held constant.",
          .keys = {
              {.name = "factors",
               .type = "text or list of texts",
               .required = true,
               .meaning = "The errors that are held: a factor set, all, or a list of factors."},
              {.name = "linear",
               .type = "length",
               .usual = "the standard deviation of linear in [errors]",
               .meaning = "The value of those that are lengths."},
              {.name = "angular",
               .type = "angle",
               .usual = "the standard deviation of angular in [errors]",
               .meaning = "The value of those that are angles."},
          }};
}

StudyTable reference() {
  return {.paths = {"analysis.reference"},
          .meaning = "Where tolerances of equal effect begin.",
          .keys = {
              {.name = "factor", .type = "text", .required = true, .meaning = "One of the errors that vary."},
              {.name = "tolerance",
               .type = "quantity",
               .bounds = "greater than 0",
               .usual = "1 mm or 1 deg",
               .meaning = "Its tolerance, the standard deviation of a normal error."},
          }};
}

StudyTable groups() {
  return {.paths = {"analysis.groups"},
          .meaning = "For kind = \"identification\".",
          .keys = {
              {.name = "name",
               .type = "text",
               .usual = "group 1, group 2 and so on",
               .meaning = "Name of the group, without commas and quotes."},
              {.name = "linear",
               .type = "length",
               .bounds = "greater than 0",
               .required = true,
               .meaning = "Size of errors that are lengths."},
              {.name = "angular",
               .type = "angle",
               .bounds = "greater than 0",
               .required = true,
               .meaning = "Size of errors that are angles."},
          }};
}

StudyTable cases() {
  return {.paths = {"analysis.cases"},
          .meaning = "For kind = \"evaluate\".",
          .keys = {
              {.name = "name",
               .type = "text",
               .usual = "case 1, case 2 and so on",
               .meaning = "Name of the case, without commas and quotes."},
              {.name = "errors", .type = "table", .required = true, .meaning = "The errors that the case sets."},
          }};
}

StudyTable errors_of_case() {
  return {.paths = {"analysis.cases.errors"},
          .meaning = "The narrower wins. What is not set has the background's value, or is zero.",
          .keys = {
              {.name = "FACTOR", .type = "quantity", .meaning = "One error."},
              {.name = "SET", .type = "table", .meaning = "The errors of a factor set."},
              {.name = "linear", .type = "length", .meaning = "All errors that are lengths."},
              {.name = "angular", .type = "angle", .meaning = "All errors that are angles."},
          }};
}

StudyTable errors_of_set() {
  return {.paths = {"analysis.cases.errors.SET"},
          .meaning = "At least one of them.",
          .keys = {
              {.name = "linear", .type = "length", .meaning = "All errors of the set that are lengths."},
              {.name = "angular", .type = "angle", .meaning = "All errors of the set that are angles."},
          }};
}

StudyTable sources() {
  return {.paths = {"analysis.sources"},
          .meaning = "For kind = \"coupling\".",
          .keys = {
              {.name = "name",
               .type = "text",
               .usual = "source 1, source 2 and so on",
               .meaning = "Name of the source, without '+', commas and quotes."},
              {.name = "factors",
               .type = "text or list of texts",
               .required = true,
               .meaning = "Its errors: a factor set, all, or a list of factors, of which no other source has one."},
          }};
}

StudyTable solver() {
  return {
      .paths = {"solver"},
      .meaning = "How samples are solved, and what becomes of those that are not.",
      .keys = {
          {.name = "metric",
           .type = "text",
           .words = {{"platform",
                      "by how far points of the platform are moved: a length, whatever the unit and the "
                      "frame"},
                     {"published", "as in the paper: radians against metres, at the base's origin"}},
           .usual = "`\"published\"`",
           .meaning = "How mismatch of angle is weighed against mismatch of position where limbs work against each "
                      "other; only for models that have such a mismatch."},
          {.name = "points",
           .type = "list of lists of lengths",
           .usual = "where the limbs hold the platform",
           .meaning = "Points [x, y, z] in the platform's frame for metric = \"platform\", three or more that are "
                      "not on a line."},
          {.name = "method",
           .type = "text",
           .words = {{name(Method::newton), "the model's own, fast and far-reaching"},
                     {name(Method::gauss_newton), "as published: slower, and more samples do not converge"}},
           .usual = "`\"newton\"`",
           .meaning = "The iteration."},
          {.name = "tolerance",
           .type = "number",
           .bounds = "greater than 0",
           .usual = "`1e-15`; with metric = \"platform\" `1e-14`",
           .meaning = "Converged: the residual's largest change (rad, m) in one iteration is below this; with metric "
                      "= \"platform\" its length is below this share of the mechanism's reach."},
          {.name = "max_iterations",
           .type = "integer",
           .bounds = "at least 1",
           .usual = "`50`",
           .meaning = "Iterations after which a sample counts as not converged."},
          {.name = "not_converged",
           .type = "text",
           .words = {{name(NotConverged::exclude), "they are left out of all statistics"},
                     {name(NotConverged::include), "the last iterate counts"},
                     {"fail", "exclude, with max_not_converged = 0"}},
           .usual = "`\"exclude\"`",
           .meaning = "What becomes of samples that did not converge."},
          {.name = "max_not_converged",
           .type = "number",
           .bounds = "from 0 to 1",
           .usual = "`1`",
           .meaning = "Share of all samples; if more fail, the run ends with exit code 5, its result kept."},
      }};
}

StudyTable run() {
  return {.paths = {"run"},
          .meaning = "Nothing here depends on the machine.",
          .keys = {{.name = "seed",
                    .type = "integer",
                    .bounds = "at least 0",
                    .usual = "`1`",
                    .meaning = "The same seed gives the same bits on any number of threads."}}};
}

}  // namespace

const std::vector<StudyTable>& study_tables() {
  static const std::vector<StudyTable> tables{
      file_itself(),     mechanism(),        geometry(),   poses(),     grid(),         workspace(),
      limits(),          trajectory(),       errors(),     overrides(), distribution(), analysis(),
      response_limits(), adaptive_samples(), background(), reference(), groups(),       cases(),
      errors_of_case(),  errors_of_set(),    sources(),    solver(),    run()};
  return tables;
}

}  // namespace poesy
