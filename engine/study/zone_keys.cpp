#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "engine/base/text.h"
#include "engine/drawing/zone_draws.h"
#include "engine/drawing/zone_moments.h"
#include "engine/drawing/zone_scatter.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

using drawing::ScatterShape;
using drawing::ZoneScatter;

/// The keys of [errors.zones] as the study states them.
struct WrittenScatter {
  ScatterShape shape = ScatterShape::normal;
  std::optional<double> sigmas;
  std::optional<double> cpk;
  std::optional<double> within;
};

/// The words for the values of ScatterShape, in the order of the enumeration.
constexpr std::array<std::string_view, 4> kShapes{"normal", "uniform", "boundary", "inspected"};

std::string_view name(ScatterShape shape) { return kShapes[static_cast<std::size_t>(shape)]; }

void read_shape(const StudyValue& value, WrittenScatter& written) {
  written.shape = static_cast<ScatterShape>(value.word(kShapes));
}

/// The bounds of the keys `sigmas` and `cpk`. With a larger number, the standard deviation of an error would be too
/// small for doubles.
NumberBounds above_zero_to_a_million(std::string_view example) {
  return {0.0, 1e6, false, "greater than 0 and less than 1e6",
          fmt::format("it must lie between 0 and 1e6, e.g. {}", example)};
}

/// The KeyValue of an optional number within bounds.
KeyValue<WrittenScatter> number(std::optional<double> WrittenScatter::*member, const NumberBounds& bounds) {
  return {
      .type = bounds.percent ? "number or percent" : "number",
      .bounds = std::string(bounds.words),
      .read = [=](const StudyValue& value, WrittenScatter& written) { written.*member = read_number(value, bounds); }};
}

const InnerRows<WrittenScatter>& scatter_keys() {
  using W = WrittenScatter;
  static const InnerRows<W> keys{
      .paths = {"errors.zones"},
      .meaning =
          "How features scatter in the zones of their drawing. Normals: at its extreme points, the ends of an axis and "
          "the corners of a plane, each coordinate is one; a location whose use the drawing does not say is shared "
          "evenly by the errors that move an extreme point. With any other distribution a feature is drawn as a whole "
          "in studies in which errors vary together; a study of one error at a time takes normals of the same standard "
          "deviations.",
      .rows = {InnerRow<W>{
                   .name = "distribution",
                   .value = {.type = "text",
                             .words = {{kShapes[0], "of each coordinate, also outside the zone"},
                                       {kShapes[1], "every place in the zone alike"},
                                       {kShapes[2],
                                        "every part just passes: the ends of an axis, a point or a distance "
                                        "are on the boundary of the zone, in any direction alike; not for "
                                        "planes and orientations"},
                                       {kShapes[3], "normals, of which those outside are sorted out and made again"}},
                             .read = read_shape},
                   .missing = "write {}",
                   .example = "\"normal\"",
                   .meaning = "Shape of the distribution."},
               InnerRow<W>{.name = "sigmas",
                           .value = number(&W::sigmas, above_zero_to_a_million("3")),
                           .usual = "",
                           .meaning = "Of \"normal\" and \"inspected\": half a zone in standard deviations of a "
                                      "coordinate of an extreme point; of \"inspected\" at least 1.5. 3 of "
                                      "them keep 99.73 % of distances, 98.89 % of points in a disc and 97.07 % in a "
                                      "ball."},
               InnerRow<W>{.name = "cpk",
                           .value = number(&W::cpk, above_zero_to_a_million("1.33")),
                           .usual = "",
                           .meaning = "Instead: a third of that."},
               InnerRow<W>{.name = "within",
                           .value = number(&W::within, between_0_and_1("0.9973")),
                           .usual = "",
                           .meaning = "Instead: the share of the extreme points that are in their zone, one point at a "
                                      "time."}}};
  return keys;
}

ZoneScatter scatter_of(const StudyValue& value) {
  WrittenScatter written;
  read_keys(scatter_keys(), value.section(), written, Nothing());
  ZoneScatter scatter{.shape = written.shape, .within = written.within};
  const int count = (written.sigmas ? 1 : 0) + (written.cpk ? 1 : 0) + (written.within ? 1 : 0);
  if (!scatter.has_sigmas()) {
    if (count == 0) return scatter;
    value.fail(fmt::format("has distribution = \"{}\", which fills the zone itself, and a size of normals",
                           name(scatter.shape)),
               "remove sigmas, cpk and within, or write distribution = \"inspected\"");
  }
  if (count != 1) {
    value.fail(count == 0 ? "does not say how much of a zone is used" : "says twice how much of a zone is used",
               "write one of sigmas = 3, cpk = 1.33 and within = 0.9973, because no drawing says it");
  }
  if (!written.within) scatter.sigmas = written.sigmas ? *written.sigmas : 3.0 * *written.cpk;
  return scatter;
}

