#include <algorithm>
#include <array>
#include <memory>

#include "engine/kinds/sobol/groups.h"
#include "engine/kinds/sobol/kind.h"
#include "engine/kinds/sobol/result.h"
#include "engine/report/display.h"
#include "engine/result/result_parts.h"

namespace poesy::sobol {
namespace {

/// The name of the axis of indices in a file: that of errors, or that of the groups into which the study joins errors.
std::string axis_of(bool joined) { return joined ? "group" : "factor"; }

/// The fields, with their axis "group" renamed by axis_of().
template <class Found>
Fields<Found> along(bool joined, Fields<Found> rows) {
  for (FieldRow<Found>& row : rows) std::ranges::replace(row.axes, std::string("group"), axis_of(joined));
  return rows;
}

/// The fields of shares of the variance, and of the ends of their intervals.
template <class Shares>
Fields<Shares> share_rows(bool joined, const std::string& name, std::string meaning) {
  return along<Shares>(joined, {{name, &Shares::value, "1", std::move(meaning)},
                                {name + "_ci_low", &Shares::ci_low, "1", "Lower end of the interval of " + name},
                                {name + "_ci_high", &Shares::ci_high, "1", "Upper end of the interval of " + name}});
}

/// The fields of first-order and total indices, as a group of the file.
template <NamedAxis... Axes>
struct IndexRows {
  IndexRows(bool joined, std::string path, std::string description)
      : group{.path = std::move(path),
              .description = std::move(description),
              .attributes = {{"conf_level", &SobolIndices<Axes...>::conf_level}},
              .fields = {}},
        S1(share_rows<Shares<Axes...>>(
            joined, "S1",
            "First-order index: the share of the variance that the error makes alone; of several errors their closed "
            "index. NaN where the response has no variance, and for a group with errors that are correlated with "
            "errors of others")),
        ST(share_rows<Shares<Axes...>>(
            joined, "ST", "Total index: the share of the variance that would be left if all others were perfect")) {}

  Group<SobolIndices<Axes...>> group;
  Fields<Shares<Axes...>> S1;
  Fields<Shares<Axes...>> ST;
};

template <class Rows, class Found>
void write_indices(ResultBuilder& result, const Rows& rows, const Found& found) {
  write_group(result, rows.group, found);
  write_fields(result, rows.group.path, rows.S1, found.S1);
  write_fields(result, rows.group.path, rows.ST, found.ST);
  result.show_axes(rows.group.path, rows.S1.front().axes);
}

template <class Rows, class Found>
void read_indices(const h5::File& file, const Rows& rows, Found& found) {
  read_group(file, rows.group, found);
  read_fields(file, rows.group.path, rows.S1, found.S1);
  read_fields(file, rows.group.path, rows.ST, found.ST);
}

const std::string kVaries =
    "0 where it does not vary: what its samples scatter at any pose is rounding, so nothing has a share of it; "
    "left out where all vary";

/// The datasets of a result. The name of their axis of errors or groups depends on whether errors are joined.
struct Layout {
  explicit Layout(bool joined)
      : at_poses(joined, "/sobol", "Sobol' indices of each response at each pose"),
        aggregated(joined, "/sobol/aggregated",
                   "The same over the poses together: the sum of an error's parts of the variances at all poses, over "
                   "the sum of the variances"),
        of_vectors(joined, "/sobol/vector",
                   "Generalised indices of vectors with signs over the poses together: as aggregated, of the sums over "
                   "a vector's components (Gamboa, Janon, Klein and Lagnoux 2014)"),
        beside(along<Result>(
            joined, {{"n", &Result::n, "1", "Pairs of samples behind S1 and ST, both solved"},
                     {"mean", &Result::mean, kResponseUnit, "Mean of the response over the samples"},
                     {"variance", &Result::variance, "SI: square of the response unit",
                      "Variance of the response that S1 and ST share"},
                     {"without_sign", &Result::without_sign, "1",
                      "1 where no sample was below zero: such a response, the length of a vector for instance, is not "
                      "additive even where the vector is linear"},
                     {"varies", &Result::varies, "1", kVaries, Presence::where_computed}})),
        beside_vectors{{"varies", &Result::vector_varies, "1", kVaries, Presence::where_computed}},
        pairs(share_rows<decltype(Result::S2)>(
            joined, "S2",
            "Second-order index: the closed index of two together without those of each; NaN on the diagonal")),
        effects(share_rows<decltype(Result::Sh)>(
            joined, "Sh",
            "Shapley effect: the share of the variance, what is made together divided evenly; all add up to 1, also "
            "where errors are correlated")) {}

