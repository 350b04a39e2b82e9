#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <system_error>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/io/file_writer.h"
#include "engine/io/result_file.h"
#include "engine/io/result_format.h"

namespace poesy {
namespace {

std::string cell(double value) { return std::isnan(value) ? "NaN" : shortest(value); }

std::string column(const std::string& name, const std::string& unit) {
  return unit == "1" ? name : name + " [" + unit + "]";
}

/// One CSV file.
class Table {
 public:
  Table(const std::string& path, const std::vector<std::string>& columns) : writer_(path) {
    for (const std::string& name : columns) text_ += (text_.empty() ? "" : ",") + name;
    text_ += '\n';
  }

  void row(const std::string& first, std::span<const double> rest) {
    text_ += first;
    for (const double value : rest) {
      text_ += ',';
      text_ += cell(value);
    }
    text_ += '\n';
    constexpr std::size_t kChunk = 1 << 20;
    if (text_.size() > kChunk) flush();
  }

  void commit() {
    flush();
    writer_.commit();
  }

 private:
  void flush() {
    writer_.write(text_);
    text_.clear();
  }

  FileWriter writer_;
  std::string text_;
};

/// The unit in which people read an SI unit: "mm" for "m".
const Unit& display(const std::string& si_unit_name) {
  for (const Unit& unit : units()) {
    if (unit.name == si_unit_name) return display_unit(unit.dimension);
  }
  return display_unit(Dimension::number);
}

/// "m", or "m or rad" where factors differ.
template <class UnitName>
std::string units_of(const std::vector<NamedUnit>& things, const UnitName& unit_name) {
  std::vector<std::string> seen;
  for (const NamedUnit& thing : things) {
    const std::string unit(unit_name(thing.unit));
    if (std::ranges::find(seen, unit) == seen.end()) seen.push_back(unit);
  }
  std::string text;
  for (const std::string& unit : seen) text += (text.empty() ? "" : " or ") + unit;
  return text;
}

const auto kSi = [](const std::string& unit) { return unit; };
const auto kDisplay = [](const std::string& unit) { return std::string(display(unit).name); };

/// "rad,rad,m" as a unit for each of `count` components; one unit may stand for all.
std::vector<std::string> component_units(const std::string& text, std::size_t count) {
  std::vector<std::string> list;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    list.push_back(text.substr(begin, comma - begin));
    begin = comma + 1;
  }
  if (list.size() != count) list.assign(count, list.size() == 1 ? list.front() : text);
  return list;
}

class Exporter {
 public:
  Exporter(const StoredResult& result, std::filesystem::path folder) : result_(&result), folder_(std::move(folder)) {}

  std::vector<std::string> operator()() {
    write_poses();
    if (result_->kind == result_format::kSensitivity) {
      write_sensitivity_tables();
    } else {
      write_evaluation_tables();
    }
    return std::move(files_);
  }

 private:
  template <class Fill>
  void write(const std::string& name, const std::vector<std::string>& columns, const Fill& fill) {
    const std::string path = (folder_ / (name + ".csv")).string();
    Table table(path, columns);
    fill(table);
    table.commit();
    files_.push_back(path);
  }

  void write_poses() {
    std::vector<std::string> columns{"pose"};
    for (const NamedUnit& coordinate : result_->pose_coordinates) {
      columns.push_back(column(coordinate.name, coordinate.unit));
    }
    if (!result_->condition.empty()) columns.push_back("condition");
    write("poses", columns, [&](Table& table) {
      for (std::size_t m = 0; m < result_->poses.size(); ++m) {
        const auto pose = result_->poses[PoseIndex(m)];
        std::vector<double> row(pose.begin(), pose.end());
        if (!result_->condition.empty()) row.push_back(result_->condition[m]);
        table.row(std::to_string(m), row);
      }
    });
  }

  void write_sensitivity_tables() {
    const SensitivityResult& found = result_->sensitivity;
    write_factors();
    write_global();
    const auto index_unit = [&](const NamedUnit& response) {
      return response.unit + " per " + units_of(result_->factors, kSi);
    };
    const auto response_unit = [](const NamedUnit& response) { return response.unit; };
    const auto no_unit = [](const NamedUnit&) { return std::string("1"); };
    write_local("local", found.local, index_unit);
    write_local("local_ci_low", found.local_ci_low, index_unit);
    write_local("local_ci_high", found.local_ci_high, index_unit);
    write_local("count", found.count, no_unit);
    write_local("mean", found.mean, response_unit);
    write_local("std", found.std, response_unit);
    write_solver();
  }

  void write_factors() {
    const std::vector<std::string> columns{"factor", column("sigma", units_of(result_->factors, kSi)),
                                           column("sigma", units_of(result_->factors, kDisplay))};
    write("factors", columns, [&](Table& table) {
      for (std::size_t p = 0; p < result_->factors.size(); ++p) {
        const double sigma = result_->factor_sigma[p];
        table.row(result_->factors[p].name, std::vector{sigma, sigma / display(result_->factors[p].unit).si});
      }
    });
  }

  std::vector<std::string> global_columns() const {
    std::vector<std::string> columns{"factor"};
    for (const NamedUnit& response : result_->responses) {
      for (const std::string& unit : {response.unit + " per " + units_of(result_->factors, kSi),
                                      kDisplay(response.unit) + " per " + units_of(result_->factors, kDisplay)}) {
        for (const char* what : {"", "_ci_low", "_ci_high"}) columns.push_back(column(response.name + what, unit));
      }
    }
    return columns;
  }

