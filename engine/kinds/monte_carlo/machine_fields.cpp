#include "engine/kinds/monte_carlo/machine_fields.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/units.h"
#include "engine/result/result_parts.h"
#include "engine/stats/main_effects.h"

namespace poesy::monte_carlo {
namespace {

const Axes kByEffectPose{"effect_pose"};

/// The last words in the descriptions of statistics over machines, which leave out machines that are not solved at
/// every pose.
const std::string kOfSolved = " over the machines that are solved at every pose";

/// The fields with the distribution over the machines of a number that each machine has. what: this number, such as
/// "largest magnitude over the poses".
Group<MachineValues> values_group(const std::string& path, const std::string& what) {
  using Values = MachineValues;
  const std::string of = "of the machines' " + what + ",";
  return {
      path,
      "The distribution " + of + kOfSolved,
      {},
      {},
      {{"mean", &Values::mean, kResponseUnit, "Mean " + of + kOfSolved},
       {"mean_ci_low", &Values::mean_ci_low, kResponseUnit,
        "Lower end of Student's interval of the mean; machines are independent of each other"},
       {"mean_ci_high", &Values::mean_ci_high, kResponseUnit, "Upper end of Student's interval of the mean"},
       {"std", &Values::std, kResponseUnit, "Sample standard deviation"},
       {"min", &Values::min, kResponseUnit, "Smallest of any machine"},
       {"max", &Values::max, kResponseUnit, "Largest of any machine"},
       {"count", &Values::count, "1", "Machines behind these: solved at every pose"},
       {"quantiles", &Values::quantiles, kResponseUnit,
        "Order statistic of rank ceil(q n) of n machines, off by quantile_error at most"},
       {"quantiles_ci_low", &Values::quantiles_ci_low, kResponseUnit,
        "Lower end of an interval for the quantile of the distribution, from order statistics (binomial)"},
       {"quantiles_ci_high", &Values::quantiles_ci_high, kResponseUnit,
        "Upper end of an interval for the quantile of the distribution, from order statistics (binomial)"},
       {"histogram_edges", &Values::histogram_edges, kResponseUnit,
        "Edges of the bins, as /monte_carlo/histogram_edges"},
       {"histogram_counts", &Values::histogram_counts, "1", "Machines in each bin, as /monte_carlo/histogram_counts"},
       {"quantile_error", &Values::quantile_error, kResponseUnit,
        "What none of the quantiles is off by more than from its order statistic, as /monte_carlo/quantile_error",
        Presence::where_computed}}};
}

const Group<MachineValues> kLargest = values_group("/machines/largest", "largest magnitude over the poses");
const Group<MachineValues> kRms = values_group("/machines/rms", "root mean square over the poses");

const std::vector<Attribute<YieldResult>> kYieldInterval{{"conf_level", &YieldResult::conf_level}};
const std::string kPearson = " end of the two-sided interval of Clopper and Pearson";

const Group<YieldResult> kYield{
    "/yield",
    "The share of machines, each one set of errors, that are within every limit at every pose. A machine that is not "
    "solved at a pose is a reject, unless said otherwise",
    kYieldInterval,
    {},
    {{"value", &YieldResult::value, "1", "The yield: share of the machines that are no rejects"},
     {"ci_low", &YieldResult::ci_low, "1", "Lower" + kPearson},
     {"ci_high", &YieldResult::ci_high, "1", "Upper" + kPearson},
     {"rejects", &YieldResult::rejects, "1", "Machines that are not within every limit at every pose"},
     {"machines", &YieldResult::machines, "1", "Machines that were tried"},
     {"unsolved", &YieldResult::unsolved, "1", "Of these, machines with a pose that is not solved"},
     {"unsolved_pass", &YieldResult::unsolved_pass, "1",
      "The yield if samples that are not solved were within every limit"},
     {"unsolved_pass_ci_low", &YieldResult::unsolved_pass_ci_low, "1", "Lower" + kPearson},
     {"unsolved_pass_ci_high", &YieldResult::unsolved_pass_ci_high, "1", "Upper" + kPearson},
     {"unsolved_pass_rejects", &YieldResult::unsolved_pass_rejects, "1", "The rejects if they were"},
     {"by_response", &YieldResult::by_response, "1",
      "Share of the machines that are within the limit of this response at every pose; NaN for a response without a "
      "limit"},
     {"by_response_ci_low", &YieldResult::by_response_ci_low, "1", "Lower" + kPearson},
     {"by_response_ci_high", &YieldResult::by_response_ci_high, "1", "Upper" + kPearson},
     {"worst_pose_share", &YieldResult::worst_pose_share, "1",
      "Share of the machines that are not within the limit of this response at this pose; NaN for a response without a "
      "limit"},
     {"gradient", &YieldResult::gradient, "SI: 1 / factor unit",
      "Slope of the yield by the error's sigma (likelihood ratio; of uniform, triangular and measured errors by a "
      "linear map of the limited responses, where the machines give one); NaN for errors of a correlated block that "
      "are not all normal, and where the machines do not tell it"},
     {"gradient_ci_low", &YieldResult::gradient_ci_low, "SI: 1 / factor unit",
      "Lower end of its interval (central limit theorem)"},
     {"gradient_ci_high", &YieldResult::gradient_ci_high, "SI: 1 / factor unit",
      "Upper end of its interval (central limit theorem)"},
     {"change", &YieldResult::change, "1",
      "What the yield changes by if the error's sigma grows by a tenth and all else stays: the finite step, not a "
      "tenth "
      "of the slope, except for correlated errors; NaN as the gradient",
      Presence::where_computed},
     {"change_ci_low", &YieldResult::change_ci_low, "1", "Lower end of its interval (central limit theorem)",
      Presence::where_computed},
     {"change_ci_high", &YieldResult::change_ci_high, "1", "Upper end of its interval (central limit theorem)",
      Presence::where_computed},
     {"change_sd_without_effect", &YieldResult::change_sd_without_effect, "1",
      "Standard deviation that the change would have by chance if the error had no effect; NaN if not known",
      Presence::where_computed},
     {"mean_square_share", &YieldResult::mean_square_share, "1",
      "Share that the error adds, to first order, to the scatter of the limited response, of a norm to that of its "
      "vector. The scatter is the mean square about the mean over the machines, summed over all poses. NaN for a "
      "response without a limit, for correlated errors, and where there are too few machines for a fit",
      Presence::where_computed},
     {"mean_square_share_ci_low", &YieldResult::mean_square_share_ci_low, "1",
      "Lower end of its interval (least squares)", Presence::where_computed},
     {"mean_square_share_ci_high", &YieldResult::mean_square_share_ci_high, "1",
      "Upper end of its interval (least squares)", Presence::where_computed},
     {"linear_share", &YieldResult::linear_share, "1",
      "The part of that scatter that is linear in the errors: the rest belongs to no error alone",
      Presence::where_computed},
     {"offset", &YieldResult::offset, kResponseUnit,
      "Root mean square over the poses of the mean over the machines of the limited response, of a norm that of its "
      "vector: background and means of errors together, with their signs. NaN as linear_share",
      Presence::where_computed},
     {"offset_share", &YieldResult::offset_share, "1",
      "Share of the squared offset in the whole mean square, which is that and the scatter",
      Presence::where_computed}}};

const Group<PartsYield> kPartsYield{
    "/yield/parts",
    "What the yield may be as far as the parts tell on which errors were measured (resampled parts, to first order, on "
    "the scale of normal scores): it holds the interval of the machines. NaN where fewer than ten machines are rejects "
    "or good, and where errors that are correlated were not all measured on the same parts",
    {},
    {},
    {{"ci_low", &PartsYield::ci_low, "1", "Lower end of the interval at the conf_level of /yield"},
     {"ci_high", &PartsYield::ci_high, "1", "Upper end of the interval at the conf_level of /yield"}}};

const Group<CalibrationYields> kCalibrationYields{
    "/yield/calibration",
    "The yield of the same machines without their calibration, and with the best correction of the actuators at each "
    "pose for the platform's points (metric_points); /yield/value is that with the calibration of the study",
    {},
    {},
    {{"uncalibrated", &CalibrationYields::uncalibrated, "1", "The yield without calibration"},
     {"uncalibrated_ci_low", &CalibrationYields::uncalibrated_ci_low, "1", "Lower" + kPearson},
     {"uncalibrated_ci_high", &CalibrationYields::uncalibrated_ci_high, "1", "Upper" + kPearson},
     {"best", &CalibrationYields::best, "1",
      "The yield after the correction of the actuators at each pose that is best for metric_points; NaN where the "
      "model does not know it"},
     {"best_ci_low", &CalibrationYields::best_ci_low, "1", "Lower" + kPearson},
     {"best_ci_high", &CalibrationYields::best_ci_high, "1", "Upper" + kPearson},
     {"not_fitted", &CalibrationYields::not_fitted, "1",
      "Machines that were not calibrated, because they are not solved where they are measured or their fit does not "
      "converge: rejects"},
     {"fitted", &CalibrationYields::fitted, "1", "Fitted errors of each machine"},
     {"measured", &CalibrationYields::measured, "1", "Measured values of each machine"},
     {"measured_poses", &CalibrationYields::measured_poses, "1", "Poses where each machine is measured"}}};

/// The fields of the first-order index S1 and its interval.
Fields<MainEffects> index_fields(const std::string& what) {
  return {{"S1", &MainEffects::s1, "1", "First-order index " + what},
          {"S1_ci_low", &MainEffects::s1_ci_low, "1", "Lower end of its interval"},
          {"S1_ci_high", &MainEffects::s1_ci_high, "1", "Upper end of its interval"}};
}

const Fields<MainEffects> kIndices =
    index_fields("Var(E[y | error]) / Var(y): both added up over the poses effect_pose before they are divided");
const Fields<MainEffects> kIndicesOfLargest = index_fields("of the machines' largest magnitudes over all poses");

Group<MainEffects> curves_group(const std::string& path, const std::string& what) {
  return {path,
          "Main effects: " + what + ", while an error is in each bin of equal probability and all others vary",
          {},
          {},
          {{"mean", &MainEffects::mean, kResponseUnit, "Mean over the machines in the bin"},
           {"ci_low", &MainEffects::ci_low, kResponseUnit, "Lower end of Student's interval"},
           {"ci_high", &MainEffects::ci_high, kResponseUnit, "Upper end of Student's interval"}}};
}

const Group<MainEffects> kCurves = curves_group(
    "/monte_carlo/main_effect",
    "the mean of each response over all poses, or, where errors are drawn per pose, over the poses effect_pose");
const Group<MainEffects> kCurvesOfLargest =
    curves_group("/machines/largest/main_effect", "the largest magnitude over all poses of each response");

const Fields<EffectResult> kBins{{"error", &EffectResult::bin_error, kFactorUnit, "Mean of the error in its bin"}};

/// Writes S1 and its interval into a group.
void write_indices(ResultBuilder& result, const std::string& group, const Fields<MainEffects>& fields,
                   const MainEffects& effects, double conf_level) {
  write_fields(result, group, fields, effects);
  for (const FieldRow<MainEffects>& field : fields) result.show_axes(group, field.axes);
  result.file().set_attribute(group + "/S1", "conf_level", conf_level);
}

/// A table with the distribution over the machines of a number that each machine has, with a line for each response.
CsvTable by_response(const StoredResult& result, const std::string& name, const MachineValues& values) {
  const std::vector<double>& levels = monte_carlo_of(result).levels;
  CsvTable table{name,
                 {"response", [&](std::size_t r) { return result.responses[r].name; }},
                 result.responses.size(),
                 {},
                 {"unit", [&](std::size_t r) { return result.responses[r].unit; }}};
  const auto add = [&](const std::string& heading, const auto& numbers) {
    table.columns.push_back(list_column(heading, numbers));
  };
  const auto add_quantile = [&](const std::string& heading, const MachineValues::Quantiles& quantiles, std::size_t q) {
    table.columns.push_back({heading, [&quantiles, q](std::size_t r) { return quantiles(r, q); }});
  };
  add("mean", values.mean);
  add("mean_ci_low", values.mean_ci_low);
  add("mean_ci_high", values.mean_ci_high);
  add("std", values.std);
  add("min", values.min);
  add("max", values.max);
  add("count", values.count);
  for (std::size_t q = 0; q < levels.size(); ++q) {
    const std::string heading = "q_" + shortest(levels[q]);
    add_quantile(heading, values.quantiles, q);
    add_quantile(heading + "_ci_low", values.quantiles_ci_low, q);
    add_quantile(heading + "_ci_high", values.quantiles_ci_high, q);
  }
  if (!values.quantile_error.empty()) add("quantile_error", values.quantile_error);
  return table;
}

/// Appends three columns to the table: a number of each error for one response, and both ends of its interval. With the
/// name "share": "share_RESPONSE", "share_ci_low_RESPONSE" and "share_ci_high_RESPONSE".
void append_error_columns(CsvTable& table, const std::string& name, const std::string& response,
                          std::span<const double> value, std::span<const double> low, std::span<const double> high) {
  table.columns.push_back(list_column(name + "_" + response, value));
  table.columns.push_back(list_column(name + "_ci_low_" + response, low));
  table.columns.push_back(list_column(name + "_ci_high_" + response, high));
}

/// A table of each error's share in the scatter of each limited response.
CsvTable share_table(const StoredResult& result, const YieldResult& found) {
  CsvTable table = lines_of_factors(result, "mean_square_share");
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    if (std::isnan(found.by_response(r))) continue;  // the response has no limit
    append_error_columns(table, "share", result.responses[r].name, found.mean_square_share.row(r),
                         found.mean_square_share_ci_low.row(r), found.mean_square_share_ci_high.row(r));
  }
  return table;
}

/// Adds to `tables` the tables of the yield: under all limits together, under each limit, the shares of errors in the
/// scatter of limited responses, the gradient by each error, and the rejected machines at each pose.
void append_yield_tables(CsvTables& tables, const StoredResult& result, const YieldResult& found) {
  CsvTable all{"yield", {"limit", [](std::size_t) { return std::string("all"); }}, 1, {}, {}};
  for (const FieldRow<YieldResult>& field : kYield.fields) {
    if (field.axes.empty()) all.columns.push_back(field_column(field.name, field, found));
  }
  if (found.parts) {
    for (const FieldRow<PartsYield>& field : kPartsYield.fields) {
      all.columns.push_back(field_column("parts_" + field.name, field, *found.parts));
    }
  }
  if (const auto& calibration = monte_carlo_of(result).machines->calibration) {
    for (const FieldRow<CalibrationYields>& field : kCalibrationYields.fields) {
      all.columns.push_back(field_column(field.name, field, *calibration));
    }
  }
  tables.push_back(std::move(all));
  CsvTable each{"yield_by_response",
                {"response", [&](std::size_t r) { return result.responses[r].name; }},
                result.responses.size(),
                {list_column("yield", found.by_response), list_column("yield_ci_low", found.by_response_ci_low),
                 list_column("yield_ci_high", found.by_response_ci_high)},
                {"unit", [&](std::size_t r) { return result.responses[r].unit; }}};
  if (found.has_offset()) {
    each.columns.push_back(list_column("offset", found.offset));
    each.columns.push_back(list_column("offset_share", found.offset_share));
  }
  tables.push_back(std::move(each));
  if (found.has_shares()) tables.push_back(share_table(result, found));
  CsvTable gradient{"yield_gradient",
                    {"factor", [&](std::size_t p) { return result.factors[p].name; }},
                    result.factors.size(),
                    {list_column("gradient", found.gradient), list_column("gradient_ci_low", found.gradient_ci_low),
                     list_column("gradient_ci_high", found.gradient_ci_high)},
                    {"unit", [&](std::size_t p) { return "per " + result.factors[p].unit; }}};
  if (!found.change_sd_without_effect.empty()) {
    gradient.columns.push_back(list_column("change_sd_without_effect", found.change_sd_without_effect));
  }
  if (found.has_change()) {
    for (const auto& [name, list] : {std::pair{"change", &found.change},
                                     {"change_ci_low", &found.change_ci_low},
                                     {"change_ci_high", &found.change_ci_high}}) {
      gradient.columns.push_back(list_column(name, *list));
    }
  }
  tables.push_back(std::move(gradient));
  CsvTable poses = lines_of_poses(result, "rejects");
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    poses.columns.push_back(list_column(with_unit(result.responses[r].name, "1"), found.worst_pose_share.row(r)));
  }
  tables.push_back(std::move(poses));
}

