#include <algorithm>
#include <map>
#include <utility>

#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/coupling/kind.h"
#include "engine/result/result_parts.h"
#include "engine/stats/indices.h"

namespace poesy::coupling {
namespace {

const Group<Result> kCoupling{
    "/coupling",
    "Single and coupled error sources (San et al. 2023, Section 5.2)",
    {},
    {},
    {{"effect", &Result::effect, kResponseUnit, "All errors of the subset's sources at once"},
     {"sum", &Result::sum, kResponseUnit, "Sum over the sources of the effect of each alone"},
     {"interaction", &Result::interaction, kResponseUnit, "effect - sum"},
     {"first_order_sum", &Result::first_order_sum, kResponseUnit,
      "Sum over the sources' blocks of |effect of the block alone|; errors of a block move together",
      Presence::where_computed},
     {"worst_case", &Result::worst_case, kResponseUnit,
      "Largest |response| that was found with either sign of each block: the signs of the first-order sum solved, then "
      "block by block until no flip is worse; no bound. NaN where no combination of signs is solved",
      Presence::where_computed},
     {"root_sum_square", &Result::root_sum_square, kResponseUnit, "Root of the sum of the squares of these"},
     {"cancellation", &Result::cancellation, "1",
      "1 - |sum| / sum of |effect of a source|: 0 no source opposes another, 1 they cancel"},
     {"rounding", &Result::rounding, kResponseUnit,
      "Up to this an effect of errors of the size cannot be told from the rounding of solves",
      Presence::where_computed},
     {"corners", &Result::corners, "1", "Combinations of signs that were tried for worst_case",
      Presence::where_computed},
     {"unsolved_corners", &Result::unsolved_corners, "1",
      "Of these, those that have no solution: machines that cannot be assembled", Presence::where_computed},
     {"count", &Result::count, "1", "Poses that count: those where all that the subset rests on is solved"},
     {"effect_max", &Result::effect_max, kResponseUnit, "Largest |effect| over the poses that count"},
     {"effect_max_pose", &Result::effect_max_pose, "1", "First pose of the largest |effect|; -1: there is none"},
     {"interaction_max", &Result::interaction_max, kResponseUnit, "Largest |interaction| over the poses that count"},
     {"first_order_sum_max", &Result::first_order_sum_max, kResponseUnit,
      "Largest first-order sum over the poses that count", Presence::where_computed},
     {"worst_case_max", &Result::worst_case_max, kResponseUnit, "Largest worst case over all poses",
      Presence::where_computed},
     {"worst_case_max_pose", &Result::worst_case_max_pose, "1",
      "First pose of the largest worst case; -1: there is none", Presence::where_computed},
     {"root_sum_square_max", &Result::root_sum_square_max, kResponseUnit,
      "Largest root sum square over the poses that count"},
     {"opposed_share", &Result::opposed_share, "1",
      "Share of the poses that count where |sum| is below the largest |effect of a source|"},
     {"cancellation_max", &Result::cancellation_max, "1", "Largest cancellation over the poses that count"},
     {"cancellation_max_pose", &Result::cancellation_max_pose, "1",
      "First pose of the largest cancellation; -1: there is none"},
     {"worst_case_signs", &Result::worst_case_signs, "1",
      "Sign of each error at the largest worst case; 0 where the error is zero", Presence::where_computed},
     {"unsolved_pose", &Result::unsolved_pose, "1",
      "First pose with a combination of signs that has no solution; -1: there is none", Presence::where_computed},
     {"unsolved_signs", &Result::unsolved_signs, "1",
      "Sign of each error of the first such combination; 0 where the error is zero", Presence::where_computed}}};

const Fields<Result> kSizes{
    {"size_linear", &Result::linear, "m", "Size of errors that are lengths; NaN where there is none"},
    {"size_angular", &Result::angular, "rad", "Size of errors that are angles; NaN where there is none"}};

/// [subsets x sources] 1 if the source is in the subset, otherwise 0.
std::vector<std::uint8_t> members(std::size_t sources) {
  std::vector<std::uint8_t> list;
  for (const std::vector<std::size_t>& subset : source_subsets(sources)) {
    for (std::size_t s = 0; s < sources; ++s) list.push_back(std::ranges::binary_search(subset, s) ? 1 : 0);
  }
  return list;
}

/// Writes to the result file, for each error, the index of its source and the index of its block in this source. The
/// errors of a block have the same sign.
void add_membership(ResultBuilder& result, const Study& study) {
  const Options& coupling = asked_of<Options>(study.analysis);
  std::map<FactorIndex, std::pair<std::size_t, std::size_t>> places;
  for (std::size_t s = 0; s < coupling.sources.size(); ++s) {
    const auto blocks = error_blocks(coupling.sources[s], coupling.pattern, study.model());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      for (const FactorIndex factor : blocks[b]) places[factor] = {s, b};
    }
  }
  std::vector<std::uint64_t> source, block;
  for (const FactorIndex factor : study.analysis.factors) {
    source.push_back(places.at(factor).first);
    block.push_back(places.at(factor).second);
  }
  result.add("/coupling/factor_source", {"factor"}, source, {"1", "Source of the error, by its position from 0"});
  result.add("/coupling/factor_block", {"factor"}, block,
             {"1", "Block of its source that the error belongs to, from 0; errors of a block move together"});
}

/// Writes to the result file the sizes of the errors, the sources in each subset, and the source of each error.
void add_choices(ResultBuilder& result, const Study& study, const Result& found) {
  write_fields(result, "/coupling", kSizes, found);
  result.add("/coupling/subset_sources", {"subset", "source"}, members(found.sources.size()),
             {"1", "1: the source is in the subset"});
  add_membership(result, study);
  result.show_axes("/coupling", {"source", "factor"});
}

/// The layout of tables with a line for each size, subset and pose. In a table with a line for each error, errors take
/// the place of poses.
using SubsetLines = AxisLayout<axis::Size, axis::Subset, axis::Pose>;

/// Appends columns with the sizes of the errors to the table.
void append_size_columns(CsvTable& table, const Result& found, const SubsetLines& lines) {
  const auto append = [&](std::string heading, const Array<double, axis::Size>& sizes) {
    table.columns.push_back(
        {std::move(heading), [&sizes, lines](std::size_t line) { return sizes(lines.positions(line)[0]); }});
  };
  append("size_linear [m]", found.linear);
  append("size_angular [rad]", found.angular);
}

/// A table with `repeated` lines for each size and subset, and with columns for the subset and the sizes.
CsvTable subset_table(const StoredResult& result, const std::string& name, std::size_t repeated) {
  const Result& found = coupling_of(result);
  const SubsetLines lines({found.size_names.size(), found.subsets.size(), repeated});
  CsvTable table{name,
                 {"subset", [&found, lines](std::size_t line) { return found.subsets[lines.positions(line)[1]]; }},
                 lines.elements()};
  append_size_columns(table, found, lines);
  return table;
}

/// Adds to the table a column for each response and each field of the type AnArray. The field `sum` is left out,
/// because it follows from effect and interaction.
template <class AnArray>
void append_response_columns(CsvTable& table, const StoredResult& result) {
  const Result& found = coupling_of(result);
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    for (const FieldRow<Result>& field : kCoupling.fields) {
      if (field.axes != AnArray::axis_names() || field.name == "sum") continue;
      if (field.name.starts_with("worst_case") && !has_worst_cases(found)) continue;
      const std::string name = response.name + "_" + (field.name == "count" ? "poses" : field.name);
      table.columns.push_back(
          field_row_column(with_unit(name, csv_unit(field.unit, result, &response)), field, found, r));
    }
  }
}