  IndexRows<axis::Response, axis::ErrorGroup, axis::Pose> at_poses;
  IndexRows<axis::Response, axis::ErrorGroup> aggregated;
  IndexRows<axis::SignedVector, axis::ErrorGroup> of_vectors;
  Fields<Result> beside;
  Fields<Result> beside_vectors;
  Fields<Shares<axis::Response, axis::ErrorGroup, axis::OtherGroup>> pairs;
  Fields<Shares<axis::Response, axis::ErrorGroup>> effects;
};

const CourseWords kConvergence = convergence_words(kByResponse, "ST", "1", "Largest aggregated ST of any error",
                                                   "Samples went on until, at a milestone, half of no interval of an "
                                                   "aggregated ST was more than relative_error of the "
                                                   "largest ST, for each response of the headline, or max was there",
                                                   "errors");

/// The layout for joined errors or for single errors.
const Layout& layout(bool joined) {
  static const Layout kOfErrors(false);
  static const Layout kOfGroups(true);
  return joined ? kOfGroups : kOfErrors;
}

void add_axes(ResultBuilder& result, const Result& found) {
  if (found.joined) {
    result.add_axis("group", found.group_names, {"1", "Errors that are taken together"});
  }
  if (!found.vectors.empty()) {
    result.add_axis("vector", found.vectors, {"1", "Vectors with signs whose components have one unit"});
  }
  if (!found.S2.empty()) result.add_axis("other", found.group_names, {"1", "The second of a pair"});
}

void write(ResultBuilder& result, const Study& study, std::any& any) {
  const auto& found = std::any_cast<const Result&>(any);
  const Layout& rows = layout(found.joined);
  add_names(result, study, study.analysis.factors);
  add_sigma(result, study);
  add_axes(result, found);
  write_indices(result, rows.at_poses, found.at_poses);
  write_fields(result, rows.at_poses.group.path, rows.beside, found);
  write_indices(result, rows.aggregated, found.aggregated);
  const std::string& aggregated = rows.aggregated.group.path;
  if (!found.S2.empty()) {
    write_fields(result, aggregated, rows.pairs, found.S2);
    result.show_axes(aggregated, rows.pairs.front().axes);
  }
  if (!found.Sh.empty()) write_fields(result, aggregated, rows.effects, found.Sh);
  if (!found.vectors.empty()) {
    write_indices(result, rows.of_vectors, found.of_vectors);
    write_fields(result, rows.of_vectors.group.path, rows.beside_vectors, found);
  }
  if (found.joined) {
    result.add("/sobol/members", {"group"}, found.group_members, {"1", "Errors of the group, with blanks between"});
  }
  add_convergence(result, kConvergence, found.convergence);
  add_solver(result, kByPose, found.solves);
  add_failures(result, found.failures, {std::string(kAllFactors)}, found.failed_samples);
}

void read(const h5::File& file, StoredResult& result) {
  Result found;
  read_sigma(file, result);
  found.joined = file.exists("/group");
  if (file.exists("/vector")) found.vectors = file.read<std::string>("/vector");
  const Layout& rows = layout(found.joined);
  found.group_names = found.joined ? file.read<std::string>("/group") : texts(result.factors, &NamedUnit::name);
  found.group_members = found.joined ? read_along<std::string>(file, "/sobol/members", {"group"}) : found.group_names;
  check_names(found.group_names, "/group");
  check_names(found.vectors, "/vector");
  read_indices(file, rows.at_poses, found.at_poses);
  read_fields(file, rows.at_poses.group.path, rows.beside, found);
  read_indices(file, rows.aggregated, found.aggregated);
  const auto read_if_computed = [&](const auto& fields, auto& shares) {
    const std::string& path = rows.aggregated.group.path;
    if (file.exists(path + "/" + fields.front().name)) read_fields(file, path, fields, shares);
  };
  read_if_computed(rows.pairs, found.S2);
  read_if_computed(rows.effects, found.Sh);
  if (!found.vectors.empty()) {
    read_indices(file, rows.of_vectors, found.of_vectors);
    read_fields(file, rows.of_vectors.group.path, rows.beside_vectors, found);
  }
  result.constant = constant_responses(found.varies);
  found.solves = read_solver(file, kByPose);
  result.convergence = read_convergence(file, kConvergence);
  // Samples of designs that are not random cannot be drawn again by pose and number, so they cannot be replayed.
  if (study_setting(result.study_text, "analysis", "design") == "\"random\"")
    result.varied = {std::string(kAllFactors)};
  result.failures = read_failures(file, result);
  result.found = std::move(found);
}

/// A table with a line for each error or group.
CsvTable lines_of_groups(const Result& found, std::string name) {
  return {
      std::move(name), {axis_of(found.joined), [&](std::size_t g) { return found.group_names[g]; }}, found.groups()};
}

/// Adds to the table an index NAME, and half the width of its interval as NAME_conf, as SALib names them. row: position
/// of the quantity.
template <class Shares>
void append_salib_columns(CsvTable& table, const std::string& name, const Shares& shares, std::size_t row) {
  table.columns.push_back(list_column(name, shares.value.row(row)));
  table.columns.push_back({name + "_conf", [low = shares.ci_low.row(row), high = shares.ci_high.row(row)](
                                               std::size_t g) { return 0.5 * (high[g] - low[g]); }});
}

template <class Shares>
void append_interval_columns(CsvTable& table, const std::string& name, const Shares& shares, std::size_t row) {
  table.columns.push_back(list_column(name + "_ci_low", shares.ci_low.row(row)));
  table.columns.push_back(list_column(name + "_ci_high", shares.ci_high.row(row)));
}

/// A table with a line for each error or group, and columns for the indices of one quantity (a response or a vector).
template <class Indices>
CsvTable indices_table(const Result& result, std::string name, const Indices& found, std::size_t quantity) {
  CsvTable table = lines_of_groups(result, std::move(name));
  append_salib_columns(table, "S1", found.S1, quantity);
  append_salib_columns(table, "ST", found.ST, quantity);
  append_interval_columns(table, "S1", found.S1, quantity);
  append_interval_columns(table, "ST", found.ST, quantity);
  return table;
}

/// Adds to `tables` a table for each index at the poses and for each end of its interval, with a column for each pose.
template <class Shares>
void append_pose_tables(CsvTables& tables, const StoredResult& result, const Fields<Shares>& rows,
                        const Shares& shares) {
  const std::array lists{&shares.value, &shares.ci_low, &shares.ci_high};
  for (std::size_t k = 0; k < lists.size(); ++k) {
    for (std::size_t r = 0; r < result.responses.size(); ++r) {
      CsvTable table = lines_of_groups(sobol_of(result), "sobol_" + rows[k].name + "_" + result.responses[r].name);
      table.at_poses = pose_columns(*lists[k], "1", r);
      tables.push_back(std::move(table));
    }
  }
}

/// A table with a line for each pair of groups.
CsvTable pairs_table(const StoredResult& result, std::size_t r) {
  const Result& found = sobol_of(result);
  const auto pairs = std::make_shared<const std::vector<GroupPair>>(group_pairs(found.groups()));
  CsvTable table{"sobol_pairs_" + result.responses[r].name,
                 {"pair",
                  [&found, pairs](std::size_t line) {
                    const auto [i, j] = (*pairs)[line];
                    return found.group_names[i] + " & " + found.group_names[j];
                  }},
                 pairs->size()};
  const auto append = [&](std::string name, const auto& values) {
    table.columns.push_back({std::move(name), [&values, pairs, r](std::size_t line) {
                               const auto [i, j] = (*pairs)[line];
                               return values(r, i, j);
                             }});
  };
  append("S2", found.S2.value);
  append("S2_ci_low", found.S2.ci_low);
  append("S2_ci_high", found.S2.ci_high);
  return table;
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  const Result& found = sobol_of(result);
  const Layout& rows = layout(found.joined);
  append_sigma_tables(tables, result);
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    CsvTable table = indices_table(found, "sobol_" + result.responses[r].name, found.aggregated, r);
    if (!found.Sh.empty()) {
      append_salib_columns(table, "Sh", found.Sh, r);
      append_interval_columns(table, "Sh", found.Sh, r);
    }
    tables.push_back(std::move(table));
  }
  for (std::size_t v = 0; v < found.vectors.size(); ++v) {
    tables.push_back(indices_table(found, "sobol_vector_" + found.vectors[v], found.of_vectors, v));
  }
  append_pose_tables(tables, result, rows.at_poses.S1, found.at_poses.S1);
  append_pose_tables(tables, result, rows.at_poses.ST, found.at_poses.ST);
  for (std::size_t r = 0; r < result.responses.size() && !found.S2.empty(); ++r) {
    tables.push_back(pairs_table(result, r));
  }
  CsvTable solves = lines_of_poses(result, "not_converged");
  append_solve_columns(solves, found.solves);
  tables.push_back(std::move(solves));
  tables.push_back(failure_table(result));
  append_convergence_tables(tables, result, kConvergence);
}

}  // namespace

std::size_t sobol_bytes(const AxisLengths& lengths) {
  const Layout& rows = layout(true);
  const auto both = [&](const auto& indices) { return bytes_of(indices.S1, lengths) + bytes_of(indices.ST, lengths); };
  return both(rows.at_poses) + both(rows.aggregated) + both(rows.of_vectors) + bytes_of(rows.beside, lengths) +
         bytes_of(rows.pairs, lengths) + bytes_of(rows.effects, lengths);
}

constinit const FileKind kFile{.write = write, .read = read, .append_tables = append_tables};

}  // namespace poesy::sobol
