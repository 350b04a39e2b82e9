#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <system_error>

#include "engine/base/error.h"
#include "engine/io/content_hash.h"
#include "engine/io/result_file.h"
#include "engine/io/result_format.h"
#include "engine/io/result_parts.h"
#include "engine/io/trial_read.h"
#include "engine/io/wording.h"

namespace poesy {
namespace {

constexpr const char* kOther = "give a result file written by poesy";
constexpr const char* kDamaged = "take another copy, or run the study again";

void check_readable(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw FileError(path, "is a folder", kOther);
  errno = 0;
  if (!std::ifstream(path)) {
    throw FileError(path, "cannot be read (" + std::generic_category().message(errno) + ")", kOther);
  }
}

h5::File open_hdf5(const std::string& path) {
  try {
    return h5::File::open(path);
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
    throw FileError(
        path,
        "is of format version " + std::to_string(version[0]) + "." + std::to_string(version[1]) +
            ", newer than this program's " + std::to_string(result_format::kMajor) + "." +
            std::to_string(result_format::kMinor),
        "use the poesy that wrote it (" + printable(text_attribute(file, "poesy_version")) + ") or a newer one");
  }
}

/// Opens a result file and gives what `use(file)` gives. Anything that HDF5 reports means a damaged file.
template <class Use>
auto use_result(const std::string& path, const Use& use) {
  const h5::File file = open_hdf5(path);
  if (!is_result(file)) throw FileError(path, "is an HDF5 file, but not a result of poesy", kOther);
  try {
    check_version(path, file);
    return use(file);
  } catch (const FileError&) {
    throw;
  } catch (const std::exception& error) {
    // Besides h5::Error: an empty list where a value should be, a shape too large for memory.
    // It may quote the file.
    throw FileError(path, "is damaged: " + printable(error.what(), 300), kDamaged);
  }
}

/// The same, but of a file over which HDF5 fails in any other way too: it is used in another process first.
template <class Use>
auto with_result(const std::string& path, const Use& use) {
  check_readable(path);
  trial_read(path, [&] {
    static_cast<void>(use_result(path, use));
    h5::close_library();
  });
  return use_result(path, use);
}

/// Names become names of files and cells of tables. Throws Error for one that cannot.
void check_names(const std::vector<std::string>& names, const std::string& path) {
  for (const std::string& name : names) {
    const bool fits = std::ranges::none_of(name, [](char c) { return c == '/' || c == ',' || (c >= 0 && c < ' '); });
    if (name.empty() || !fits) throw h5::Error("'" + name + "' in " + path + " is no name");
  }
}

std::vector<NamedUnit> read_named(const h5::File& file, const std::string& group, const std::string& axis) {
  const std::size_t count = axis_length(file, axis);
  const auto names = read_exactly<std::string>(file, group + "/name", count);
  const auto units = read_exactly<std::string>(file, group + "/unit", count);
  check_names(names, group + "/name");
  std::vector<NamedUnit> list;
  for (std::size_t k = 0; k < count; ++k) list.push_back({names[k], units[k]});
  return list;
}

void read_responses(const h5::File& file, StoredResult& result) {
  result.responses = read_named(file, "/responses", "response");
  const auto read_chosen = [&](const std::string& attribute, std::vector<std::size_t> otherwise) {
    if (!file.has_attribute("/responses", attribute)) return otherwise;
    std::vector<std::size_t> chosen;
    for (const std::string& name : file.attribute<std::string>("/responses", attribute)) {
      const auto found = std::ranges::find(result.responses, name, &NamedUnit::name);
      if (found == result.responses.end()) throw h5::Error("/responses " + attribute + " names an unknown response");
      chosen.push_back(static_cast<std::size_t>(found - result.responses.begin()));
    }
    return chosen;
  };
  std::vector<std::size_t> all(result.responses.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  result.headline = read_chosen("headline", all);
  result.signed_headline = read_chosen("signed_headline", result.headline);
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
  if (file.exists("/poses/time")) result.time = read_exactly<double>(file, "/poses/time", count);
  if (file.exists("/poses/condition")) result.condition = read_exactly<double>(file, "/poses/condition", count);
}

RunFacts read_facts(const h5::File& file) {
  const bool timed = file.exists("/run/checkpoint_seconds");  // not in files of older versions
  return {.created = file.read<std::string>("/run/created").at(0),
          .host = file.read<std::string>("/run/host").at(0),
          .cpu = file.read<std::string>("/run/cpu").at(0),
          .threads = file.read<std::uint64_t>("/run/threads").at(0),
          .ranks = file.read<std::uint64_t>("/run/ranks").at(0),
          .wall_seconds = file.read<double>("/run/wall_seconds").at(0),
          .checkpoint_seconds = timed ? file.read<double>("/run/checkpoint_seconds").at(0) : 0.0,
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
  read_responses(file, result);
  result.facts = read_facts(file);
  if (result.kind == result_format::kSensitivity) {
    read_sensitivity(file, result);
  } else if (result.kind == result_format::kEvaluate) {
    read_evaluation(file, result);
  } else if (result.kind == result_format::kIdentification) {
    read_identification(file, result);
  } else if (result.kind == result_format::kMonteCarlo) {
    read_monte_carlo(file, result);
  } else if (result.kind == result_format::kCoupling) {
    read_coupling(file, result);
  } else {
    throw h5::Error("its kind '" + result.kind + "' is unknown");
  }
  return result;
}

}  // namespace

const Unit& display(const NamedUnit& named) { return display_unit(dimension_of(named.unit)); }

StoredResult read_result(const std::string& path) {
  return with_result(path, [](const h5::File& file) { return read_all(file); });
}

Verification verify_result(const std::string& path) {
  return with_result(path, [](const h5::File& file) {
    return Verification{.stored = stored_hash(file), .computed = content_sha256(file)};
  });
}

}  // namespace poesy
