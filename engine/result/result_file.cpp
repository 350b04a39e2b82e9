#include "engine/result/result_file.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "engine/base/array.h"
#include "engine/base/error.h"
#include "engine/result/described.h"
#include "engine/result/drawing_parts.h"
#include "engine/result/headline.h"
#include "engine/result/result_parts.h"
#include "engine/storage/checkpoint.h"
#include "engine/storage/content_hash.h"
#include "engine/storage/file_writer.h"
#include "engine/storage/output_folder.h"
#include "engine/storage/poesy_file.h"
#include "engine/storage/version.h"
#include "engine/study/study_file.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

const Fields<SelectedPoses> kPoseFields{
    {"time", &SelectedPoses::time, kByPose, "s", "When the trajectory reaches the pose", Presence::where_computed},
    {"condition", &SelectedPoses::condition, kByPose, "1",
     "Condition number of the passive joints' Jacobian; infinity at a singular pose"}};

const Fields<RejectedPoses> kRejectedFields{
    {"reason", &RejectedPoses::reason, {"rejection"}, "1", "Why poses were rejected"},
    {"count", &RejectedPoses::count, {"rejection"}, "1", "Candidate poses rejected for this reason"}};

const std::string kCandidates = "candidates";  ///< attribute: number of examined poses, rejected or not

const Axes kScalar{};

const Fields<RunFacts> kFactFields{
    {"created", &RunFacts::created, kScalar, "1", "When the run ended (UTC, ISO 8601)"},
    {"host", &RunFacts::host, kScalar, "1", "Name of the machine"},
    {"cpu", &RunFacts::cpu, kScalar, "1", "Its processor"},
    {"threads", &RunFacts::threads, kScalar, "1", "Threads, of all ranks together"},
    {"ranks", &RunFacts::ranks, kScalar, "1", "MPI ranks"},
    {"wall_seconds", &RunFacts::wall_seconds, kScalar, "s", "Time the solves took"},
    {"checkpoint_seconds", &RunFacts::checkpoint_seconds, kScalar, "s", "Of that time, spent on checkpoints"},
    {"solves", &RunFacts::solves, kScalar, "1", "Samples that were solved, not computed from certified series"}};

/// The fields with the names, units and descriptions of things along an axis. what: the word for such a thing in the
/// descriptions of the datasets, such as "error" for the axis "factor".
Fields<NamedUnit> name_fields(const std::string& axis, const std::string& what) {
  return {{"name", &NamedUnit::name, {axis}, "1", "Name of the " + what},
          {"unit", &NamedUnit::unit, {axis}, "1", "SI unit of the " + what},
          {"description", &NamedUnit::description, {axis}, "1", "What the " + what + " is, in words"}};
}

template <class Thing>
NamedUnit named(const Thing& thing) {
  return {thing.name, unit_of(thing), thing.description};
}

void add_named(ResultBuilder& result, const std::string& axis, const std::string& what,
               const std::vector<NamedUnit>& things) {
  const std::string group = "/" + axis + "s";
  result.add_axis(axis, texts(things, &NamedUnit::name), {"1", "Name of the " + what});
  result.file().make_group(group);
  write_columns(result, group, name_fields(axis, what), things);
}

std::vector<NamedUnit> read_named(const h5::File& file, const std::string& axis) {
  const std::string group = "/" + axis + "s";
  std::vector<NamedUnit> things = read_columns(file, group, name_fields(axis, ""));
  check_names(texts(things, &NamedUnit::name), group + "/name");
  return things;
}

void add_responses(ResultBuilder& result, const ModelDescription& model) {
  const std::vector<NamedUnit> responses = named_responses(model);
  add_named(result, "response", "response", responses);
  const auto add_chosen = [&](const std::string& attribute, const std::vector<std::size_t>& chosen) {
    const auto list = texts(chosen, [&](std::size_t r) { return responses[r].name; });
    if (!list.empty()) result.file().set_attribute("/responses", attribute, std::span(list));
  };
  add_chosen("headline", model.headline);
  add_chosen("signed_headline", model.signed_headline);
}

void read_responses(const h5::File& file, StoredResult& result) {
  result.responses = read_named(file, "response");
  const auto read_chosen = [&](const std::string& attribute) {
    std::vector<std::size_t> chosen;
    if (!file.has_attribute("/responses", attribute)) return chosen;
    for (const std::string& name : file.attribute<std::string>("/responses", attribute)) {
      chosen.push_back(position_in(result.responses, name, "/responses " + attribute + " names an unknown response",
                                   &NamedUnit::name));
    }
    return chosen;
  };
  result.headline = chosen_or_all(read_chosen("headline"), result.responses.size());
  result.signed_headline = read_chosen("signed_headline");
  if (result.signed_headline.empty()) result.signed_headline = result.headline;
}

