#include "engine/kinds/sobol/kind.h"
#include "engine/kinds/sobol/result.h"
#include "engine/report/display.h"
#include "engine/result/result_parts.h"

namespace poesy {
namespace {

const std::vector<Attribute<SobolIndices>> kLevel{{"conf_level", &SobolIndices::conf_level}};

/// S1 and ST with their intervals along these axes.
Group<SobolIndices> indices_group(std::string path, std::string description, const Axes& axes) {
  return {std::move(path),
          std::move(description),
          kLevel,
          {},
          {{"S1", &SobolIndices::S1, axes, "1",
            "First-order index: the share of the variance that the error makes alone; of several errors their closed "
            "index. NaN where the response has no variance, and for a group with errors that are correlated with "
            "errors of others"},
           {"S1_ci_low", &SobolIndices::S1_ci_low, axes, "1", "Lower end of the interval of S1"},
           {"S1_ci_high", &SobolIndices::S1_ci_high, axes, "1", "Upper end of the interval of S1"},
           {"ST", &SobolIndices::ST, axes, "1",
            "Total index: the share of the variance that would be left if all others were perfect"},
           {"ST_ci_low", &SobolIndices::ST_ci_low, axes, "1", "Lower end of the interval of ST"},
           {"ST_ci_high", &SobolIndices::ST_ci_high, axes, "1", "Upper end of the interval of ST"}}};
}

/// The axis of what the indices belong to: the errors, or the groups to which the study joins them.
std::string axis_of(bool joined) { return joined ? "group" : "factor"; }

const std::string kVaries =
    "0 where it does not vary: what its samples scatter at any pose is rounding, so nothing has a share of it; "
    "left out where all vary";

/// The datasets of a result whose errors are joined, or not.
struct Layout {
  explicit Layout(bool joined)
      : axis(axis_of(joined)),
        at_poses(indices_group("/sobol", "Sobol' indices of each response at each pose", {"response", axis, "pose"})),
        aggregated(indices_group("/sobol/aggregated",
                                 "The same over the poses together: the sum of an error's parts of the variances at "
                                 "all poses, over the sum of the variances",
                                 {"response", axis})),
        of_vectors(indices_group("/sobol/vector",
                                 "Generalised indices of vectors with signs over the poses together: as aggregated, of "
                                 "the sums over a vector's components (Gamboa, Janon, Klein and Lagnoux 2014)",
                                 {"vector", axis})),
        beside{
            {"n", &SobolResult::n, {"response", axis, "pose"}, "1", "Pairs of samples behind S1 and ST, both solved"},
            {"mean", &SobolResult::mean, kByResponsePose, kResponseUnit, "Mean of the response over the samples"},
            {"variance", &SobolResult::variance, kByResponsePose, "SI: square of the response unit",
             "Variance of the response that S1 and ST share"},
            {"without_sign", &SobolResult::without_sign, kByResponse, "1",
             "1 where no sample was below zero: such a response, the length of a vector for instance, is not "
             "additive even where the vector is linear"},
            {"varies", &SobolResult::varies, kByResponse, "1", kVaries, Presence::where_computed}},
        beside_vectors{{"varies", &SobolResult::vector_varies, {"vector"}, "1", kVaries, Presence::where_computed}},
        pairs{
            {"S2",
             &SobolResult::S2,
             {"response", axis, "other"},
             "1",
             "Second-order index: the closed index of two together without those of each; NaN on the diagonal"},
            {"S2_ci_low", &SobolResult::S2_ci_low, {"response", axis, "other"}, "1", "Lower end of the interval of S2"},
            {"S2_ci_high",
             &SobolResult::S2_ci_high,
             {"response", axis, "other"},
             "1",
             "Upper end of the interval of S2"}},
        effects{{"Sh",
                 &SobolResult::Sh,
                 {"response", axis},
                 "1",
                 "Shapley effect: the share of the variance, what is made together divided evenly; all add up to 1, "
                 "also where errors are correlated"},
                {"Sh_ci_low", &SobolResult::Sh_ci_low, {"response", axis}, "1", "Lower end of the interval of Sh"},
                {"Sh_ci_high", &SobolResult::Sh_ci_high, {"response", axis}, "1", "Upper end of the interval of Sh"}} {}