/// A table of the first-order index S1 of each error on each response, with the column names of SALib.
CsvTable index_table(const StoredResult& result, const std::string& name, const MainEffects& effects) {
  CsvTable table = lines_of_factors(result, name);
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    append_error_columns(table, "S1", result.responses[r].name, effects.s1.row(r), effects.s1_ci_low.row(r),
                         effects.s1_ci_high.row(r));
  }
  return table;
}

/// A table of the main-effect curves of one response, with a line for each error and bin.
CsvTable curve_table(const StoredResult& result, const EffectResult& found, std::size_t r) {
  const NamedUnit& response = result.responses[r];
  return {
      "main_effect_" + response.name,
      {"factor", [&](std::size_t line) { return result.factors[found.bin_error.positions(line).front()].name; }},
      found.bin_error.size(),
      {list_column("error", found.bin_error), list_column(with_unit("mean", response.unit), found.effects.mean.row(r)),
       list_column(with_unit("ci_low", response.unit), found.effects.ci_low.row(r)),
       list_column(with_unit("ci_high", response.unit), found.effects.ci_high.row(r))},
      {"unit", [&](std::size_t line) { return result.factors[found.bin_error.positions(line).front()].unit; }}};
}

}  // namespace

std::size_t effect_bytes(const AxisLengths& lengths) {
  return bytes_of(kIndices, lengths) + bytes_of(kCurves.fields, lengths) + bytes_of(kBins, lengths);
}

