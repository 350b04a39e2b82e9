#include "engine/io/result_parts.h"

namespace poesy {
namespace {

const Axes kCells{"factor", "pose"};

std::vector<std::string> published_of(const Study& study) {
  std::vector<std::string> classes;
  for (const FactorIndex factor : study.analysis.factors) {
    classes.push_back(study.model().separation->published[factor.value]);
  }
  return classes;
}

void add_lengths(ResultBuilder& result, const SeparationResult& found) {
  const auto add = [&](const char* name, const std::vector<double>& values, const char* description) {
    result.add(std::string("/separation/") + name, kCells, values, {"SI: m / factor unit", description});
  };
  add("drive", found.drive, "Part of the effect that enters through the actuated directions");
  add("constraint", found.constraint, "Part of the effect that enters through the constrained directions");
  add("effect", found.effect, "The effect: both parts together");
  add("residual", found.residual, "What the best correction of the actuators leaves of the effect");
}

void add_shares(ResultBuilder& result, const SeparationResult& found) {
  result.add("/separation/removable_local", kCells, found.removable_local,
             {"1", "Share of the effect that calibration can remove at each pose: 1 - residual / effect"});
  result.add("/separation/drive_share", {"factor"}, found.drive_share,
             {"1", "D / (D + C), with D and C the root mean squares of drive and constraint over the poses"});
  result.add(
      "/separation/removable", {"factor"}, found.removable,
      {"1", "Share that calibration can remove: 1 - residual / effect, both as root mean squares over the poses"});
  result.add_scalar("/separation/removable_together", found.removable_together,
                    {"1",
                     "The same for all errors together, independent, with the standard deviations of /factors/sigma: "
                     "1 - root of the sum of (sigma x residual)^2 over root of the sum of (sigma x effect)^2"});
}

}  // namespace

void add_separation(ResultBuilder& result, const Study& study, const SeparationResult& found) {
  h5::File& file = result.file();
  file.make_group("/separation");
  result.show_axes("/separation", {"factor", "pose"});
  file.set_attribute("/separation", "description",
                     std::string("What the actuators have to do with each error's effect, to first order; NaN where an "
                                 "error has no effect"));
  file.set_attribute("/separation", "measure", study.model().separation->measure);
  add_lengths(result, found);
  add_shares(result, found);
  result.add("/separation/published", {"factor"}, published_of(study),
             {"1", "Class of the error in the literature; empty where it gives none"});
}

void read_separation(const h5::File& file, StoredResult& result) {
  const std::size_t factors = axis_length(file, "factor");
  const std::size_t cells = factors * axis_length(file, "pose");
  const auto read = [&](const char* name, std::size_t count) {
    return read_exactly<double>(file, std::string("/separation/") + name, count);
  };
  result.sensitivity.separation = {.drive = read("drive", cells),
                                   .constraint = read("constraint", cells),
                                   .effect = read("effect", cells),
                                   .residual = read("residual", cells),
                                   .removable_local = read("removable_local", cells),
                                   .drive_share = read("drive_share", factors),
                                   .removable = read("removable", factors),
                                   .removable_together = read("removable_together", 1).front()};
  result.separation_measure = file.attribute<std::string>("/separation", "measure").at(0);
  result.published_class = read_exactly<std::string>(file, "/separation/published", factors);
}

}  // namespace poesy
