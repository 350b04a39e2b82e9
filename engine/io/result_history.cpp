#include "engine/io/result_parts.h"

namespace poesy {
namespace {

constexpr const char* kGroup = "/sensitivity/history";

std::string path_of(const std::string& name) { return std::string(kGroup) + "/" + name; }

}  // namespace

void add_history(ResultBuilder& result, const IndexHistory& found, double conf_level) {
  const Axes axes{"response", "factor", "samples"};
  const std::string unit = "SI: response unit / factor unit";
  h5::File& file = result.file();
  result.add_axis("samples", found.samples, {"1", "Samples at each pose; the last is the study's number"});
  file.make_group(kGroup);
  result.show_axes(kGroup, axes);
  file.set_attribute(kGroup, "description",
                     std::string("The global indices after the first samples of each pose: what a study with so many "
                                 "samples finds; NaN where undefined"));
  file.set_attribute(kGroup, "conf_level", conf_level);
  result.add(path_of("global"), axes, found.global, {unit, "Global index after so many samples at each pose"});
  result.add(path_of("global_ci_low"), axes, found.global_ci_low, {unit, "Lower end of the interval of global"});
  result.add(path_of("global_ci_high"), axes, found.global_ci_high, {unit, "Upper end of the interval of global"});
  for (const char* interval : {"global_ci_low", "global_ci_high"}) {
    file.set_attribute(path_of(interval), "conf_level", conf_level);
  }
}

std::optional<IndexHistory> read_history(const h5::File& file) {
  if (!file.exists(kGroup)) return std::nullopt;
  IndexHistory found;
  found.samples = file.read<std::uint64_t>(path_of("samples"));
  const std::size_t count = axis_length(file, "response") * axis_length(file, "factor") * found.samples.size();
  found.global = read_exactly<double>(file, path_of("global"), count);
  found.global_ci_low = read_exactly<double>(file, path_of("global_ci_low"), count);
  found.global_ci_high = read_exactly<double>(file, path_of("global_ci_high"), count);
  return found;
}

}  // namespace poesy