std::size_t machine_bytes(const AxisLengths& lengths) {
  return bytes_of(kLargest.fields, lengths) + bytes_of(kRms.fields, lengths) + bytes_of(kYield.fields, lengths) +
         bytes_of(kIndicesOfLargest, lengths) + bytes_of(kCurvesOfLargest.fields, lengths);
}

void write_effects(ResultBuilder& result, const EffectResult& found) {
  std::vector<double> middles;
  for (std::size_t k = 0; k < kEffectBins; ++k) middles.push_back((static_cast<double>(k) + 0.5) / kEffectBins);
  result.add_axis("effect_bin", middles,
                  {"1", "Bins of equal probability of an error: the share of its values below the middle of each"});
  result.add_axis("effect_pose", found.s1_poses, {"1", "Poses, from 0, over which /monte_carlo/S1 adds up"});
  write_indices(result, "/monte_carlo", kIndices, found.effects, found.conf_level);
  result.show_axes("/monte_carlo", kByEffectPose);
  write_group(result, kCurves, found.effects);
  write_fields(result, "/monte_carlo/main_effect", kBins, found);
}

void write_machines(ResultBuilder& result, const MachineResult& found) {
  result.file().make_group("/machines");
  result.file().set_attribute("/machines", "description",
                              std::string("What machines are like that are used at all poses"));
  write_group(result, kLargest, found.largest);
  write_group(result, kRms, found.rms);
  if (found.yield) write_group(result, kYield, *found.yield);
  if (found.yield && found.yield->parts) write_group(result, kPartsYield, *found.yield->parts);
  if (found.calibration) write_group(result, kCalibrationYields, *found.calibration);
  write_indices(result, "/machines/largest", kIndicesOfLargest, found.effects_on_largest, found.conf_level);
  write_group(result, kCurvesOfLargest, found.effects_on_largest);
}

