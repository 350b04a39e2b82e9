#include "engine/io/study_file_parts.h"

namespace poesy {
namespace {

AdaptiveSamples read_adaptive(const StudySection& section, Analysis& analysis) {
  section.allow();
  AdaptiveSamples adaptive;
  const StudyValue max = section.require("max", "write the most samples to take at each pose, e.g. max = 1000000");
  analysis.samples = static_cast<std::size_t>(max.whole_number(2, kMostSolves));
  const auto min = section.find("min");
  if (min) adaptive.min = static_cast<std::size_t>(min->whole_number(2, kMostSolves));
  if (adaptive.min > analysis.samples) {
    const std::string other = std::to_string(min ? analysis.samples : adaptive.min);
    if (min)
      min->fail("is " + std::to_string(adaptive.min) + ", more than max = " + other,
                "write a smaller min or a larger max");
    max.fail("is " + std::to_string(analysis.samples) + ", less than min, which is " + other + " where it is not set",
             "write a larger max, or min besides");
  }
  const StudyValue error = section.require(
      "relative_error", "write how narrow intervals are to be, half their width over the value, e.g. 0.01");
  adaptive.relative_error = read_share(error, "0.01");
  return adaptive;
}

}  // namespace

double read_share(const StudyValue& value, std::string_view example) {
  const double share = value.number();
  if (!(share > 0.0 && share < 1.0)) {
    value.fail("is " + shortest(share), "it must lie between 0 and 1, e.g. " + std::string(example));
  }
  return share;
}

void read_samples(const StudySection& section, Analysis& analysis) {
  const auto conf_level = section.find("conf_level");
  if (conf_level) analysis.conf_level = read_share(*conf_level, "0.95");
  const auto samples = section.find("samples");
  if (!samples) return;
  if (!samples->is_section()) {
    analysis.samples = static_cast<std::size_t>(samples->whole_number(2, kMostSolves));
    return;
  }
  const StudySection table = samples->section();
  analysis.adaptive = read_adaptive(table, analysis);
  const auto own = table.find("conf_level");
  if (!own) return;
  const double level = read_share(*own, "0.95");
  if (conf_level && level != analysis.conf_level) {
    own->fail("is " + shortest(level) + ", but analysis.conf_level is " + shortest(analysis.conf_level),
              "write the level of the intervals once");
  }
  analysis.conf_level = level;
}

}  // namespace poesy