CsvTable curve_table(const StoredResult& result) {
  const std::size_t poses = result.poses.size();
  const Result& found = coupling_of(result);
  CsvTable table = subset_table(result, "coupling", poses);
  table.columns.push_back({"pose", [poses](std::size_t line) { return to_number(line % poses); }});
  if (!result.time.empty()) {
    table.columns.push_back({"time [s]", [&, poses](std::size_t line) { return result.time[line % poses]; }});
  }
  for (const FieldRow<Result>& field : kCoupling.fields) {
    if (field.axes == found.corners.axis_names() && has_worst_cases(found)) {
      table.columns.push_back(field_column(field.name, field, found));
    }
  }
  append_response_columns<Result::Curves>(table, result);
  return table;
}

/// A table with the sign of each error at the worst cases, and at the first corner that is not solved.
CsvTable corner_table(const StoredResult& result) {
  const std::size_t errors = result.factors.size();
  CsvTable table = subset_table(result, "coupling_corners", errors);
  table.columns.push_back({"error", [errors](std::size_t line) { return static_cast<double>(line % errors); }});
  const Result& found = coupling_of(result);
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    table.columns.push_back(list_column(result.responses[r].name, found.worst_case_signs.row(r)));
  }
  table.columns.push_back(list_column("unsolved", found.unsolved_signs));
  return table;
}