constexpr std::string_view kMetricMeaning =
    "How mismatch of angle is weighed against mismatch of position. platform: by the root mean square displacement of "
    "points of the platform; published: radians against metres at the origin of the base frame";

void add_metric(ResultBuilder& result, const Study& study) {
  if (study.model().metric.empty()) return;
  result.file().make_group("/metric");
  result.file().set_attribute("/metric", "name", study.model().metric);
  result.file().set_attribute("/metric", "description", std::string(kMetricMeaning));
  const std::vector<PlatformPoint> points = build_model(study.mechanism)->metric_points();
  if (points.empty()) return;
  const Axes axes{"metric_point", "axis"};
  std::vector<double> values;
  for (const PlatformPoint& point : points) values.insert(values.end(), point.begin(), point.end());
  result.add_axis("metric_point", axis_numbers(points.size()), {"1", "Number of the point, from 0"});
  result.add_axis("axis", std::vector<std::string>{"x", "y", "z"}, {"1", "Axis of the platform's frame"});
  result.show_axes("/metric", axes);
  result.add("/metric/points", axes, values,
             {"m", "Points of the platform by whose displacement mismatch is judged, in its frame"});
}

void read_metric(const h5::File& file, StoredResult& result) {
  if (!file.exists("/metric")) return;
  result.metric = file.attribute<std::string>("/metric", "name").at(0);
  if (!file.exists("/metric/points")) return;
  const auto values = read_along<double>(file, "/metric/points", {"metric_point", "axis"});
  if (axis_length(file, "axis") != 3) throw h5::Error("/axis does not have three names");
  result.metric_points.resize(values.size() / 3);
  for (std::size_t k = 0; k < values.size(); ++k) result.metric_points[k / 3][k % 3] = values[k];
}

void add_poses(ResultBuilder& result, const ModelDescription& model, const SelectedPoses& selected) {
  result.add_axis("pose", axis_numbers(selected.poses.size()), {"1", "Number of the pose, from 0"});
  result.file().make_group("/poses");
  const std::vector<NamedUnit> coordinates = named_coordinates(model);
  const auto names = texts(coordinates, &NamedUnit::name);
  result.file().set_attribute("/poses", "coordinates", std::span(names));
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    const NamedUnit& coordinate = coordinates[c];
    result.add("/poses/" + coordinate.name, {"pose"}, selected.poses.column(c),
               {coordinate.unit, coordinate.description});
  }
  write_fields(result, "/poses", kPoseFields, selected);
  if (selected.rejected.empty()) return;
  result.add_axis("rejection", texts(selected.rejected, &RejectedPoses::reason), {"1", "Why poses were rejected"});
  result.file().make_group("/poses/rejected");
  result.show_axes("/poses/rejected", {"rejection"});
  write_columns(result, "/poses/rejected", kRejectedFields, selected.rejected);
  if (selected.candidates > 0) result.file().set_attribute("/poses/rejected", kCandidates, selected.candidates);
}

std::vector<NamedUnit> read_pose_coordinates(const h5::File& file) {
  std::vector<NamedUnit> coordinates;
  for (const std::string& name : file.attribute<std::string>("/poses", "coordinates")) {
    coordinates.push_back({name, file.attribute<std::string>("/poses/" + name, "unit").at(0),
                           file.attribute<std::string>("/poses/" + name, "description").at(0)});
  }
  if (coordinates.empty()) throw h5::Error("/poses has no coordinates");
  return coordinates;
}

void add_header(ResultBuilder& result, std::string_view filetype, std::string_view kind, const Study& study,
                const SelectedPoses& poses) {
  h5::File& file = result.file();
  const std::vector<std::int64_t> version{kMajorVersion, kMinorVersion};
  file.set_attribute("/", "filetype", std::string(filetype));
  file.set_attribute("/", "version", std::span(version));
  file.set_attribute("/", "kind", std::string(kind));
  file.set_attribute("/", "title", study.title);
  file.set_attribute("/", "model", study.model().name);
  file.set_attribute("/", "poesy_version", poesy_version());
  file.set_attribute("/", "git_commit", git_commit());
  file.make_group("/study");
  result.add_scalar("/study/text", resolved_text(study), {"1", "The study, every default filled in (TOML)"});
  if (const std::optional<MechanismText>& own = study.mechanism.file) {
    file.make_group("/mechanism");
    result.add_scalar("/mechanism/text", own->text, {"1", "The file that describes the mechanism (TOML)"});
    file.set_attribute("/mechanism", "file", own->name);
    file.set_attribute("/mechanism", "sha256", hex(sha256(std::as_bytes(std::span(own->text)))));
  }
  add_poses(result, study.model(), poses);
}