  void write_global() {
    const SensitivityResult& found = result_->sensitivity;
    write("global", global_columns(), [&](Table& table) {
      for (std::size_t p = 0; p < found.factors; ++p) {
        std::vector<double> row;
        for (std::size_t r = 0; r < found.responses; ++r) {
          const std::size_t at = r * found.factors + p;
          const double to_display = display(result_->factors[p].unit).si / display(result_->responses[r].unit).si;
          for (const double scale : {1.0, to_display}) {
            row.insert(row.end(),
                       {found.global[at] * scale, found.global_ci_low[at] * scale, found.global_ci_high[at] * scale});
          }
        }
        table.row(result_->factors[p].name, row);
      }
    });
  }

  /// A table with a row for each factor and a column for each pose, from values [P x M].
  void write_cells(const std::string& name, std::span<const double> values, const std::string& unit) {
    const std::size_t poses = result_->sensitivity.poses;
    std::vector<std::string> columns{"factor"};
    for (std::size_t m = 0; m < poses; ++m) columns.push_back(column("pose_" + std::to_string(m), unit));
    write(name, columns, [&](Table& table) {
      for (std::size_t p = 0; p < result_->factors.size(); ++p) {
        table.row(result_->factors[p].name, values.subspan(p * poses, poses));
      }
    });
  }

  template <class UnitOf>
  void write_local(const std::string& name, std::span<const double> values, const UnitOf& unit_of) {
    const std::size_t cells = result_->sensitivity.factors * result_->sensitivity.poses;
    for (std::size_t r = 0; r < result_->responses.size(); ++r) {
      const NamedUnit& response = result_->responses[r];
      write_cells(name + "_" + response.name, values.subspan(r * cells, cells), unit_of(response));
    }
  }

  template <class Get>
  void write_counts(const std::string& name, const Get& get) {
    std::vector<double> values;
    for (const SolveCounts& counts : result_->sensitivity.solves) values.push_back(static_cast<double>(get(counts)));
    write_cells(name, values, "1");
  }

  void write_solver() {
    write_counts("not_converged", [](const SolveCounts& counts) { return counts.not_converged(); });
    write_counts("iterations_mean", [](const SolveCounts& counts) {
      return static_cast<double>(counts.iterations) / static_cast<double>(counts.total());
    });
    write_counts("iterations_max", [](const SolveCounts& counts) { return counts.most_iterations; });
    for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
      write_counts("solves_" + std::string(kStatusNames[status]),
                   [status](const SolveCounts& counts) { return counts.by_status[status]; });
    }
  }

  void write_evaluation_tables() {
    write_solves();
    write_joints();
    write_errors();
  }

  std::vector<std::string> solve_columns() const {
    std::vector<std::string> columns{"pose", "sample"};
    for (const NamedUnit& response : result_->responses) columns.push_back(column(response.name, response.unit));
    for (const Detail& detail : result_->details) {
      const auto units = component_units(detail.unit, detail.components.size());
      for (std::size_t k = 0; k < units.size(); ++k) {
        columns.push_back(column(detail.name + "_" + detail.components[k], units[k]));
      }
    }
    columns.insert(columns.end(), {"status", "iterations"});
    return columns;
  }

  void write_solves() {
    const EvaluationResult& found = result_->evaluation;
    write("evaluate", solve_columns(), [&](Table& table) {
      for (std::size_t at = 0; at < found.status.size(); ++at) {
        std::vector<double> row{static_cast<double>(at % found.samples)};
        for (std::size_t r = 0; r < found.responses; ++r) row.push_back(found.response[r * found.status.size() + at]);
        const auto detail = std::span(found.detail).subspan(at * found.details, found.details);
        row.insert(row.end(), detail.begin(), detail.end());
        row.push_back(static_cast<double>(found.status[at]));
        row.push_back(found.iterations[at]);
        table.row(std::to_string(at / found.samples), row);
      }
    });
  }

  void write_joints() {
    std::vector<std::string> columns{"pose"};
    for (const std::string& joint : result_->joints) columns.push_back(column(joint, "rad or m"));
    write_rows("joint_displacements", columns, result_->evaluation.joint_displacement);
  }

  void write_errors() {
    std::vector<std::string> columns{result_->pairing == Pairing::row_by_row ? "pose" : "sample"};
    for (const NamedUnit& factor : result_->factors) columns.push_back(column(factor.name, factor.unit));
    write_rows("errors", columns, result_->errors);
  }

  /// A table of numbered rows, from values row by row.
  void write_rows(const std::string& name, const std::vector<std::string>& columns, std::span<const double> values) {
    const std::size_t width = columns.size() - 1;
    write(name, columns, [&](Table& table) {
      for (std::size_t row = 0; (row + 1) * width <= values.size() && width > 0; ++row) {
        table.row(std::to_string(row), values.subspan(row * width, width));
      }
    });
  }

  const StoredResult* result_;
  std::filesystem::path folder_;
  std::vector<std::string> files_;
};

}  // namespace

std::vector<std::string> export_tables(const std::string& result_path, const std::string& folder) {
  const StoredResult result = read_result(result_path);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder, "cannot be made (" + error.message() + ")", "choose another folder");
  return Exporter(result, folder)();
}

}  // namespace poesy