  std::string axis;
  Group<SobolIndices> at_poses;
  Group<SobolIndices> aggregated;
  Group<SobolIndices> of_vectors;
  Fields<SobolResult> beside;
  Fields<SobolResult> beside_vectors;
  Fields<SobolResult> pairs;
  Fields<SobolResult> effects;
};

const CourseWords kConvergence = convergence_words(kByResponse, "ST", "1", "Largest aggregated ST of any error",
                                                   "Samples went on until, at a milestone, half of no interval of an "
                                                   "aggregated ST was more than relative_error of the "
                                                   "largest ST, for each response of the headline, or max was there",
                                                   "errors");

/// Either of the two.
const Layout& layout(bool joined) {
  static const Layout kOfErrors(false);
  static const Layout kOfGroups(true);
  return joined ? kOfGroups : kOfErrors;
}

void add_axes(ResultBuilder& result, const SobolResult& found) {
  if (found.joined) {
    result.add_axis("group", found.group_names, {"1", "Errors that are taken together"});
  }
  if (!found.vectors.empty()) {
    result.add_axis("vector", found.vectors, {"1", "Vectors with signs whose components have one unit"});
  }
  if (!found.S2.empty()) result.add_axis("other", found.group_names, {"1", "The second of a pair"});
}

void write(ResultBuilder& result, const Study& study, std::any& any) {
  const auto& found = std::any_cast<const SobolResult&>(any);
  const Layout& rows = layout(found.joined);
  add_names(result, study, study.analysis.factors);
  add_sigma(result, study);
  add_axes(result, found);
  write_group(result, rows.at_poses, found.at_poses);
  write_fields(result, rows.at_poses.path, rows.beside, found);
  write_group(result, rows.aggregated, found.aggregated);
  if (!found.S2.empty()) {
    write_fields(result, rows.aggregated.path, rows.pairs, found);
    result.show_axes(rows.aggregated.path, rows.pairs.front().axes);
  }
  if (!found.Sh.empty()) write_fields(result, rows.aggregated.path, rows.effects, found);
  if (!found.vectors.empty()) {
    write_group(result, rows.of_vectors, found.of_vectors);
    write_fields(result, rows.of_vectors.path, rows.beside_vectors, found);
  }
  if (found.joined) {
    result.add("/sobol/members", {"group"}, found.group_members, {"1", "Errors of the group, with blanks between"});
  }
  add_convergence(result, kConvergence, found.convergence);
  add_solver(result, kByPose, found.solves);
  add_failures(result, found.failures, {std::string(kAllFactors)}, found.failed_samples);
}

void read(const h5::File& file, StoredResult& result) {
  SobolResult found;
  read_sigma(file, result);
  found.responses = axis_length(file, "response");
  found.poses = axis_length(file, "pose");
  found.joined = file.exists("/group");
  if (file.exists("/vector")) found.vectors = file.read<std::string>("/vector");
  const Layout& rows = layout(found.joined);
  found.group_names = found.joined ? file.read<std::string>("/group") : texts(result.factors, &NamedUnit::name);
  found.group_members = found.joined ? read_along<std::string>(file, "/sobol/members", {"group"}) : found.group_names;
  check_names(found.group_names, "/group");
  check_names(found.vectors, "/vector");
  read_group(file, rows.at_poses, found.at_poses);
  read_fields(file, rows.at_poses.path, rows.beside, found);
  read_group(file, rows.aggregated, found.aggregated);
  const auto read_if_computed = [&](const Fields<SobolResult>& fields) {
    if (file.exists(rows.aggregated.path + "/" + fields.front().name)) {
      read_fields(file, rows.aggregated.path, fields, found);
    }
  };
  read_if_computed(rows.pairs);
  read_if_computed(rows.effects);
  if (!found.vectors.empty()) {
    read_group(file, rows.of_vectors, found.of_vectors);
    read_fields(file, rows.of_vectors.path, rows.beside_vectors, found);
  }
  result.constant = constant_responses(found.varies);
  found.solves = read_solver(file, kByPose);
  result.convergence = read_convergence(file, kConvergence);
  // Only random draws have addresses by which a sample can be solved again.
  if (study_setting(result.study_text, "analysis", "design") == "\"random\"")
    result.varied = {std::string(kAllFactors)};
  result.failures = read_failures(file, result);
  result.found = std::move(found);
}

/// Appends the index NAME and NAME_conf, half its interval, as SALib calls them.
void append_salib_columns(CsvTable& table, const std::string& name, const std::vector<double>& value,
                          const std::vector<double>& low, const std::vector<double>& high, std::size_t first) {
  table.columns.push_back(list_column(name, value, first));
  table.columns.push_back({name + "_conf", [&low, &high, first](std::size_t line) {
                             return 0.5 * (high[first + line] - low[first + line]);
                           }});
}

/// Lines of the groups, with columns for the indices of one quantity.
CsvTable indices_table(const StoredResult& result, std::string name, const Group<SobolIndices>& rows,
                       const SobolIndices& found, std::size_t quantity) {
  const SobolResult& all = sobol_of(result);
  const std::size_t groups = all.groups();
  CsvTable table{std::move(name), {axis_of(all.joined), [&](std::size_t g) { return all.group_names[g]; }}, groups};
  const std::size_t first = quantity * groups;
  append_salib_columns(table, "S1", found.S1, found.S1_ci_low, found.S1_ci_high, first);
  append_salib_columns(table, "ST", found.ST, found.ST_ci_low, found.ST_ci_high, first);
  for (const FieldRow<SobolIndices>& row : rows.fields) {
    if (row.name.ends_with("_low") || row.name.ends_with("_high")) {
      table.columns.push_back(field_column(row.name, row, found, first));
    }
  }
  return table;
}

/// Columns for the Shapley effects on one response.
void append_shapley(CsvTable& table, const SobolResult& found, std::size_t r) {
  const std::size_t first = r * found.groups();
  append_salib_columns(table, "Sh", found.Sh, found.Sh_ci_low, found.Sh_ci_high, first);
  table.columns.push_back(list_column("Sh_ci_low", found.Sh_ci_low, first));
  table.columns.push_back(list_column("Sh_ci_high", found.Sh_ci_high, first));
}

/// A table for each index at the poses, with a column for each of them.
void append_pose_tables(CsvTables& tables, const StoredResult& result) {
  const SobolResult& found = sobol_of(result);
  const std::size_t groups = found.groups();
  for (const FieldRow<SobolIndices>& row : layout(found.joined).at_poses.fields) {
    for (std::size_t r = 0; r < found.responses; ++r) {
      CsvTable table{"sobol_" + row.name + "_" + result.responses[r].name,
                     {axis_of(found.joined), [&](std::size_t g) { return found.group_names[g]; }},
                     groups};
      table.at_poses = pose_columns<SobolIndices>(result, row, found.at_poses, r * groups * found.poses, "1");
      tables.push_back(std::move(table));
    }
  }
}

/// Each pair of groups on a line.
CsvTable pairs_table(const StoredResult& result, std::size_t r) {
  const SobolResult& found = sobol_of(result);
  const std::size_t groups = found.groups();
  CsvTable table{"sobol_pairs_" + result.responses[r].name,
                 {"pair",
                  [&found, groups](std::size_t line) {
                    return found.group_names[line / groups] + " & " + found.group_names[line % groups];
                  }},
                 groups * groups};
  table.has = [groups](std::size_t line) { return line / groups < line % groups; };
  for (const FieldRow<SobolResult>& row : layout(found.joined).pairs) {
    table.columns.push_back(field_column(row.name, row, found, r * groups * groups));
  }
  return table;
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  const SobolResult& found = sobol_of(result);
  const Layout& rows = layout(found.joined);
  append_sigma_tables(tables, result);
  for (std::size_t r = 0; r < found.responses; ++r) {
    CsvTable table = indices_table(result, "sobol_" + result.responses[r].name, rows.aggregated, found.aggregated, r);
    if (!found.Sh.empty()) append_shapley(table, found, r);
    tables.push_back(std::move(table));
  }
  for (std::size_t v = 0; v < found.vectors.size(); ++v) {
    tables.push_back(indices_table(result, "sobol_vector_" + found.vectors[v], rows.of_vectors, found.of_vectors, v));
  }
  append_pose_tables(tables, result);
  for (std::size_t r = 0; r < found.responses && !found.S2.empty(); ++r) tables.push_back(pairs_table(result, r));
  CsvTable solves = lines_of_poses(result, "not_converged");
  append_solve_columns(solves, found.solves);
  tables.push_back(std::move(solves));
  tables.push_back(failure_table(result));
  append_convergence_tables(tables, result, kConvergence);
}

}  // namespace

constinit const FileKind kSobolFile{.write = write, .read = read, .append_tables = append_tables};

}  // namespace poesy