void add_facts(ResultBuilder& result, const RunFacts& facts) {
  h5::File& file = result.file();
  file.make_group("/run");
  file.set_attribute("/run", "description", std::string("Facts about this run; not part of the content hash"));
  file.set_attribute("/run", "version_hdf5", h5::library_version());
  for (const LibraryVersion& library : build_versions()) {
    file.set_attribute("/run", "version_" + std::string(library.name), std::string(library.version));
  }
  write_fields(result, "/run", kFactFields, facts);
  result.add_scalar("/run/all_samples", facts.samples(), {"1", "Samples, solved or by series"});
  const double rate = facts.wall_seconds > 0.0 ? static_cast<double>(facts.samples()) / facts.wall_seconds : 0.0;
  result.add_scalar("/run/samples_per_second", rate, {"1/s", "Samples a second, all threads and ranks together"});
}

/// Writes a whole file into `result`. compose(result) adds the parts between the header and the facts of the run.
void compose_all(ResultBuilder& result, std::string_view filetype, std::string_view kind, const Study& study,
                 const SelectedPoses& poses, const RunFacts& facts,
                 const std::function<void(ResultBuilder&)>& compose) {
  add_header(result, filetype, kind, study, poses);
  compose(result);
  add_facts(result, facts);
  result.file().set_attribute("/", "content_sha256", content_sha256(result.file()));
}

/// Returns a function that writes the parts that a result of this kind has in addition to the header.
std::function<void(ResultBuilder&)> parts_of(const FileKind& kind, const Study& study, std::any& found,
                                             const DrawingResult* drawing) {
  return [&kind, &study, &found, drawing](ResultBuilder& result) {
    kind.write(result, study, found);
    if (drawing != nullptr) write_drawing(result, *drawing);
  };
}

/// Reads the parts of a result that follow its header.
void read_parts(const h5::File& file, const FileKind& kind, StoredResult& result) {
  kind.read(file, result);
  if (file.exists("/drawing")) result.drawing = read_drawing(file);
  order_headline(result);
}

/// Returns true if a new result may replace the file at this path: the file is an older result or shard, even a damaged
/// one, or is empty. The attribute `filetype`, by which it is recognised, is in the first 64 KiB.
bool may_be_replaced(const std::string& path) { return is_marked(path, kResultFile) || has_mark(path, kShardFile); }

}  // namespace

void check_names(std::span<const std::string> names, const std::string& path) {
  for (const std::string& name : names) {
    const bool fits = std::ranges::none_of(name, [](char c) { return c == '/' || c == ',' || (c >= 0 && c < ' '); });
    if (name.empty() || !fits) throw h5::Error("'" + name + "' in " + path + " is not a name");
  }
}

void compose_file(const std::string& path, std::string_view filetype, std::string_view kind, const Study& study,
                  const SelectedPoses& poses, const RunFacts& facts,
                  const std::function<void(ResultBuilder&)>& compose) {
  FileWriter writer(path);
  try {
    ResultBuilder result(h5::File::on_disk(writer));
    compose_all(result, filetype, kind, study, poses, facts, compose);
    result.file().close();
  } catch (const h5::Error& error) {
    writer.check();
    if (is_out_of_memory(error)) throw std::bad_alloc();
    throw FileError(path, std::string("cannot be composed: ") + error.what(), "report this as a bug of poesy");
  }
  writer.commit();
}

void add_names(ResultBuilder& result, const Study& study, std::span<const FactorIndex> factors) {
  add_metric(result, study);
  std::vector<NamedUnit> errors;
  for (const FactorIndex factor : factors) errors.push_back(named(study.model().factors[factor.value]));
  add_named(result, "factor", "error", errors);
  add_responses(result, study.model());
}

void read_header(const h5::File& file, StoredResult& result) {
  result.kind = text_attribute(file, "kind");
  result.title = text_attribute(file, "title");
  result.model = text_attribute(file, "model");
  result.poesy_version = text_attribute(file, "poesy_version");
  result.git_commit = text_attribute(file, "git_commit");
  result.content_sha256 = stored_hash(file);
  result.changed = result.content_sha256 != content_sha256(file);
  result.study_text = file.read<std::string>("/study/text").at(0);
  result.mechanism_text = mechanism_text(file);
  result.pose_coordinates = read_pose_coordinates(file);
  SelectedPoses poses = read_poses(file);
  result.poses = std::move(poses.poses);
  result.condition = std::move(poses.condition);
  result.time = std::move(poses.time);
  result.rejected = std::move(poses.rejected);
  result.candidates = poses.candidates;
  result.factors = read_named(file, "factor");
  read_responses(file, result);
  read_metric(file, result);
  result.facts = read_facts(file);
}

