#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "engine/base/error.h"
#include "engine/io/content_hash.h"
#include "engine/io/h5_heap.h"
#include "engine/io/result_file.h"
#include "engine/io/result_format.h"

namespace poesy {
namespace {

constexpr const char* kOther = "give a result file written by poesy";
constexpr const char* kDamaged = "take another copy, or run the study again";

[[noreturn]] void fail_to_read(const std::string& path) {
  throw FileError(path, "cannot be read (" + std::generic_category().message(errno) + ")", kOther);
}

std::vector<std::byte> read_bytes(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw FileError(path, "is a folder", kOther);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail_to_read(path);
  std::vector<std::byte> bytes(std::filesystem::file_size(path, ignored));
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) fail_to_read(path);
  return bytes;
}

h5::File open_hdf5(const std::string& path) {
  const auto heap_problem = h5::damaged_heap(read_bytes(path));
  try {
    h5::File file = h5::File::open(path);
    if (heap_problem) throw FileError(path, "is damaged: " + *heap_problem, kDamaged);
    return file;
  } catch (const h5::Error& error) {
    throw FileError(path, std::string("is not an intact HDF5 file: ") + error.what(), kOther);
  }
}

bool is_result(const h5::File& file) {
  try {
    const std::vector<std::string> expected{std::string(result_format::kFileType)};
    return file.has_attribute("/", "filetype") && file.attribute<std::string>("/", "filetype") == expected;
  } catch (const h5::Error&) {
    return false;  // an attribute of that name, but not text
  }
}

std::string text_attribute(const h5::File& file, const std::string& name) {
  const auto values = file.attribute<std::string>("/", name);
  if (values.size() != 1) throw h5::Error("attribute '" + name + "' is not one text");
  return values.front();
}

void check_version(const std::string& path, const h5::File& file) {
  const auto version = file.attribute<std::int64_t>("/", "version");
  if (version.size() != 2) throw h5::Error("attribute 'version' is not two numbers");
  if (version[0] > result_format::kMajor) {
    throw FileError(path,
                    "is of format version " + std::to_string(version[0]) + "." + std::to_string(version[1]) +
                        ", newer than this program's " + std::to_string(result_format::kMajor) + "." +
                        std::to_string(result_format::kMinor),
                    "use the poesy that wrote it (" + text_attribute(file, "poesy_version") + ") or a newer one");
  }
}

/// Opens a result file and gives what `use(file)` gives. Anything HDF5 stumbles over means a damaged file.
template <class Use>
auto with_result(const std::string& path, const Use& use) {
  const h5::File file = open_hdf5(path);
  if (!is_result(file)) throw FileError(path, "is an HDF5 file, but not a result of poesy", kOther);
  try {
    check_version(path, file);
    return use(file);
  } catch (const FileError&) {
    throw;
  } catch (const std::exception& error) {
    // Besides h5::Error: an empty list where a value should be, a shape too large for memory.
    throw FileError(path, std::string("is damaged: ") + error.what(), kDamaged);
  }
}

/// All elements of a dataset that must have as many as its place in the result asks for.
template <class T>
std::vector<T> read_exactly(const h5::File& file, const std::string& path, std::size_t count) {
  if (h5::size(file.shape(path)) != count) throw h5::Error(path + " does not have the shape it should have");
  return file.read<T>(path);
}

std::size_t axis_length(const h5::File& file, const std::string& name) { return h5::size(file.shape("/" + name)); }

std::vector<NamedUnit> read_named(const h5::File& file, const std::string& group, const std::string& axis) {
  const std::size_t count = axis_length(file, axis);
  const auto names = read_exactly<std::string>(file, group + "/name", count);
  const auto units = read_exactly<std::string>(file, group + "/unit", count);
  std::vector<NamedUnit> list;
  for (std::size_t k = 0; k < count; ++k) list.push_back({names[k], units[k]});
  return list;
}

void read_poses(const h5::File& file, StoredResult& result) {
  const std::size_t count = axis_length(file, "pose");
  const auto names = file.attribute<std::string>("/poses", "coordinates");
  if (names.empty()) throw h5::Error("/poses has no coordinates");
  std::vector<double> values(count * names.size());
  for (std::size_t c = 0; c < names.size(); ++c) {
    const std::string path = "/poses/" + names[c];
    result.pose_coordinates.push_back({names[c], file.attribute<std::string>(path, "unit").at(0)});
    const auto column = read_exactly<double>(file, path, count);
    for (std::size_t m = 0; m < count; ++m) values[m * names.size() + c] = column[m];
  }
  result.poses = PoseSet(names.size(), std::move(values));
  if (file.exists("/poses/condition")) result.condition = read_exactly<double>(file, "/poses/condition", count);
}

std::vector<SolveCounts> read_solves(const h5::File& file, std::size_t cells) {
  const auto by_status = read_exactly<std::uint64_t>(file, "/solver/solves_by_status", kStatusNames.size() * cells);
  const auto mean = read_exactly<double>(file, "/solver/iterations_mean", cells);
  const auto most = read_exactly<std::uint32_t>(file, "/solver/iterations_max", cells);
  std::vector<SolveCounts> solves(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    SolveCounts& counts = solves[cell];
    for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
      counts.by_status[status] = by_status[status * cells + cell];
    }
    // The mean is the sum over the total, so this gives back the sum exactly; without samples it is NaN.
    if (counts.total() > 0) {
      counts.iterations = static_cast<std::uint64_t>(std::llround(mean[cell] * static_cast<double>(counts.total())));
    }
    counts.most_iterations = most[cell];
  }
  return solves;
}

