#include <algorithm>
#include <numeric>

#include "engine/io/content_hash.h"
#include "engine/io/poesy_file.h"
#include "engine/io/result_file.h"
#include "engine/io/result_format.h"
#include "engine/io/result_parts.h"

namespace poesy {
namespace {

std::vector<NamedUnit> read_named(const h5::File& file, const std::string& group, const std::string& axis) {
  const std::size_t count = axis_length(file, axis);
  const auto names = read_exactly<std::string>(file, group + "/name", count);
  const auto units = read_exactly<std::string>(file, group + "/unit", count);
  check_names(names, group + "/name");
  std::vector<std::string> descriptions(count);
  if (file.exists(group + "/description")) {
    descriptions = read_exactly<std::string>(file, group + "/description", count);
  }
  std::vector<NamedUnit> list;
  for (std::size_t k = 0; k < count; ++k) list.push_back({names[k], units[k], descriptions[k]});
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

StoredResult read_all(const h5::File& file) {
  StoredResult result;
  result.kind = text_attribute(file, "kind");
  result.title = text_attribute(file, "title");
  result.model = text_attribute(file, "model");
  result.poesy_version = text_attribute(file, "poesy_version");
  result.git_commit = text_attribute(file, "git_commit");
  result.content_sha256 = stored_hash(file);
  result.changed = result.content_sha256 != content_sha256(file);
  result.study_text = file.read<std::string>("/study/text").at(0);
  result.pose_coordinates = read_pose_coordinates(file);
  SelectedPoses poses = read_poses(file);
  result.poses = std::move(poses.poses);
  result.condition = std::move(poses.condition);
  result.time = std::move(poses.time);
  result.factors = read_named(file, "/factors", "factor");
  read_responses(file, result);
  read_metric(file, result);
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

void check_names(const std::vector<std::string>& names, const std::string& path) {
  for (const std::string& name : names) {
    const bool fits = std::ranges::none_of(name, [](char c) { return c == '/' || c == ',' || (c >= 0 && c < ' '); });
    if (name.empty() || !fits) throw h5::Error("'" + name + "' in " + path + " is no name");
  }
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

const Unit& display(const NamedUnit& named) { return display_unit(dimension_of(named.unit)); }

StoredResult read_result(const std::string& path) {
  return with_poesy_file(path, [&](const h5::File& file) {
    expect_filetype(path, file, result_format::kFileType);
    return read_all(file);
  });
}

Verification verify_result(const std::string& path) {
  return with_poesy_file(path, [](const h5::File& file) {
    return Verification{.stored = stored_hash(file), .computed = content_sha256(file)};
  });
}

}  // namespace poesy