EffectResult read_effects(const h5::File& file) {
  if (axis_length(file, "effect_bin") != kEffectBins) throw h5::Error("/effect_bin does not have 32 positions");
  EffectResult found;
  found.s1_poses = file.read<std::uint64_t>("/effect_pose");
  found.conf_level = file.attribute<double>("/monte_carlo/S1", "conf_level").at(0);
  read_fields(file, "/monte_carlo", kIndices, found.effects);
  read_group(file, kCurves, found.effects);
  read_fields(file, "/monte_carlo/main_effect", kBins, found);
  return found;
}

std::optional<MachineResult> read_machines(const h5::File& file) {
  if (!file.exists("/machines")) return std::nullopt;
  MachineResult found;
  found.conf_level = file.attribute<double>("/machines/largest/S1", "conf_level").at(0);
  read_group(file, kLargest, found.largest);
  read_group(file, kRms, found.rms);
  if (file.exists("/yield")) {
    read_group(file, kYield, found.yield.emplace());
    if (file.exists("/yield/parts")) read_group(file, kPartsYield, found.yield->parts.emplace());
    if (file.exists("/yield/calibration")) read_group(file, kCalibrationYields, found.calibration.emplace());
  }
  read_fields(file, "/machines/largest", kIndicesOfLargest, found.effects_on_largest);
  read_group(file, kCurvesOfLargest, found.effects_on_largest);
  return found;
}

void append_effect_tables(CsvTables& tables, const StoredResult& result) {
  const EffectResult& found = monte_carlo_of(result).effects;
  tables.push_back(index_table(result, "S1", found.effects));
  for (std::size_t r = 0; r < result.responses.size(); ++r) tables.push_back(curve_table(result, found, r));
}

void append_machine_tables(CsvTables& tables, const StoredResult& result) {
  const MachineResult& found = *monte_carlo_of(result).machines;
  if (found.yield) append_yield_tables(tables, result, *found.yield);
  tables.push_back(by_response(result, "machines_largest", found.largest));
  tables.push_back(by_response(result, "machines_rms", found.rms));
  tables.push_back(index_table(result, "S1_largest", found.effects_on_largest));
}

}  // namespace poesy::monte_carlo