SensitivityResult read_sensitivity(const h5::File& file) {
  SensitivityResult found;
  found.responses = axis_length(file, "response");
  found.factors = axis_length(file, "factor");
  found.poses = axis_length(file, "pose");
  found.conf_level = file.attribute<double>("/sensitivity", "conf_level").at(0);
  const std::size_t pairs = found.responses * found.factors;
  const auto read = [&](const char* name, std::size_t count) {
    return read_exactly<double>(file, std::string("/sensitivity/") + name, count);
  };
  found.local = read("local", pairs * found.poses);
  found.local_ci_low = read("local_ci_low", pairs * found.poses);
  found.local_ci_high = read("local_ci_high", pairs * found.poses);
  found.count = read("count", pairs * found.poses);
  found.mean = read("mean", pairs * found.poses);
  found.std = read("std", pairs * found.poses);
  found.global = read("global", pairs);
  found.global_ci_low = read("global_ci_low", pairs);
  found.global_ci_high = read("global_ci_high", pairs);
  found.solves = read_solves(file, found.factors * found.poses);
  return found;
}

std::vector<Detail> read_details(const h5::File& file) {
  std::vector<Detail> details;
  if (!file.has_attribute("/evaluate", "details")) return details;
  for (const std::string& name : file.attribute<std::string>("/evaluate", "details")) {
    const std::string path = "/evaluate/" + name;
    details.push_back({.name = name,
                       .components = file.attribute<std::string>(path, "components"),
                       .unit = file.attribute<std::string>(path, "unit").at(0),
                       .description = file.attribute<std::string>(path, "description").at(0)});
  }
  return details;
}

void read_detail_values(const h5::File& file, const std::vector<Detail>& details, EvaluationResult& found) {
  for (const Detail& detail : details) found.details += detail.components.size();
  const std::size_t rows = found.poses * found.samples;
  found.detail.resize(rows * found.details);
  std::size_t first = 0;
  for (const Detail& detail : details) {
    const std::size_t width = detail.components.size();
    const auto values = read_exactly<double>(file, "/evaluate/" + detail.name, rows * width);
    for (std::size_t k = 0; k < values.size(); ++k) {
      found.detail[k / width * found.details + first + k % width] = values[k];
    }
    first += width;
  }
}