/// Throws InputError if the shape of the scatter is not possible for one of the features and its zones.
void check_shape(const StudyValue& value, const ZoneScatter& scatter, const std::vector<Feature>& features) {
  // with fewer standard deviations in half a zone, inspection would reject too many parts
  constexpr double kLeastInspected = 1.5;
  for (const Feature& feature : features) {
    if (feature.clearance || (!feature.location && !feature.orientation)) continue;
    if (scatter.shape == ScatterShape::boundary && !drawing::can_touch(feature)) {
      value.fail(fmt::format("has distribution = \"boundary\", but '{}' {}, whose boundary has many meanings",
                             feature.name, feature.orientation ? "has an orientation" : "is a plane"),
                 "write \"uniform\" or \"inspected\"");
    }
    if (scatter.shape != ScatterShape::inspected) continue;
    const double sigmas = drawing::sigmas_of(feature, scatter);
    if (sigmas >= kLeastInspected) continue;
    value.fail(
        fmt::format("has half a zone of '{}' in {} standard deviations, of which inspection would sort out too many",
                    feature.name, shortest(sigmas)),
        "write sigmas = 1.5 or more, or distribution = \"uniform\"");
  }
}

void read_zones(const StudyValue& value, Study& study, const Reading&) {
  const std::vector<Feature>& features = study.model().features;
  if (features.empty()) {
    value.fail("has no meaning for " + study.model().name + ", whose file has no features",
               "write features = [...] with zones in its limbs, or remove it");
  }
  study.errors.zones = scatter_of(value);
  check_shape(value, *study.errors.zones, features);
  set_by_zones(study);
}

std::string zones_line(const Study& study) {
  if (!study.errors.zones) return {};
  const ZoneScatter& scatter = *study.errors.zones;
  std::string size;
  if (scatter.has_sigmas()) {
    size = scatter.within ? ", within = " + shortest(*scatter.within) : ", sigmas = " + shortest(scatter.sigmas);
  }
  return fmt::format("zones = {{ distribution = {}{} }}\n", in_quotes(name(scatter.shape)), size);
}

std::string shown_zones(const TemplateLines& lines, const Study& study) {
  if (study.model().features.empty()) return {};
  return lines.explanation_lines("errors", "zones") + lines.keys_lines("errors.zones") +
         "zones = { distribution = \"normal\", sigmas = 3 }\n";
}

/// The distribution of one error of a feature. It has the shape of the scatter if the error is drawn independently of
/// other errors. It is normal for a clearance, and for errors of the feature that are drawn together. sigma: standard
/// deviation of the error if it is normal, m.
Distribution distribution_of(const Feature& feature, const ZoneScatter& scatter, double sigma) {
  const bool has_shape = !feature.clearance && !drawing::are_drawn_together(feature, scatter);
  if (has_shape && scatter.shape == ScatterShape::uniform) {
    return Distribution::uniform(drawing::half_width_alone(feature));
  }
  if (has_shape && scatter.shape == ScatterShape::inspected) {
    const double half = drawing::half_width_alone(feature);
    return Distribution::truncated_normal(half / drawing::sigmas_of(feature, scatter), half);
  }
  return Distribution::normal(sigma);
}

/// Returns true if the study varies this error with the distribution in `by_zones`, which follows from its tolerance
/// zone.
bool varies_by_zone(const Study& study, const std::vector<std::optional<Distribution>>& by_zones, FactorIndex error) {
  const std::vector<FactorIndex>& varied = study.analysis.factors;
  return by_zones[error.value] && study.errors.by_factor[error.value] == *by_zones[error.value] &&
         std::ranges::find(varied, error) != varied.end();
}

bool is_correlated(const Study& study, FactorIndex error) {
  return std::ranges::any_of(study.errors.correlated, [&](const CorrelatedErrors& block) {
    return std::ranges::find(block.factors, error) != block.factors.end();
  });
}