CsvTable solve_table(const StoredResult& result) {
  const std::size_t poses = result.poses.size();
  const Result& found = coupling_of(result);
  CsvTable table{"not_converged",
                 {"pose", [poses](std::size_t line) { return std::to_string(line % poses); }},
                 found.solves.size()};
  append_size_columns(table, found, SubsetLines({found.size_names.size(), 1, poses}));
  append_solve_columns(table, found.solves.all());
  return table;
}

void write(ResultBuilder& result, const Study& study, std::any& any) {
  auto& found = std::any_cast<Result&>(any);
  add_names(result, study, study.analysis.factors);
  result.add_axis("size", found.size_names, {"1", "Size of the errors"});
  result.add_axis("source", found.sources, {"1", "Name of the source of errors"});
  result.add_axis("subset", found.subsets, {"1", "Sources that act at once, joined by +"});
  write_group(result, kCoupling, std::move(found));
  add_choices(result, study, found);
  add_solver(result, found.solves);
}

/// Completes a result that was read from a file of version 0.2.0. In such a file, `worst_case` is the first-order sum
/// and corners are missing. The rounding is computed from the sizes of the errors.
void read_older(Result& found) {
  if (!found.first_order_sum.empty()) {
    const bool searched = has_worst_cases(found);
    for (const bool lacks : {found.worst_case_max.empty(), found.corners.empty(), found.unsolved_corners.empty(),
                             found.worst_case_max_pose.empty(), found.worst_case_signs.empty(),
                             found.unsolved_pose.empty(), found.unsolved_signs.empty()}) {
      if (lacks == searched) throw h5::Error("/coupling lacks a part of what worst cases have");
    }
    if (found.first_order_sum_max.empty() || found.rounding.empty()) {
      throw h5::Error("/coupling lacks first_order_sum_max or rounding");
    }
    return;
  }
  if (!has_worst_cases(found) || found.worst_case_max.empty()) throw h5::Error("/coupling lacks first_order_sum");
  found.first_order_sum = std::exchange(found.worst_case, {});
  found.first_order_sum_max = std::exchange(found.worst_case_max, {});
  found.rounding = decltype(found.rounding)({found.effect.length<axis::Response>(), found.size_names.size()});
  for (std::size_t r = 0; r < found.effect.length<axis::Response>(); ++r) {
    for (std::size_t z = 0; z < found.size_names.size(); ++z) {
      found.rounding(r, z) = size_rounding(0.0, found.linear(z), found.angular(z));
    }
  }
}

void read(const h5::File& file, StoredResult& result) {
  Result found;
  found.size_names = file.read<std::string>("/size");
  found.sources = file.read<std::string>("/source");
  found.subsets = file.read<std::string>("/subset");
  read_fields(file, "/coupling", kSizes, found);
  read_group(file, kCoupling, found);
  read_older(found);
  found.solves = read_solver<decltype(found.solves)>(file);
  result.constant = responses_without_effect(found);
  result.found = std::move(found);
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  tables.push_back(curve_table(result));
  CsvTable summary = subset_table(result, "coupling_summary", 1);
  append_response_columns<Result::Summary<double>>(summary, result);
  tables.push_back(std::move(summary));
  if (has_worst_cases(coupling_of(result))) tables.push_back(corner_table(result));
  tables.push_back(solve_table(result));
}

}  // namespace

constinit const FileKind kFile{.write = write, .read = read, .append_tables = append_tables};

}  // namespace poesy::coupling