std::vector<SolveStatus> read_status(const h5::File& file, std::size_t rows) {
  std::vector<SolveStatus> list;
  for (const std::uint8_t code : read_exactly<std::uint8_t>(file, "/evaluate/status", rows)) {
    if (code >= kStatusNames.size()) throw h5::Error("/evaluate/status holds an unknown status");
    list.push_back(static_cast<SolveStatus>(code));
  }
  return list;
}

EvaluationResult read_evaluation(const h5::File& file, const std::vector<NamedUnit>& responses,
                                 const std::vector<Detail>& details) {
  EvaluationResult found;
  found.poses = axis_length(file, "pose");
  found.samples = axis_length(file, "sample");
  found.responses = responses.size();
  const std::size_t rows = found.poses * found.samples;
  for (const NamedUnit& response : responses) {
    const auto values = read_exactly<double>(file, "/evaluate/" + response.name, rows);
    found.response.insert(found.response.end(), values.begin(), values.end());
  }
  read_detail_values(file, details, found);
  found.status = read_status(file, rows);
  found.iterations = read_exactly<std::uint32_t>(file, "/evaluate/iterations", rows);
  found.joint_displacement =
      read_exactly<double>(file, "/evaluate/joint_displacements", found.poses * axis_length(file, "joint"));
  return found;
}

void read_evaluate_kind(const h5::File& file, StoredResult& result) {
  result.details = read_details(file);
  result.joints = file.read<std::string>("/joint");
  result.evaluation = read_evaluation(file, result.responses, result.details);
  const bool row_by_row = file.attribute<std::string>("/errors", "pairing").at(0) == result_format::kRowByRow;
  result.pairing = row_by_row ? Pairing::row_by_row : Pairing::every_pose_with_every_row;
  const std::size_t rows = row_by_row ? result.evaluation.poses : result.evaluation.samples;
  result.errors = read_exactly<double>(file, "/errors/values", rows * result.factors.size());
}

RunFacts read_facts(const h5::File& file) {
  return {.created = file.read<std::string>("/run/created").at(0),
          .host = file.read<std::string>("/run/host").at(0),
          .cpu = file.read<std::string>("/run/cpu").at(0),
          .threads = file.read<std::uint64_t>("/run/threads").at(0),
          .ranks = file.read<std::uint64_t>("/run/ranks").at(0),
          .wall_seconds = file.read<double>("/run/wall_seconds").at(0),
          .solves = file.read<std::uint64_t>("/run/solves").at(0)};
}

std::string stored_hash(const h5::File& file) {
  return file.has_attribute("/", "content_sha256") ? text_attribute(file, "content_sha256") : "";
}

StoredResult read_all(const h5::File& file) {
  StoredResult result;
  result.kind = text_attribute(file, "kind");
  result.title = text_attribute(file, "title");
  result.model = text_attribute(file, "model");
  result.poesy_version = text_attribute(file, "poesy_version");
  result.content_sha256 = stored_hash(file);
  result.study_text = file.read<std::string>("/study/text").at(0);
  read_poses(file, result);
  result.factors = read_named(file, "/factors", "factor");
  result.responses = read_named(file, "/responses", "response");
  result.facts = read_facts(file);
  if (result.kind == result_format::kSensitivity) {
    result.factor_sigma = read_exactly<double>(file, "/factors/sigma", result.factors.size());
    result.sensitivity = read_sensitivity(file);
  } else if (result.kind == result_format::kEvaluate) {
    read_evaluate_kind(file, result);
  } else {
    throw h5::Error("its kind '" + result.kind + "' is unknown");
  }
  return result;
}

}  // namespace

StoredResult read_result(const std::string& path) {
  return with_result(path, [](const h5::File& file) { return read_all(file); });
}

Verification verify_result(const std::string& path) {
  return with_result(path, [](const h5::File& file) {
    return Verification{.stored = stored_hash(file), .computed = content_sha256(file)};
  });
}

}  // namespace poesy
