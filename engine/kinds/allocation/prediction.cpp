#include "engine/kinds/allocation/prediction.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/kinds/allocation/kind.h"
#include "engine/kinds/allocation/programme.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/allocation/summary.h"
#include "engine/kinds/confirming_study.h"
#include "engine/kinds/corner_machines.h"
#include "engine/kinds/what_if/what_if.h"

namespace poesy::allocation {
namespace {

/// The cost law of a part. If the part has processes, the law of the process that `point` chooses.
CostLaw law_of(const ToleranceProgramme& programme, const TolerancePoint& point, std::size_t part) {
  const AllocatedPart& stated = programme.parts()[part];
  if (stated.choice != AllocatedPart::Choice::processes) return stated.cost.cost_law();
  return programme.processes()[part][point.process[part]].cost;
}

/// The tolerance of a part in its display unit. Its name is "±" or, for a zone, the key of the zone.
WhatIfSize size_of(const Result& found, std::size_t part) {
  const Unit& unit = display_unit(dimension_of(found.part_unit(part)));
  const bool is_zone = found.has_zones() && !found.zone_key(part).empty();
  return {is_zone ? found.zone_key(part) : "\u00b1", found.tolerance(part) / unit.si, std::string(unit.name)};
}

/// Adds a part to `errors`, a group of errors that one slider of the page scales: its errors, its name and tolerance,
/// and its cost at each factor of the slider.
void add_part(const Result& found, const ToleranceProgramme& programme, const TolerancePoint& point, std::size_t part,
              SizedErrors& errors) {
  for (const ErrorFactor& one : programme.weights(point, part).errors) {
    if (std::ranges::find(errors.slots, one.error) == errors.slots.end()) errors.slots.push_back(one.error);
  }
  if (programme.is_void(point, part)) return;  // the drawing does not contain this zone
  errors.name += (errors.name.empty() ? "" : ", ") + found.part_names[part];
  errors.sizes.push_back(size_of(found, part));
  if (!has_costs(found)) return;
  const CostLaw law = law_of(programme, point, part);
  errors.costs.resize(what_if_factors().size(), 0.0);
  std::ranges::transform(what_if_factors(), errors.costs, errors.costs.begin(),
                         [&](double factor, double cost) { return cost + law.at(factor * found.tolerance(part)); });
}

/// The parts as groups of errors, one for each slider of the page. Location and orientation of a feature form one
/// group, because they determine the same errors.
std::vector<SizedErrors> sized_parts(const Result& found, const ToleranceProgramme& programme) {
  const TolerancePoint point = programme.at_most(found.tolerance.all());
  std::vector<SizedErrors> list;
  for (std::size_t part = 0; part < programme.size(); ++part) {
    if (std::ranges::find(programme.pairs(), part, &Within::inner) != programme.pairs().end()) continue;
    SizedErrors errors;
    add_part(found, programme, point, part, errors);
    const auto pair = std::ranges::find(programme.pairs(), part, &Within::outer);
    if (pair != programme.pairs().end()) add_part(found, programme, point, pair->inner, errors);
    list.push_back(std::move(errors));
  }
  return list;
}

/// [poses] The use of the limit that is used most at the pose.
std::vector<double> pose_weights(const Result& found) {
  std::vector<double> weights(found.poses(), 0.0);
  for (std::size_t r = 0; r < found.limit_use.length<axis::Response>(); ++r) {
    for (std::size_t m = 0; m < weights.size(); ++m) weights[m] = std::max(weights[m], found.limit_use(r, m));
  }
  return weights;
}

/// Whether the page can predict yields for this result. The study, which was read again from the result's text, must
/// be an allocation without calibration, with as many errors, parts and poses as the result.
bool fits(const ReportedResult& reported, const Result& found) {
  const Study& study = *reported.study;
  if (study.analysis.kind != &kStudy || study.analysis.calibration != nullptr) return false;
  if (study.analysis.factors.size() != reported.stored.factors.size()) return false;
  return asked_of<Options>(study.analysis).parts.size() == found.parts() &&
         found.poses() == reported.stored.poses.size();
}

}  // namespace

void add_prediction(const ReportedResult& reported, Page& page) {
  const Result& found = allocation_of(reported.stored);
  if (found.parts() == 0 || found.poses() == 0 || !fits(reported, found)) return;
  const ToleranceProgramme programme(*reported.study, *reported.model);
  Study certificate = as_confirming_study(programme.at(found.tolerance.all()), "certificate");
  certificate.seed = found.certificate_seed;
  certificate.analysis.samples = found.certificate.machines;
  add_what_if({.study = certificate,
               .model = *reported.model,
               .poses = reported.stored.poses,
               .errors = sized_parts(found, programme),
               .pose_weights = pose_weights(found),
               .machines = found.certificate.machines,
               .yield = found.certificate.value,
               .yield_low = found.certificate.ci_low,
               .yield_high = found.certificate.ci_high,
               .conf_level = found.certificate.conf_level},
              "drawing", page);
  add_not_covered(certificate, *reported.model, reported.stored, page);
}

}  // namespace poesy::allocation
