#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "engine/base/text.h"
#include "engine/drawing/zone_scatter.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

using drawing::ZoneScatter;

/// How features scatter in their zones, as written.
struct WrittenScatter {
  std::optional<double> sigmas;
  std::optional<double> cpk;
  std::optional<double> within;
};

/// The word for a normal.
constexpr std::array<std::string_view, 1> kShapes{"normal"};

void read_shape(const StudyValue& value, WrittenScatter&) { static_cast<void>(value.word(kShapes)); }

/// A zone of any size divided by more is too small for the standard deviation of an error.
NumberBounds above_zero_to_a_million(std::string_view example) {
  return {0.0, 1e6, false, "greater than 0 and less than 1e6",
          fmt::format("it must lie between 0 and 1e6, e.g. {}", example)};
}

/// A number within bounds, for a member that may have none.
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
          "How features scatter in the zones of their drawing: at its extreme points, the ends of an axis and the "
          "corners of a plane, each coordinate is a normal. A location whose use the drawing does not say is shared "
          "evenly by the errors that move an extreme point.",
      .rows = {InnerRow<W>{.name = "distribution",
                           .value = {.type = "text", .words = {{kShapes[0], "of each coordinate"}}, .read = read_shape},
                           .missing = "write {}",
                           .example = "\"normal\"",
                           .meaning = "Shape of the distribution."},
               InnerRow<W>{.name = "sigmas",
                           .value = number(&W::sigmas, above_zero_to_a_million("3")),
                           .usual = "",
                           .meaning = "Half a zone in standard deviations of a coordinate of an extreme point. 3 of "
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
  const int count = (written.sigmas ? 1 : 0) + (written.cpk ? 1 : 0) + (written.within ? 1 : 0);
  if (count != 1) {
    value.fail(count == 0 ? "does not say how much of a zone is used" : "says twice how much of a zone is used",
               "write one of sigmas = 3, cpk = 1.33 and within = 0.9973, because no drawing says it");
  }
  if (written.within) return {.within = *written.within};
  return {.sigmas = written.sigmas ? *written.sigmas : 3.0 * *written.cpk};
}

/// Sets those entries of a list over all errors.
void set_sigma(const std::vector<FactorIndex>& errors, std::optional<double> sigma,
               std::vector<std::optional<double>>& list) {
  for (const FactorIndex error : errors) list[error.value] = sigma;
}

void read_zones(const StudyValue& value, Study& study, const Reading&) {
  const std::vector<Feature>& features = study.model().features;
  if (features.empty()) {
    value.fail("has no meaning for " + study.model().name + ", whose file has no features",
               "write features = [...] with zones in its limbs, or remove it");
  }
  study.errors.zones = scatter_of(value);
  set_by_zones(study);
}

std::string zones_line(const Study& study) {
  if (!study.errors.zones) return {};
  const ZoneScatter& scatter = *study.errors.zones;
  return fmt::format("zones = {{ distribution = \"normal\", {} }}\n",
                     scatter.within ? "within = " + shortest(*scatter.within) : "sigmas = " + shortest(scatter.sigmas));
}

std::string shown_zones(const TemplateLines& lines, const Study& study) {
  if (study.model().features.empty()) return {};
  return lines.explanation_lines("errors", "zones") + lines.keys_lines("errors.zones") +
         "zones = { distribution = \"normal\", sigmas = 3 }\n";
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
  const std::vector<std::optional<double>> sigmas = sigmas_by_zones(study);
  std::vector<FactorIndex>& per_pose = study.errors.per_pose;
  for (std::size_t f = 0; f < sigmas.size(); ++f) {
    if (!sigmas[f]) continue;
    study.errors.by_factor[f] = Distribution::normal(*sigmas[f]);
    std::erase(per_pose, FactorIndex(f));
  }
  const std::vector<FactorIndex> loose = clearance_errors(study.model());
  per_pose.insert(per_pose.end(), loose.begin(), loose.end());
  std::ranges::sort(per_pose);
}

std::vector<std::optional<double>> sigmas_by_zones(const Study& study) {
  std::vector<std::optional<double>> list(study.model().factors.size());
  for (const Feature& feature : study.model().features) {
    if (!study.errors.zones && !feature.clearance) continue;
    const double sigmas = study.errors.zones ? drawing::sigmas_of(feature, *study.errors.zones) : 0.0;
    const drawing::FeatureSigmas found = drawing::feature_sigmas(feature, sigmas);
    set_sigma(feature.middle, found.middle, list);
    set_sigma(feature.tilt, found.tilt, list);
  }
  return list;
}

}  // namespace poesy