/// Throws InputError if the errors of a feature that are drawn together do not all vary with distributions from their
/// zone, are drawn partly per pose and partly per machine, or are correlated.
void check_feature(const StudyValue& zones, const Feature& feature, const Study& study,
                   const std::vector<std::optional<Distribution>>& by_zones) {
  const auto name_of = [&](FactorIndex error) { return study.model().factors[error.value].name; };
  const auto is_own = [&](FactorIndex error) { return varies_by_zone(study, by_zones, error); };
  const std::vector<FactorIndex> errors = feature.errors();
  const auto own = std::ranges::find_if(errors, is_own);
  if (own == errors.end()) return;
  const std::string shape(name(study.errors.zones->shape));
  const auto other = std::ranges::find_if_not(errors, is_own);
  if (other != errors.end()) {
    zones.fail(fmt::format("has distribution = \"{}\", which draws all errors of '{}' together, but '{}' does not vary "
                           "by its zone and '{}' does",
                           shape, feature.name, name_of(*other), name_of(*own)),
               "name all of them or none in analysis.factors and errors.override, or write distribution = \"normal\"");
  }
  for (const FactorIndex error : errors) {
    if (study.errors.is_per_pose(error) != study.errors.is_per_pose(errors.front())) {
      zones.fail(
          fmt::format("has distribution = \"{}\", which draws all errors of '{}' together, but only some of them "
                      "are drawn per pose",
                      shape, feature.name),
          "give all of them the same draws");
    }
    if (!is_correlated(study, error)) continue;
    zones.fail(fmt::format("has distribution = \"{}\", but errors.correlated has '{}'", shape, name_of(error)),
               "write distribution = \"normal\", or leave the errors of features out of errors.correlated");
  }
}

}  // namespace

StudyRow zones_row() {
  return {.name = "zones",
          .value = {.type = "table"},
          .usual = "none",
          .meaning = "How features scatter in their zones. Without it their errors scatter as other lengths.",
          .reader = read_zones,
          .lines = zones_line,
          .shown = shown_zones};
}

StudyTable zones_table() { return described(scatter_keys()); }

std::vector<FactorIndex> clearance_errors(const ModelDescription& model) {
  std::vector<FactorIndex> list;
  for (const Feature& feature : model.features) {
    if (!feature.clearance) continue;
    const std::vector<FactorIndex> errors = feature.errors();
    list.insert(list.end(), errors.begin(), errors.end());
  }
  std::ranges::sort(list);
  return list;
}

void set_by_zones(Study& study) {
  const std::vector<std::optional<Distribution>> by_zones = distributions_by_zones(study);
  std::vector<FactorIndex>& per_pose = study.errors.per_pose;
  for (std::size_t f = 0; f < by_zones.size(); ++f) {
    if (!by_zones[f]) continue;
    study.errors.by_factor[f] = *by_zones[f];
    std::erase(per_pose, FactorIndex(f));
  }
  const std::vector<FactorIndex> loose = clearance_errors(study.model());
  per_pose.insert(per_pose.end(), loose.begin(), loose.end());
  std::ranges::sort(per_pose);
}

std::vector<std::optional<Distribution>> distributions_by_zones(const Study& study) {
  std::vector<std::optional<Distribution>> list(study.model().factors.size());
  for (const Feature& feature : study.model().features) {
    if (!study.errors.zones && !feature.clearance) continue;
    const ZoneScatter scatter = study.errors.zones.value_or(ZoneScatter());
    const drawing::FeatureSigmas found = drawing::scatter_sigmas(feature, scatter);
    for (const auto& [errors, sigma] :
         {std::pair(&feature.middle, found.middle), std::pair(&feature.tilt, found.tilt)}) {
      for (const FactorIndex error : *errors) {
        if (sigma) list[error.value] = distribution_of(feature, scatter, *sigma);
      }
    }
  }
  return list;
}

std::vector<Feature> features_drawn_together(const Study& study) {
  std::vector<Feature> list;
  if (!study.errors.zones || study.errors.zones->is_normal()) return list;
  if (study.analysis.kind->varies != Varies::together) return list;
  const std::vector<std::optional<Distribution>> by_zones = distributions_by_zones(study);
  for (const Feature& feature : study.model().features) {
    if (!drawing::are_drawn_together(feature, *study.errors.zones)) continue;
    const std::vector<FactorIndex> errors = feature.errors();
    const auto is_own = [&](FactorIndex error) {
      return varies_by_zone(study, by_zones, error) && !is_correlated(study, error) &&
             study.errors.is_per_pose(error) == study.errors.is_per_pose(errors.front());
    };
    if (std::ranges::all_of(errors, is_own)) list.push_back(feature);
  }
  return list;
}

void check_zones(const Study& study, const Reading& reading) {
  if (!study.errors.zones || study.errors.zones->is_normal()) return;
  if (study.analysis.kind->varies != Varies::together) return;
  const StudyValue zones = reading.root.section("errors").require("zones");
  const std::vector<std::optional<Distribution>> by_zones = distributions_by_zones(study);
  for (const Feature& feature : study.model().features) {
    if (feature.clearance || !drawing::are_drawn_together(feature, *study.errors.zones)) continue;
    check_feature(zones, feature, study, by_zones);
  }
}

}  // namespace poesy
