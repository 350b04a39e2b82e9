#include <algorithm>

#include "engine/io/export_tables.h"
#include "engine/io/result_format.h"
#include "engine/io/result_parts.h"

namespace poesy {
namespace {

/// Columns of failures, one row each.
struct FailureColumns {
  std::vector<std::string> factor;
  std::vector<std::uint64_t> pose, sample;
  std::vector<std::uint8_t> status;
};

std::size_t slot_named(const std::string& factor, const StoredResult& result) {
  if (result.kind == result_format::kMonteCarlo && factor == kAllFactors) return 0;
  const auto found = std::ranges::find(result.factors, factor, &NamedUnit::name);
  if (found == result.factors.end() || result.kind == result_format::kMonteCarlo) {
    throw h5::Error("/solver/failed_factor names an unknown error");
  }
  return static_cast<std::size_t>(found - result.factors.begin());
}

}  // namespace

void add_failures(ResultBuilder& result, const std::vector<Failure>& failures, const std::vector<std::string>& slots,
                  std::uint64_t total) {
  FailureColumns columns;
  for (const Failure& failure : failures) {
    columns.factor.push_back(slots[failure.slot]);
    columns.pose.push_back(failure.pose.value);
    columns.sample.push_back(failure.failed.sample.value);
    columns.status.push_back(static_cast<std::uint8_t>(failure.failed.status));
  }
  const Axes axes{"failure"};
  result.add_axis("failure", positions(failures.size()), {"1", "Number of the listed failure, from 0"});
  result.show_axes("/solver", axes);
  result.add("/solver/failed_factor", axes, columns.factor,
             {"1", "Samples that failed, by the error that varied; \"all\": all together"});
  result.add("/solver/failed_pose", axes, columns.pose, {"1", "Their poses, by number from 0"});
  result.add("/solver/failed_sample", axes, columns.sample, {"1", "Their numbers at that error and pose, from 0"});
  result.add("/solver/failed_status", axes, columns.status,
             {"1", "How these solves ended: a position in status_names, from 0"});
  h5::File& file = result.file();
  const auto status_names = texts(kStatusNames, std::identity());
  file.set_attribute("/solver/failed_status", "status_names", std::span(status_names));
  file.set_attribute("/solver", "failures", static_cast<std::int64_t>(total));
  file.set_attribute("/solver", "most_failures_listed", static_cast<std::int64_t>(kMostFailuresListed));
  file.set_attribute("/solver", "most_failures_of_a_cell", static_cast<std::int64_t>(FailedSamples::kMost));
}

std::vector<Failure> read_failures(const h5::File& file, const StoredResult& result) {
  if (!file.exists("/failure")) return {};
  const std::size_t count = axis_length(file, "failure");
  const FailureColumns columns{read_exactly<std::string>(file, "/solver/failed_factor", count),
                               read_exactly<std::uint64_t>(file, "/solver/failed_pose", count),
                               read_exactly<std::uint64_t>(file, "/solver/failed_sample", count),
                               read_exactly<std::uint8_t>(file, "/solver/failed_status", count)};
  std::vector<Failure> failures;
  for (std::size_t k = 0; k < count; ++k) {
    if (columns.pose[k] >= result.poses.size()) throw h5::Error("/solver/failed_pose names an unknown pose");
    if (columns.status[k] >= kStatusNames.size()) throw h5::Error("/solver/failed_status holds an unknown status");
    failures.push_back({slot_named(columns.factor[k], result),
                        PoseIndex(columns.pose[k]),
                        {SampleIndex(columns.sample[k]), static_cast<SolveStatus>(columns.status[k])}});
  }
  return failures;
}

std::string varied_name(const StoredResult& result, std::size_t slot) {
  return result.kind == result_format::kMonteCarlo ? std::string(kAllFactors) : result.factors[slot].name;
}

const std::vector<Failure>& listed_failures(const StoredResult& result) {
  return result.kind == result_format::kMonteCarlo ? result.monte_carlo.failures : result.sensitivity.failures;
}

void export_failures(TableFolder& folder, const StoredResult& result) {
  folder.write("failures", {"factor", "pose", "sample", "status"}, [&](CsvTable& table) {
    for (const Failure& failure : listed_failures(result)) {
      table.row(varied_name(result, failure.slot),
                std::vector{static_cast<double>(failure.pose.value), static_cast<double>(failure.failed.sample.value),
                            static_cast<double>(failure.failed.status)});
    }
  });
}

}  // namespace poesy
