#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/kinds/allocation/kind.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/allocation/summary.h"
#include "engine/kinds/allocation/zone_tables.h"
#include "engine/model/feature.h"
#include "engine/result/result_parts.h"
#include "engine/stats/proportion.h"

namespace poesy::allocation {
namespace {

const Axes kByStage{"stage"};
constexpr const char* kPartUnit = "SI: part unit, see /allocation/unit";
constexpr const char* kCostUnit = "cost, as the study states it";
constexpr const char* kCostPerResponse = "cost / SI: response unit";

const Group<Result> kAllocation{
    "/allocation",
    "Tolerances that keep the study's limits. cost: of all parts; lower_bound: no tolerances cost less under the last "
    "limits on root mean squares; gap: by how much tolerances of these limits may cost too much; yield: share of the "
    "certificate's machines that are within "
    "all limits at all poses, with its interval; certified: 1 if it is shown at this confidence that the yield is at "
    "least wanted_yield, else 0; calibrated: 1 if responses are what the best correction of the actuators leaves. NaN "
    "costs: the aim has none",
    {{"cost", &Result::total_cost},
     {"lower_bound", &Result::lower_bound},
     {"gap", &Result::gap},
     {"wanted_yield", &Result::wanted_yield},
     {"confidence", &Result::confidence}},
    {},
    {{"tolerance", &Result::tolerance, kPartUnit, "T of each part: the drawing says +-T"},
     {"sigma", &Result::sigma, kPartUnit, "Standard deviation of the part's errors about their mean"},
     {"sigmas", &Result::sigmas, "1", "T = shift + sigmas x sigma"},
     {"shift", &Result::shift, kPartUnit, "By how much the mean is off, as often up as down"},
     {"cost", &Result::cost, kCostUnit, "Cost of the part; NaN if no part has a cost"},
     {"share", &Result::share, "1", "Share of the cost of all parts; NaN likewise"},
     {"mean_square_share", &Result::mean_square_share, "1",
      "Share of what all parts add to the mean square under the tightest limit"},
     {"error_mean_square_share", &Result::error_mean_square_share, "1",
      "The same of each error, whose sum over a part is that of the part; NaN for an error of no part",
      Presence::where_computed},
     {"bound", &Result::bound, "1",
      "0: T is between its bounds; 1: at the lower one; 2: at the upper one; 3: there is no choice; 4: at the upper "
      "one, because no limit depends on it"},
     {"chosen", &Result::chosen, "1", "Process or grade of the part; empty where there is none"},
     {"unit", &Result::part_unit, "1", "SI unit of T"},
     {"members", &Result::part_members, "1", "Errors of the part, with blanks between"},
     {"coarser_yield", &Result::coarser_yield, "1",
      "Predicted share of the design's machines that are within all limits if this part alone gets a T 5 % larger, or "
      "the next larger one that can be had; NaN where nothing larger is allowed"},
     {"zone_feature", &Result::zone_feature, "1", "Feature of the drawing whose zone the part is; empty: it is none",
      Presence::where_computed},
     {"zone_limbs", &Result::zone_limbs, "1", "Limbs whose features share the zone", Presence::where_computed},
     {"zone_key", &Result::zone_key, "1", "Its name: position, perpendicularity, ...", Presence::where_computed},
     {"zone_shape", &Result::zone_shape, "1",
      "cylinder, sphere, planes: T is a diameter or a width; interval: a distance, +-T", Presence::where_computed},
     {"zone_datums", &Result::zone_datums, "1", "Its datums", Presence::where_computed},
     {"zone_length", &Result::zone_length, "m", "Length of the axis, first side or diameter of the plane; NaN: none",
      Presence::where_computed},
     {"zone_width", &Result::zone_width, "m", "Second side of the plane; 0: it is round; NaN: none",
      Presence::where_computed},
     {"zone_inside", &Result::zone_inside, "1", "Share of the features that are inside the zone",
      Presence::where_computed},
     {"zone_is_needed", &Result::zone_is_needed, "1",
      "0: an orientation that the drawing does not need, as wide as its location allows; else 1",
      Presence::where_computed},
     {"stage_tolerance", &Result::stage_tolerance, kPartUnit, "T of each part after each step on the way"},
     {"multiplier", &Result::multiplier, kCostPerResponse,
      "In the optimisation with limits on root mean squares, what one unit more of the limit at this pose alone would "
      "save; NaN for a response without a limit"},
     {"limit_use", &Result::limit_use, "1",
      "Predicted root mean square over what the tightest limit allows it; NaN likewise"},
     {"fixed_share", &Result::fixed_share, "1",
      "Share of the mean square under the limit, at the pose where the limit is used most, that belongs to no part: "
      "background, errors without a part, noise of measurements, interactions of errors; NaN for a response without a "
      "limit",
      Presence::where_computed},
     {"limit", &Result::limit, kResponseUnit, "Limit of the response; NaN for none"},
     {"saving", &Result::saving, kCostUnit,
      "What a limit wider by one percent at all poses would save at the same yield, to first order; NaN for a response "
      "without a limit, and of several limits if no machine of the certificate is near them"},
     {"deciding_share", &Result::deciding_share, "1",
      "Share of the certificate's machines near the limits (largest ratio of a response to its limit from 0.9 to 1.1) "
      "whose largest ratio is that of this response at this pose; a limit that is judged from several poses together "
      "counts evenly at all; NaN for a response without a limit, and if no machine is near the limits",
      Presence::where_computed},
     {"limit_from", &Result::limit_from, kResponseUnit,
      "Lower end of the limit, minus infinity for none, NaN for a response without a limit; where a file has it, "
      "/allocation/limit of a limit that is not on the magnitude is the least distance over the poses from the "
      "response "
      "of the mechanism with perfect parts to the nearer end",
      Presence::where_computed},
     {"limit_to", &Result::limit_to, kResponseUnit, "Upper end of the limit, infinity for none; NaN likewise",
      Presence::where_computed},
     {"limit_pose_share", &Result::limit_pose_share, "1",
      "Share of the poses of a machine at which the limit is to be kept; NaN likewise", Presence::where_computed},
     {"limit_is_spread", &Result::limit_is_spread, "1",
      "1: the limit is on the largest less the smallest value over the poses of a machine; 0: on values; NaN likewise",
      Presence::where_computed}}};

const Group<Result> kCurve{
    "/allocation/curve",
    "Predicted cost over the yield that is asked for, and over a factor of all limits",
    {},
    {},
    {{"yield_cost", &Result::curve_yield_cost, kCostUnit, "Predicted cost at this yield"},
     {"factor_cost", &Result::curve_factor_cost, kCostUnit, "Predicted cost with all limits times this factor"}}};

constexpr const char* kStages = "/allocation/stages";

const Fields<AllocationStage> kStageFields{
    {"cost", &AllocationStage::cost, kByStage, kCostUnit, "Cost of all parts; NaN if no part has a cost"},
    {"lower_bound", &AllocationStage::lower_bound, kByStage, kCostUnit,
     "No tolerances cost less in this stage's programme; NaN likewise"},
    {"rms_share", &AllocationStage::rms_share, kByStage, "1", "Limit on a root mean square over limit on a value"},
    {"machines", &AllocationStage::machines, kByStage, "1", "Machines tried at these tolerances; 0: none"},
    {"rejects", &AllocationStage::rejects, kByStage, "1", "Of them, machines that are not within all limits"}};

constexpr const char* kCertificate = "/allocation/certificate";

/// The fields of YieldVerdict for the certificate's machines, in the group of the certificate.
const Group<YieldVerdict> kVerdict{
    kCertificate,
    "What fresh machines show of the tolerances: their number is set beforehand, their seed serves nothing else, and "
    "they are looked at once. A machine that is not solved at a pose is rejected. asked: the yield; conf_level: of the "
    "bound and of the interval",
    {{"asked", &YieldVerdict::asked}, {"conf_level", &YieldVerdict::conf_level}},
    {},
    {{"machines", &YieldVerdict::machines, "1", "Fresh machines"},
     {"rejects", &YieldVerdict::rejects, "1", "Of them, machines that are not within all limits at all poses"},
     {"unsolved", &YieldVerdict::unsolved, "1", "Of the rejects, those that no solved pose rejects"},
     {"yield", &YieldVerdict::value, "1", "Share of the fresh machines that are no rejects"},
     {"ci_low", &YieldVerdict::ci_low, "1", "Lower end of its two-sided interval (Clopper and Pearson)"},
     {"ci_high", &YieldVerdict::ci_high, "1", "Upper end of its two-sided interval (Clopper and Pearson)"}}};

/// Further fields of the group of the certificate: the seed of its machines, its allowed rejects, and the machines and
/// rejects of the design.
const Fields<Result> kMachines{
    {"seed", &Result::certificate_seed, "1", "Seed of the fresh machines"},
    {"most_rejects", &Result::certificate_most, "1", "The certificate holds with no more rejects than these"},
    {"design_machines", &Result::design_machines, "1", "Machines with which the tolerances were found"},
    {"design_rejects", &Result::design_rejects, "1", "Of them, rejects at these tolerances"},
    {"design_most", &Result::design_most, "1", "With so many of them the certificate will probably hold"}};

constexpr const char* kCertificateStudy = "/allocation/certificate_study";

/// The words for YieldVerdict::Decision in a result file, in the order of the enumeration.
constexpr std::array<std::string_view, 4> kDecisions{"not_asked", "kept", "not_kept", "undecided"};
constexpr std::array kAims{Aim::least_cost, Aim::equal_effect, Aim::equal_tolerance, Aim::common_factor};

std::string decision_of(const YieldVerdict& shown) {
  return std::string(kDecisions[static_cast<std::size_t>(shown.decision)]);
}

/// The one-sided lower confidence bound on the yield.
double lower_bound(const YieldVerdict& shown) {
  return proportion_at_least(shown.machines - shown.rejects, shown.machines, shown.conf_level);
}

void write_certificate(ResultBuilder& result, const Result& found) {
  const YieldVerdict& shown = found.certificate;
  write_group(result, kVerdict, shown);
  write_fields(result, kCertificate, kMachines, found);
  const std::string group(kCertificate);
  result.add_scalar(group + "/lower_bound", lower_bound(shown),
                    {"1", "One-sided lower bound on the yield (Clopper and Pearson)"});
  result.add_scalar(group + "/decision", decision_of(shown),
                    {"1",
                     "kept: certified, the lower bound is at least the yield that is asked for; not_kept: the upper "
                     "bound is below it; undecided: neither"});
}

/// Reads the certificate. Throws h5::Error for counts that no run can produce.
void read_certificate(const h5::File& file, Result& found) {
  YieldVerdict& shown = found.certificate;
  read_group(file, kVerdict, shown);
  read_fields(file, kCertificate, kMachines, found);
  const std::string group(kCertificate);
  check_shape(file, group + "/lower_bound", {});
  const std::string word = read_shaped<std::string>(file, group + "/decision", {}).at(0);
  const auto* const decision = std::ranges::find(kDecisions, word);
  if (decision == kDecisions.end()) throw h5::Error(group + " has the unknown decision '" + word + "'");
  shown.decision = static_cast<YieldVerdict::Decision>(decision - kDecisions.begin());
  const bool level = shown.conf_level > 0.0 && shown.conf_level < 1.0;
  if (!level || shown.rejects > shown.machines || shown.unsolved > shown.rejects) {
    throw h5::Error(group + " has counts or a level that no certificate has");
  }
}

/// Adds attributes for other programs that read the file: texts, and numbers that also follow from other data.
void add_attributes(h5::File& file, const Result& found) {
  const auto set = [&](const char* name, const auto& value) { file.set_attribute(kAllocation.path, name, value); };
  set("yield", found.certificate.value);
  set("yield_ci_low", found.certificate.ci_low);
  set("yield_ci_high", found.certificate.ci_high);
  set("certified", static_cast<std::uint8_t>(found.certified()));
  set("calibrated", static_cast<std::uint8_t>(found.calibrated));
  set("aim", std::string(name(found.aim)));
}

Aim read_aim(const h5::File& file) {
  const auto word = file.attribute<std::string>(kAllocation.path, "aim").at(0);
  const auto* const aim = std::ranges::find(kAims, word, [](Aim one) { return name(one); });
  if (aim == kAims.end()) throw h5::Error("/allocation has the unknown aim '" + word + "'");
  return *aim;
}

void write(ResultBuilder& result, const Study& study, std::any& any) {
  const auto& found = std::any_cast<const Result&>(any);
  add_names(result, study, study.analysis.factors);
  add_sigma(result, study);
  result.add_axis("part", found.part_names, {"1", "Parts of the drawing, each with one tolerance"});
  result.add_axis("stage", texts(found.stages, &AllocationStage::name), {"1", "Steps on the way to the tolerances"});
  result.add_axis("curve_yield", found.curve_yield, {"1", "Yields of a curve of costs"});
  result.add_axis("curve_factor", found.curve_factor, {"1", "Factors of all limits of a curve of costs"});
  write_group(result, kAllocation, found);
  h5::File& file = result.file();
  add_attributes(file, found);
  file.make_group(kStages);
  file.set_attribute(kStages, "description", std::string("The steps on the way to the tolerances, in their order"));
  write_columns(result, kStages, kStageFields, found.stages);
  result.show_axes(kStages, kByStage);
  write_group(result, kCurve, found);
  write_certificate(result, found);
  result.add_scalar(kCertificateStudy, found.certificate_study, {"1", "The study that repeats the certificate"});
  add_solver(result, found.solves);
  add_failures(result, found.failures, {std::string(kAllFactors)}, found.total().not_converged());
}

/// Checks the properties of a result that tables and CSV files rely on. Throws h5::Error.
void check(const Result& found) {
  check_names(found.part_names, "/part");
  check_names(found.part_unit, "/allocation/unit");
  check_names(texts(found.stages, &AllocationStage::name), "/stage");
  const std::array sizes{found.zone_feature.size(), found.zone_limbs.size(),  found.zone_key.size(),
                         found.zone_shape.size(),   found.zone_datums.size(), found.zone_length.size(),
                         found.zone_width.size(),   found.zone_inside.size(), found.zone_is_needed.size()};
  if (std::ranges::count(sizes, sizes.front()) != static_cast<std::ptrdiff_t>(sizes.size())) {
    throw h5::Error("/allocation has only some of the datasets of zones");
  }
  for (const std::string& key : found.zone_key) {
    if (!key.empty() && std::ranges::find(zone_traits(), key, &ZoneTraits::key) == zone_traits().end()) {
      throw h5::Error("/allocation/zone_key holds an unknown zone");
    }
  }
  if (std::ranges::any_of(found.bound, [](std::uint8_t at) { return at > Result::kWithoutEffect; })) {
    throw h5::Error("/allocation/bound holds an unknown bound");
  }
}

void read(const h5::File& file, StoredResult& result) {
  Result found;
  read_sigma(file, result);
  found.part_names = file.read<std::string>("/part");
  found.curve_yield = file.read<double>("/curve_yield");
  found.curve_factor = file.read<double>("/curve_factor");
  read_group(file, kAllocation, found);
  found.aim = read_aim(file);
  found.calibrated = file.attribute<std::uint8_t>(kAllocation.path, "calibrated").at(0) != 0;
  found.stages = read_columns(file, kStages, kStageFields);
  const auto names = file.read<std::string>("/stage");
  for (std::size_t k = 0; k < names.size(); ++k) found.stages[k].name = names[k];
  read_group(file, kCurve, found);
  read_certificate(file, found);
  found.certificate_study = read_shaped<std::string>(file, kCertificateStudy, {}).at(0);
  check(found);
  found.solves = read_solver<decltype(found.solves)>(file);
  found.certificate.solves = found.total();
  // A failed sample is stored with its pose and its number in the study of the certificate, so that it can be replayed.
  // Its error is kAllFactors, which read_failures() looks up in `varied`.
  result.varied = {std::string(kAllFactors)};
  found.failures = read_failures(file, result);
  result.varied.clear();
  result.verdicts = {.judge = Judge::yield, .limits = {}, .yield = found.certificate};
  result.found = std::move(found);
}

/// The entry of kAllocation.fields for the dataset with this name.
const FieldRow<Result>& row(std::string_view name) {
  return *std::ranges::find(kAllocation.fields, name, &FieldRow<Result>::name);
}

/// The names of the parts with their units.
std::vector<NamedUnit> named_parts(const Result& found) {
  std::vector<NamedUnit> parts;
  for (std::size_t n = 0; n < found.parts(); ++n) parts.push_back({found.part_names[n], found.part_unit(n)});
  return parts;
}

/// A CSV table of the tolerances, with a line for each part.
CsvTable part_table(const Result& found) {
  CsvTable table{"allocation",
                 {"part", [&found](std::size_t n) { return found.part_names[n]; }},
                 found.parts(),
                 {},
                 {"unit", [&found](std::size_t n) { return found.part_unit(n); }}};
  table.rest = {{"chosen", [&found](std::size_t n) { return found.chosen(n).empty() ? "none" : found.chosen(n); }},
                {"errors", [&found](std::size_t n) { return found.part_members(n); }}};
  const std::vector<NamedUnit> parts = named_parts(found);
  for (const char* name : {"tolerance", "sigma", "shift"}) {
    const FieldRow<Result>& field = row(name);
    table.columns.push_back(field_column(with_unit(name, si_units(parts)), field, found));
    table.columns.push_back({with_unit(name, display_units(parts)), [&found, &field](std::size_t n) {
                               const Unit& unit = display_unit(dimension_of(found.part_unit(n)));
                               return to_double(number_at(field, found, n)) / unit.si;
                             }});
  }
  for (const char* name : {"sigmas", "cost", "share", "mean_square_share", "bound", "coarser_yield"}) {
    table.columns.push_back(field_column(name, row(name), found));
  }
  return table;
}

/// A CSV table of each error's share of the mean square under the tightest limit.
CsvTable error_table(const StoredResult& result) {
  const Result& found = allocation_of(result);
  CsvTable table = lines_of_factors(result, "allocation_errors");
  table.columns.push_back(list_column("mean_square_share", found.error_mean_square_share));
  return table;
}

/// A CSV table with a line for each response that has a limit.
CsvTable limit_table(const StoredResult& result) {
  const Result& found = allocation_of(result);
  CsvTable table{"allocation_limits",
                 {"response", [&result](std::size_t r) { return result.responses[r].name; }},
                 found.limit.size(),
                 {},
                 {"unit", [&result](std::size_t r) { return result.responses[r].unit; }},
                 [&found](std::size_t r) { return !std::isnan(found.limit(r)); }};
  table.columns.push_back(field_column("limit", row("limit"), found));
  table.columns.push_back(field_column("saving", row("saving"), found));
  const auto add_largest = [&](const std::string& name, const Result::AtPoses& values) {
    table.columns.push_back({"largest_" + name, [&values](std::size_t r) {
                               const std::optional<std::size_t> pose = worst_pose(values.row(r));
                               return pose ? values(r, *pose) : kNaN;
                             }});
    table.columns.push_back({"largest_" + name + "_pose", [&values](std::size_t r) {
                               const std::optional<std::size_t> pose = worst_pose(values.row(r));
                               return pose ? static_cast<std::int64_t>(*pose) : -1;
                             }});
  };
  if (!found.fixed_share.empty()) table.columns.push_back(field_column("fixed_share", row("fixed_share"), found));
  if (!found.deciding_share.empty()) {
    table.columns.push_back({"deciding_share", [&found](std::size_t r) { return found.decides(r); }});
  }
  add_largest("limit_use", found.limit_use);
  add_largest("multiplier", found.multiplier);
  return table;
}

/// A CSV table with the use of each limit at each pose, the limit's multiplier at this pose, and how often it decides.
CsvTable pose_use_table(const StoredResult& result) {
  const Result& found = allocation_of(result);
  CsvTable table = lines_of_poses(result, "allocation_poses");
  for (const std::size_t r : limited_responses(found)) {
    const NamedUnit& response = result.responses[r];
    table.columns.push_back(list_column("limit_use_" + response.name, found.limit_use.row(r)));
    table.columns.push_back(
        list_column(with_unit("multiplier_" + response.name, "cost/" + response.unit), found.multiplier.row(r)));
    if (found.deciding_share.empty()) continue;
    table.columns.push_back(list_column("deciding_share_" + response.name, found.deciding_share.row(r)));
  }
  return table;
}

CsvTable stage_table(const Result& found) {
  CsvTable table{
      "allocation_stages", {"stage", [&found](std::size_t k) { return found.stages[k].name; }}, found.stages.size()};
  for (const FieldRow<AllocationStage>& field : kStageFields) {
    table.columns.push_back(list_column(field.name, found.stages,
                                        [&field](const AllocationStage& one) { return number_at(field, one, 0); }));
  }
  return table;
}

/// A CSV table of predicted costs: first the lines for other yields, then those for all limits multiplied by a factor.
CsvTable curve_table(const Result& found) {
  const std::size_t yields = found.curve_yield.size();
  const auto of = [yields](std::span<const double> by_yield, std::span<const double> by_factor) {
    return [yields, by_yield, by_factor](std::size_t line) {
      return line < yields ? by_yield[line] : by_factor[line - yields];
    };
  };
  return {"allocation_curves",
          {"curve", [yields](std::size_t line) { return std::string(line < yields ? "yield" : "factor of limits"); }},
          yields + found.curve_factor.size(),
          {{"at", of(found.curve_yield, found.curve_factor)},
           {"cost", of(found.curve_yield_cost, found.curve_factor_cost)}}};
}

/// A CSV table with the certificate in one line.
CsvTable certificate_table(const Result& found) {
  const YieldVerdict& shown = found.certificate;
  CsvTable table{"allocation_certificate", {"decision", [&shown](std::size_t) { return decision_of(shown); }}, 1};
  const auto add = [&](const char* name, Number number) {
    table.columns.push_back({name, [number](std::size_t) { return number; }});
  };
  add("asked", shown.asked);
  add("conf_level", shown.conf_level);
  add("seed", found.certificate_seed);
  add("machines", shown.machines);
  add("rejects", shown.rejects);
  add("unsolved", shown.unsolved);
  add("most_rejects", found.certificate_most);
  add("yield", shown.value);
  add("ci_low", shown.ci_low);
  add("ci_high", shown.ci_high);
  add("lower_bound", lower_bound(shown));
  add("design_machines", found.design_machines);
  add("design_rejects", found.design_rejects);
  add("design_most", found.design_most);
  return table;
}

/// A CSV table of the certificate's failed samples, with their poses and numbers in the certificate's own study.
CsvTable certificate_failures(const Result& found) {
  const std::vector<Failure>& list = found.failures;
  return {"failures",
          {"factor", [](std::size_t) { return std::string(kAllFactors); }},
          list.size(),
          {list_column("pose", list, [](const Failure& failure) { return failure.pose.value; }),
           list_column("sample", list, [](const Failure& failure) { return failure.failed.sample.value; }),
           list_column("status", list, [](const Failure& failure) { return failure.failed.status; })}};
}

/// Adds the tables of the errors. Their standard deviations are called start_sigma, because the search began with them;
/// part_table() has the standard deviations that the search found.
void append_start_sigma(CsvTables& tables, const StoredResult& result) {
  const std::size_t factors = tables.size();
  append_sigma_tables(tables, result);
  for (auto& column : tables[factors].columns) {
    if (column.heading.starts_with("sigma")) column.heading.insert(0, "start_");
  }
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  const Result& found = allocation_of(result);
  append_start_sigma(tables, result);
  tables.push_back(part_table(found));
  if (found.has_zones()) tables.push_back(drawing_csv(found));
  if (!found.error_mean_square_share.empty()) tables.push_back(error_table(result));
  tables.push_back(limit_table(result));
  tables.push_back(pose_use_table(result));
  tables.push_back(stage_table(found));
  tables.push_back(curve_table(found));
  tables.push_back(certificate_table(found));
  CsvTable solves = lines_of_poses(result, "not_converged");
  append_solve_columns(solves, found.solves);
  tables.push_back(std::move(solves));
  tables.push_back(certificate_failures(found));
}

}  // namespace

constinit const FileKind kFile{.write = write, .read = read, .append_tables = append_tables};

}  // namespace poesy::allocation
