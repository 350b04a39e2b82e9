#include <algorithm>
#include <any>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "engine/kinds/calibration/kind.h"
#include "engine/kinds/calibration/result.h"
#include "engine/report/display.h"
#include "engine/result/csv_table.h"
#include "engine/result/result_parts.h"
#include "engine/study/calibration.h"

namespace poesy::calibration {
namespace {

constexpr const char* kFittedUnit = "SI: unit of the fitted error, see /calibration/fitted_unit";
constexpr const char* kSquareUnit = "SI: product of the units of two fitted errors";
constexpr const char* kValueUnit = "SI: unit of the value, see /calibration/value_unit";
constexpr const char* kMovedUnit = "rad,rad,rad,m,m,m,m,m,m";
constexpr const char* kMixedUnit = "m or rad";

const Group<Result> kCalibration{
    "/calibration",
    "Errors of one machine, fitted to measurements of it",
    {},
    {},
    {{"estimate", &Result::estimate, kFittedUnit, "Estimates"},
     {"sd", &Result::sd, kFittedUnit, "Standard deviations; NaN where the measurements do not determine it"},
     {"low", &Result::low, kFittedUnit, "Lower ends of the intervals"},
     {"high", &Result::high, kFittedUnit, "Upper ends of the intervals"},
     {"scale", &Result::scale, kFittedUnit, "What counts as one in scaled numbers: the tolerance, where there is one"},
     {"has_tolerances", &Result::has_tolerances, "1", "1: all scales are tolerances"},
     {"covariance", &Result::covariance, kSquareUnit, "Covariance of the estimates"},
     {"correlation", &Result::correlation, "1", "Correlation of the estimates"},
     {"null_projector", &Result::null_projector, "1",
      "Projector on the directions that are not seen, in scaled numbers"},
     {"singular_values", &Result::singular_values, "1",
      "Singular values of the scaled matrix: signal of one tolerance over noise, along each direction"},
     {"conf_level", &Result::conf_level, "1", "Level of the intervals"},
     {"has_prior", &Result::has_prior, "1", "1: tolerances count as knowledge"},
     {"noise_is_known", &Result::noise_is_known, "1", "0: all noise is 0, so there are no intervals"},
     {"sd_is_estimated", &Result::sd_is_estimated, "1", "1: the noise is known up to one factor"},
     {"measured_at", &Result::measured_at, kMixedUnit, "Poses of the rows of the measurements, in their coordinates"},
     {"value_row", &Result::value_row, "1", "Position of the value's row in the measurements"},
     {"value_to", &Result::value_to, "1", "Position of the row to which a distance is measured; of others, their own"},
     {"measured", &Result::measured, kValueUnit, "Measured values"},
     {"value_sd", &Result::value_sd, kValueUnit, "Standard deviations of the values"},
     {"residual", &Result::residual, kValueUnit, "Measured less fitted values"},
     {"leverage", &Result::leverage, "1", "How far the fit follows each value, from 0 to 1"},
     {"standardised", &Result::standardised, "1", "Residuals over their own standard deviations"},
     {"outlier", &Result::outlier, "1", "1: the value is an outlier"},
     {"measured_poses", &Result::measured_poses, "1", "Rows of the measurements"},
     {"distances", &Result::distances, "1", "Distances among the values"},
     {"rms", &Result::rms, "1", "Root mean square of residuals over standard deviations"},
     {"chi_square", &Result::chi_square, "1", "Sum of squares, with that of the prior"},
     {"dof", &Result::dof, "1", "Its degrees of freedom"},
     {"p", &Result::p, "1", "Share of larger sums if nothing but noise is left"},
     {"outlier_limit", &Result::outlier_limit, "1", "Standardised residuals beyond it are outliers"},
     {"rank", &Result::rank, "1", "Directions of fitted errors that are seen"},
     {"frame_rank", &Result::frame_rank, "1", "Directions of frame and target that are seen"},
     {"below_noise", &Result::below_noise, "1", "Directions whose signal is below the noise"},
     {"unfitted", &Result::unfitted, "1", "Errors with a tolerance beyond the fitted ones"},
     {"steps", &Result::steps, "1", "Steps of the fit"},
     {"converged", &Result::converged, "1", "1: the fit converged; 0: no number of this result is to be used",
      Presence::where_computed},
     {"O1", &Result::O1, "1", "Observability index, scaled by the tolerances and the noise (Borm and Menq)"},
     {"O2", &Result::O2, "1", "Observability index, scaled (Driels and Pathre)"},
     {"O3", &Result::O3, "1", "Observability index, scaled (Nahvi, Hollerbach and Hayward)"},
     {"O4", &Result::O4, "1", "Observability index, scaled (Nahvi and Hollerbach)"},
     {"O5", &Result::O5, "1", "Observability index, scaled (Sun and Hollerbach)"},
     {"condition", &Result::condition, "1", "Largest over smallest singular value that is seen"},
     {"frame", &Result::frame, kMixedUnit, "Numbers of the unknown frame and target"},
     {"file", &Result::file, "1", "Name of the table of measurements"},
     {"file_text", &Result::file_text, "1", "The table of measurements"},
     {"file_sha256", &Result::file_sha256, "1", "SHA-256 of the table"}}};

const Group<Result> kLeft{
    "/calibration/left",
    "What the controller leaves that knows the estimates",
    {},
    {},
    {{"mean", &Result::left_mean, kMovedUnit, "Expected displacement of the platform from its commanded pose"},
     {"sd", &Result::left_sd, kMovedUnit, "Its standard deviation"},
     {"drive_shift", &Result::drive_shift, kMixedUnit, "By how much the controller moves the drives"},
     {"kept", &Result::kept, "1", "Share of machines, as far as this one is known, within all limits"},
     {"in_device_frame", &Result::left_in_device_frame, "1", "1: seen in the frame of the measuring device"}}};

const Group<Result> kNext{"/calibration/next",
                          "Poses that are worth measuring next",
                          {},
                          {},
                          {{"pose", &Result::next_pose, kMixedUnit, "The poses, in their coordinates"},
                           {"gain", &Result::gain, "1", "Information about the fitted errors beyond that before, bits"},
                           {"candidate", &Result::candidate, "1", "Positions among the candidates"}}};

const Group<Result> kController{
    "/calibration/controller",
    "Numbers to be typed into the controller",
    {},
    {},
    {{"nominal", &Result::typed_nominal, "SI: see /calibration/typed_unit", "Without errors"},
     {"present", &Result::typed_present, "SI: see /calibration/typed_unit", "While the machine was measured"},
     {"value", &Result::typed_value, "SI: see /calibration/typed_unit", "With the estimates"},
     {"sd", &Result::typed_sd, "SI: see /calibration/typed_unit", "Standard deviation"}}};

bool has_next(const Result& found) { return !found.gain.empty(); }
bool has_typed(const Result& found) { return !found.typed.empty(); }

void add_axes(ResultBuilder& result, const Result& found) {
  const std::vector<std::string> fitted = names_of(found.fitted);
  result.add_axis("fitted", fitted, {"1", "Name of the fitted error"});
  result.add_axis("with_fitted", fitted, {"1", "The same, for columns of a matrix"});
  result.add_axis("direction", axis_numbers(found.singular_values.size()), {"1", "Direction, by its singular value"});
  result.add_axis("measurement", found.rows, {"1", "Name of the row of the measurements"});
  result.add_axis("value", found.values, {"1", "Name of the measured value"});
  result.add_axis("frame_part", found.frame_parts, {"1", "Number of the frame and the target"});
  result.add_axis("moved", moved_names(), {"1", "Component of the displacement"});
  result.add_axis("drive", names_of(found.drives), {"1", "Name of the drive"});
  if (has_next(found))
    result.add_axis("next", axis_numbers(found.gain.size()), {"1", "Pose to measure, the best first"});
  if (has_typed(found)) result.add_axis("typed", names_of(found.typed), {"1", "Name in the controller"});
}

void add_texts(ResultBuilder& result, const Result& found) {
  result.add("/calibration/fitted_unit", {"fitted"}, texts(found.fitted, &NamedUnit::unit),
             {"1", "SI unit of the fitted error"});
  result.add("/calibration/value_unit", {"value"}, found.value_units, {"1", "SI unit of the measured value"});
  if (!has_typed(found)) return;
  result.add("/calibration/typed_unit", {"typed"}, texts(found.typed, &NamedUnit::unit),
             {"1", "SI unit of the number"});
  result.add("/calibration/expression", {"typed"}, texts(found.typed, &NamedUnit::description),
             {"1", "Expression of the number"});
}

void write(ResultBuilder& result, const Study& study, std::any& any) {
  const auto& found = std::any_cast<const Result&>(any);
  std::vector<FactorIndex> factors;
  for (const FittedErrors& fitted : study.analysis.calibration->fit) {
    for (const FactorIndex factor : fitted.factors) {
      if (std::ranges::find(factors, factor) == factors.end()) factors.push_back(factor);
    }
  }
  add_names(result, study, factors);
  std::vector<std::string> coordinates;
  for (const PoseCoordinate& own : study.model().pose_coordinates) coordinates.push_back(own.name);
  result.add_axis("coordinate", coordinates, {"1", "Coordinate of a pose"});
  add_axes(result, found);
  write_group(result, kCalibration, found);
  add_texts(result, found);
  write_group(result, kLeft, found);
  if (has_next(found)) write_group(result, kNext, found);
  if (has_typed(found)) write_group(result, kController, found);
}

std::vector<NamedUnit> named_units(const std::vector<std::string>& names, const std::vector<std::string>& units) {
  std::vector<NamedUnit> list;
  for (std::size_t n = 0; n < names.size(); ++n) list.push_back({names[n], units[n]});
  return list;
}

void read(const h5::File& file, StoredResult& result) {
  Result found;
  read_fields(file, "/calibration", kCalibration.fields, found);
  read_fields(file, "/calibration/left", kLeft.fields, found);
  found.fitted = named_units(file.read<std::string>("/fitted"),
                             read_along<std::string>(file, "/calibration/fitted_unit", {"fitted"}));
  found.values = file.read<std::string>("/value");
  found.value_units = read_along<std::string>(file, "/calibration/value_unit", {"value"});
  found.rows = file.read<std::string>("/measurement");
  found.frame_parts = file.read<std::string>("/frame_part");
  const std::vector<std::string> drives = file.read<std::string>("/drive");
  for (const std::string& drive : drives) found.drives.push_back({drive, std::string(kMixedUnit)});
  for (const auto* names :
       std::array<const std::vector<std::string>*, 4>{&found.values, &found.rows, &found.frame_parts, &drives}) {
    check_names(*names, "/calibration");
  }
  check_names(names_of(found.fitted), "/fitted");
  for (const auto* positions : {&found.value_row, &found.value_to}) {
    const bool is_known = std::ranges::all_of(*positions, [&](std::uint64_t at) { return at < found.rows.size(); });
    if (!is_known) throw h5::Error("/calibration has a value of an unknown row");
  }
  if (file.exists("/calibration/next")) read_fields(file, "/calibration/next", kNext.fields, found);
  if (file.exists("/calibration/controller")) {
    read_fields(file, "/calibration/controller", kController.fields, found);
    found.typed = named_units(file.read<std::string>("/typed"),
                              read_along<std::string>(file, "/calibration/typed_unit", {"typed"}));
    check_names(names_of(found.typed), "/typed");
    const auto expressions = read_along<std::string>(file, "/calibration/expression", {"typed"});
    for (std::size_t n = 0; n < found.typed.size(); ++n) found.typed[n].description = expressions[n];
  }
  result.found = std::move(found);
}

CsvTable estimates_table(const Result& found) {
  CsvTable table{"estimates", {"fitted", [&](std::size_t n) { return found.fitted[n].name; }}, found.fitted.size()};
  table.columns = {list_column("estimate [m or rad]", found.estimate), list_column("sd [m or rad]", found.sd),
                   list_column("low [m or rad]", found.low), list_column("high [m or rad]", found.high),
                   list_column("scale [m or rad]", found.scale)};
  return table;
}

CsvTable residuals_table(const Result& found) {
  CsvTable table{"residuals", {"value", [&](std::size_t i) { return found.values[i]; }}, found.values.size()};
  table.columns = {list_column("measured [m or rad]", found.measured), list_column("sd [m or rad]", found.value_sd),
                   list_column("residual [m or rad]", found.residual), list_column("leverage", found.leverage),
                   list_column("standardised", found.standardised),    list_column("outlier", found.outlier)};
  return table;
}

CsvTable correlation_table(const Result& found) {
  CsvTable table{"correlation", {"fitted", [&](std::size_t n) { return found.fitted[n].name; }}, found.fitted.size()};
  for (std::size_t j = 0; j < found.fitted.size(); ++j) {
    table.columns.push_back(
        {found.fitted[j].name, [&found, j](std::size_t n) { return to_number(found.correlation(n, j)); }});
  }
  return table;
}

CsvTable left_table(const StoredResult& result, const Result& found) {
  CsvTable table = lines_of_poses(result, "left");
  const std::vector<std::string> moved = moved_names();
  for (std::size_t c = 0; c < moved.size(); ++c) {
    const std::string unit = c < 3 ? "rad" : "m";
    table.columns.push_back(
        {with_unit(moved[c] + "_mean", unit), [&found, c](std::size_t m) { return to_number(found.left_mean(m, c)); }});
    table.columns.push_back(
        {with_unit(moved[c] + "_sd", unit), [&found, c](std::size_t m) { return to_number(found.left_sd(m, c)); }});
  }
  for (std::size_t d = 0; d < found.drives.size(); ++d) {
    table.columns.push_back({with_unit("shift_" + found.drives[d].name, kMixedUnit),
                             [&found, d](std::size_t m) { return to_number(found.drive_shift(m, d)); }});
  }
  return table;
}

CsvTable next_table(const StoredResult& result, const Result& found) {
  CsvTable table{"next", {"rank", [](std::size_t n) { return std::to_string(n + 1); }}, found.gain.size()};
  for (std::size_t c = 0; c < result.pose_coordinates.size(); ++c) {
    const NamedUnit& own = result.pose_coordinates[c];
    table.columns.push_back(
        {with_unit(own.name, own.unit), [&found, c](std::size_t n) { return to_number(found.next_pose(n, c)); }});
  }
  table.columns.push_back(list_column("gain [bit]", found.gain));
  table.columns.push_back(list_column("candidate", found.candidate));
  return table;
}

CsvTable controller_table(const Result& found) {
  CsvTable table{"controller", {"number", [&](std::size_t n) { return found.typed[n].name; }}, found.typed.size()};
  table.columns = {list_column("nominal [SI]", found.typed_nominal), list_column("present [SI]", found.typed_present),
                   list_column("value [SI]", found.typed_value), list_column("sd [SI]", found.typed_sd)};
  return table;
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  const Result& found = calibration_of(result);
  tables.push_back(estimates_table(found));
  tables.push_back(residuals_table(found));
  tables.push_back(correlation_table(found));
  tables.push_back(left_table(result, found));
  if (has_next(found)) tables.push_back(next_table(result, found));
  if (has_typed(found)) tables.push_back(controller_table(found));
}

}  // namespace

constinit const FileKind kFile{.write = write, .read = read, .append_tables = append_tables};

}  // namespace poesy::calibration