SelectedPoses read_poses(const h5::File& file) {
  const std::size_t count = axis_length(file, "pose");
  const std::vector<NamedUnit> coordinates = read_pose_coordinates(file);
  std::vector<double> values(count * coordinates.size());
  const ArrayView<double, axis::Pose, axis::Component> of_pose(values, {count, coordinates.size()});
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    const auto column = read_along<double>(file, "/poses/" + coordinates[c].name, {"pose"});
    for (std::size_t m = 0; m < count; ++m) of_pose(m, c) = column[m];
  }
  SelectedPoses selected;
  selected.poses = PoseSet(coordinates.size(), std::move(values));
  read_fields(file, "/poses", kPoseFields, selected);
  if (!file.exists("/poses/rejected")) return selected;
  selected.rejected = read_columns(file, "/poses/rejected", kRejectedFields);
  if (file.has_attribute("/poses/rejected", kCandidates)) {
    selected.candidates = file.attribute<std::uint64_t>("/poses/rejected", kCandidates).at(0);
  }
  return selected;
}

RunFacts read_facts(const h5::File& file) {
  RunFacts facts;
  read_fields(file, "/run", kFactFields, facts);
  if (!file.exists("/run/all_samples")) return facts;  // written by a version of poesy that solved every sample
  const auto samples = file.read<std::uint64_t>("/run/all_samples");
  if (samples.size() != 1 || samples[0] < facts.solves) throw h5::Error("/run/all_samples does not fit /run/solves");
  facts.by_series = samples[0] - facts.solves;
  return facts;
}

std::string stored_hash(const h5::File& file) {
  return file.has_attribute("/", "content_sha256") ? text_attribute(file, "content_sha256") : "";
}

CsvTable pose_table(const StoredResult& result) {
  CsvTable table = lines_of_poses(result, "poses");
  if (!result.time.empty()) table.columns.push_back(list_column("time [s]", result.time));
  for (std::size_t c = 0; c < result.pose_coordinates.size(); ++c) {
    const NamedUnit& coordinate = result.pose_coordinates[c];
    table.columns.push_back({with_unit(coordinate.name, coordinate.unit),
                             [&result, c](std::size_t m) { return result.poses[PoseIndex(m)][c]; }});
  }
  table.columns.push_back(list_column("condition", result.condition));
  return table;
}

std::string valid_hash(const StoredResult& result) { return result.changed ? std::string() : result.content_sha256; }

const Unit& display(const NamedUnit& named) { return display_unit(dimension_of(named.unit)); }

void write_result(const std::string& path, std::string_view name, const FileKind& kind, const Study& study,
                  const SelectedPoses& poses, std::any found, const RunFacts& facts, const DrawingResult* drawing) {
  compose_file(path, kResultFile, name, study, poses, facts, parts_of(kind, study, found, drawing));
}

StoredResult as_stored(std::string_view name, const FileKind& kind, const Study& study, const SelectedPoses& poses,
                       std::any found, const DrawingResult* drawing) {
  ResultBuilder composed(h5::File::in_memory());
  compose_all(composed, kResultFile, name, study, poses, {}, parts_of(kind, study, found, drawing));
  StoredResult result;
  read_header(composed.file(), result);
  read_parts(composed.file(), kind, result);
  return result;
}

std::string check_result_path(const std::string& path, std::span<const std::string> inputs) {
  return check_output_path(path, {"result", may_be_replaced, kOlderEnd}, inputs);
}

StoredResult read_result(const std::string& path, FindFileKind find_kind) {
  return with_poesy_file(path, [&](const h5::File& file) {
    expect_filetype(path, file, kResultFile);
    StoredResult result;
    read_header(file, result);
    const FileKind* kind = find_kind(result.kind);
    if (kind == nullptr) throw h5::Error("its kind '" + result.kind + "' is unknown");
    read_parts(file, *kind, result);
    return result;
  });
}

Verification verify_result(const std::string& path) {
  return with_poesy_file(path, [](const h5::File& file) {
    return Verification{.stored = stored_hash(file), .computed = content_sha256(file)};
  });
}

std::vector<std::string> export_tables(const StoredResult& result, const FileKind& kind, const std::string& folder) {
  CsvTables tables{pose_table(result)};
  kind.append_tables(tables, result);
  std::vector<std::string> responses;
  for (const NamedUnit& response : result.responses) responses.push_back(response.name);
  if (result.drawing) append_drawing_tables(tables, responses, *result.drawing);
  OutputFolder output(folder, valid_hash(result));
  for (const CsvTable& table : tables) output.claim(table.name + ".csv");
  std::vector<std::string> paths;
  output.fill([&] {
    for (const CsvTable& table : tables) paths.push_back(write_csv(folder, table));
  });
  return paths;
}

}  // namespace poesy
