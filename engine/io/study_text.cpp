#include "engine/io/study_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "engine/io/study_file.h"

namespace poesy {
namespace {

bool same(const Distribution& a, const Distribution& b) {
  return a.shape() == b.shape() && a.sigma() == b.sigma() && a.half_width() == b.half_width();
}

std::string distribution_text(const Distribution& distribution, Dimension dimension) {
  using Shape = Distribution::Shape;
  const Shape shape = distribution.shape();
  std::string text = fmt::format("{{ distribution = {}", in_quotes(name(shape)));
  if (shape == Shape::normal || shape == Shape::truncated_normal) {
    text += ", sigma = " + exact_value(distribution.sigma(), dimension);
  }
  if (shape != Shape::normal) text += ", half_width = " + exact_value(distribution.half_width(), dimension);
  return text + " }";
}

/// The distribution that most factors of this dimension have: what `linear` or `angular` is set to.
Distribution usual_distribution(const Study& study, Dimension dimension) {
  const std::vector<Distribution>& all = study.errors.by_factor;
  const std::vector<Factor>& factors = study.model().factors;
  Distribution usual = Distribution::normal(display_unit(dimension).si);
  std::ptrdiff_t most = 0;
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].dimension != dimension) continue;
    std::ptrdiff_t shared = 0;
    for (std::size_t g = 0; g < factors.size(); ++g) {
      shared += factors[g].dimension == dimension && same(all[f], all[g]) ? 1 : 0;
    }
    if (shared <= most) continue;
    usual = all[f];
    most = shared;
  }
  return usual;
}

std::string factors_text(std::span<const FactorIndex> factors, const ModelDescription& model) {
  if (const std::string set = set_name(factors, model); !set.empty()) return in_quotes(set);
  std::string text = "[";
  for (const FactorIndex factor : factors) text += "\n  " + in_quotes(model.factors[factor.value].name) + ",";
  return text + "\n]";
}

std::string mechanism_text(const Study& study) {
  const ModelDescription& model = study.model();
  std::string text = fmt::format("[mechanism]\nmodel = {}\n", in_quotes(model.name));
  if (!model.fidelities.empty()) {
    const MechanismChoice& choice = study.mechanism;
    text +=
        fmt::format("fidelity = {}\n",
                    in_quotes(choice.compared ? kBothFidelities : std::string_view(model.fidelities[choice.fidelity])));
  }
  if (model.geometry.empty()) return text;
  text += "\n[mechanism.geometry]\n";
  for (std::size_t g = 0; g < model.geometry.size(); ++g) {
    const GeometryParameter& parameter = model.geometry[g];
    text += parameter.name + " = " + exact_value(study.mechanism.geometry[g], parameter.dimension) + "\n";
  }
  return text;
}

std::string metric_text(const Study& study) {
  if (study.model().metric.empty()) return {};
  const std::string text = "metric = " + in_quotes(study.model().metric) + "\n";
  if (study.mechanism.points.empty()) return text;
  return text + "points = " + points_text(study.mechanism.points, exact_value) + "\n";
}

std::string grid_text(const PoseSelection& poses, const ModelDescription& model) {
  std::string text;
  for (std::size_t c = 0; c < poses.grid_counts.size(); ++c) {
    text += fmt::format("{}{} = {}", c == 0 ? "{ " : ", ", model.pose_coordinates[c].name, poses.grid_counts[c]);
  }
  return text + " }";
}

std::string limits_text(const PoseSelection& poses, const ModelDescription& model) {
  std::string text;
  for (const JointLimit& limit : poses.limits) {
    const JointDisplacement& joint = model.joints[limit.joint];
    text += fmt::format("{}{} = {}", text.empty() ? "{ " : ", ", joint.name,
                        range_text(limit.range, joint.dimension, exact_value));
  }
  return text + " }";
}

std::string trajectory_text(const Trajectory& trajectory, const ModelDescription& model) {
  std::string text;
  if (trajectory.curve) {
    const NamedCurve& curve = model.curves[*trajectory.curve];
    for (std::size_t c = 0; c < trajectory.origin.size(); ++c) {
      text +=
          (c > 0 ? ", " : "") + exact_value(trajectory.origin[c], model.charts[curve.chart].coordinates[c].dimension);
    }
    text = fmt::format("curve = {}, origin = [{}]", in_quotes(curve.name), text);
  } else {
    text = "file = " + in_quotes(trajectory.file);
  }
  if (trajectory.points > 0) text += fmt::format(", points = {}", trajectory.points);
  if (trajectory.time) {
    text += fmt::format(", time = [{}, {}]", exact_value(trajectory.time->start, Dimension::time),
                        exact_value(trajectory.time->end, Dimension::time));
  }
  return "{ " + text + " }";
}

std::string poses_text(const Study& study) {
  const PoseSelection& poses = study.poses;
  std::string text = fmt::format("[poses]\nselect = {}\n", in_quotes(name(poses.select)));
  if (poses.select == PoseSelection::Select::file) return text + "file = " + in_quotes(poses.file) + "\n";
  if (poses.select == PoseSelection::Select::trajectory) {
    if (poses.trajectory) text += "trajectory = " + trajectory_text(*poses.trajectory, study.model()) + "\n";
    return text + "max_condition = " + shortest(poses.max_condition) + "\n";
  }
  if (!poses.grid_counts.empty()) {
    text += "count = " + grid_text(poses, study.model()) + "\n";
  } else if (poses.count > 0) {
    text += fmt::format("count = {}\n", poses.count);
  }
  text += "workspace = " + workspace_text(poses.workspace, study.model(), exact_value) + "\n";
  if (!poses.limits.empty()) text += "limits = " + limits_text(poses, study.model()) + "\n";
  return text + "max_condition = " + shortest(poses.max_condition) + "\n";
}

std::string errors_text(const Study& study) {
  const Distribution linear = usual_distribution(study, Dimension::length);
  const Distribution angular = usual_distribution(study, Dimension::angle);
  std::string overrides;
  for (std::size_t f = 0; f < study.model().factors.size(); ++f) {
    const Factor& factor = study.model().factors[f];
    const Distribution& own = study.errors.by_factor[f];
    if (same(own, factor.dimension == Dimension::length ? linear : angular)) continue;
    overrides += factor.name + " = " + distribution_text(own, factor.dimension) + "\n";
  }
  if (!overrides.empty()) overrides = "\n[errors.override]\n" + overrides;
  return fmt::format("[errors]\nlinear = {}\nangular = {}\n{}", distribution_text(linear, Dimension::length),
                     distribution_text(angular, Dimension::angle), overrides);
}

std::string background_text(const Background& background, const ModelDescription& model) {
  return fmt::format("\n[analysis.background]\nfactors = {}\nlinear = {}\nangular = {}\n",
                     factors_text(background.factors, model), exact_value(background.linear, Dimension::length),
                     exact_value(background.angular, Dimension::angle));
}

std::string reference_text(const ToleranceReference& reference, const ModelDescription& model) {
  const Factor& factor = model.factors[reference.factor.value];
  return fmt::format("reference = {{ factor = {}, tolerance = {} }}\n", in_quotes(factor.name),
                     exact_value(reference.tolerance, factor.dimension));
}

std::string group_text(const ErrorSize& group) {
  return fmt::format("\n[[analysis.groups]]\nname = {}\nlinear = {}\nangular = {}\n", in_quotes(group.name),
                     exact_value(group.linear, Dimension::length), exact_value(group.angular, Dimension::angle));
}

/// Every error by name.
std::string case_text(const ErrorCase& one, const ModelDescription& model) {
  std::string text = fmt::format("\n[[analysis.cases]]\nname = {}\n\n[analysis.cases.errors]\n", in_quotes(one.name));
  for (std::size_t f = 0; f < one.errors.size(); ++f) {
    text += model.factors[f].name + " = " + exact_value(one.errors[f], model.factors[f].dimension) + "\n";
  }
  return text;
}

std::string sizes_text(std::string_view key, const std::vector<double>& sizes, Dimension dimension) {
  if (sizes.empty()) return {};
  std::string text;
  for (const double size : sizes) text += (text.empty() ? "" : ", ") + exact_value(size, dimension);
  return fmt::format("{} = [{}]\n", key, text);
}

std::string choice_text(ErrorPattern::Choice choice, const std::string& some) {
  if (choice == ErrorPattern::Choice::some) return some;
  return choice == ErrorPattern::Choice::all ? "\"all\"" : "\"independent\"";
}

std::string coupling_text(const CouplingStudy& coupling, const ModelDescription& model) {
  const ErrorPattern& pattern = coupling.pattern;
  std::string axes;
  for (const std::string& axis : pattern.axes) axes += (axes.empty() ? "" : ", ") + in_quotes(axis);
  std::string text = sizes_text("linear", coupling.linear, Dimension::length) +
                     sizes_text("angular", coupling.angular, Dimension::angle);
  text += fmt::format("limbs = {}\ncomponents = {}\n", choice_text(pattern.limbs, std::to_string(pattern.limb)),
                      choice_text(pattern.components, "[" + axes + "]"));
  for (const ErrorSource& source : coupling.sources) {
    text += fmt::format("\n[[analysis.sources]]\nname = {}\nfactors = {}\n", in_quotes(source.name),
                        factors_text(source.factors, model));
  }
  return text;
}

/// A line for each limit, as for adaptive samples. What a share of the draws stays within is part of a run's state, so
/// `share` has its line even where limits are left out (CheckpointIdentity).
std::string limits_text(const Analysis& analysis, const ModelDescription& model) {
  std::string text;
  if (analysis.kind == Analysis::Kind::monte_carlo && analysis.judge == Judge::share) {
    text += fmt::format("judge = \"share\"\nshare = {}\n", shortest(analysis.share));
  } else if (analysis.kind == Analysis::Kind::monte_carlo && !analysis.limits.empty()) {
    text += "judge = \"rms\"\n";
  }
  for (const ResponseLimit& limit : analysis.limits) {
    const Response& response = model.responses[limit.response];
    text += fmt::format("limits.{} = {}\n", response.name, exact_value(limit.most, response.dimension));
  }
  return text;
}

/// A line for each key of adaptive samples, so that a comparison of two studies line by line names the key.
std::string samples_text(const Analysis& analysis) {
  if (!analysis.adaptive) return fmt::format("samples = {}\n", analysis.samples);
  return fmt::format("samples.min = {}\nsamples.max = {}\nsamples.relative_error = {}\n", analysis.adaptive->min,
                     analysis.samples, shortest(analysis.adaptive->relative_error));
}

std::string analysis_text(const Study& study) {
  using Kind = Analysis::Kind;
  const Analysis& analysis = study.analysis;
  std::string text = fmt::format("[analysis]\nkind = {}\n", in_quotes(name(analysis.kind)));
  if (analysis.kind == Kind::coupling) return text + coupling_text(analysis.coupling, study.model());
  if (analysis.kind != Kind::evaluate) text += "factors = " + factors_text(analysis.factors, study.model()) + "\n";
  if (analysis.kind == Kind::sensitivity || analysis.kind == Kind::monte_carlo) {
    text += fmt::format("{}conf_level = {}\n", samples_text(analysis), shortest(analysis.conf_level));
  }
  if (study.mechanism.compared) text += "linearity = " + shortest(analysis.linearity) + "\n";
  if (analysis.reference) text += reference_text(*analysis.reference, study.model());
  if (analysis.kind == Kind::monte_carlo) {
    text += "quantiles = [";
    for (const double quantile : analysis.quantiles) text += (text.back() == '[' ? "" : ", ") + shortest(quantile);
    text += "]\n";
  }
  if (analysis.kind == Kind::identification) text += "pose_share = " + shortest(analysis.pose_share) + "\n";
  text += limits_text(analysis, study.model());
  for (const ErrorSize& group : analysis.groups) text += group_text(group);
  if (analysis.background) text += background_text(*analysis.background, study.model());
  for (const ErrorCase& one : analysis.cases) text += case_text(one, study.model());
  return text;
}

}  // namespace

std::string points_text(std::span<const PlatformPoint> points, std::string (*value)(double si, Dimension dimension)) {
  std::vector<std::string> list;
  for (const PlatformPoint& point : points) {
    const auto coordinate = [&](std::size_t c) { return value(point[c], Dimension::length); };
    list.push_back(fmt::format("[{}, {}, {}]", coordinate(0), coordinate(1), coordinate(2)));
  }
  return fmt::format("[{}]", fmt::join(list, ", "));
}

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char character : text) {
    const auto code = static_cast<unsigned char>(character);
    if (code < 0x20 || code == 0x7F) {
      out += fmt::format("\\u{:04X}", code);
    } else {
      if (character == '"' || character == '\\') out += '\\';
      out += character;
    }
  }
  return out + '"';
}

std::string exact_value(double si, Dimension dimension) {
  return dimension == Dimension::number ? shortest(si) : in_quotes(to_text({si, dimension}));
}

std::string readable_value(double si, Dimension dimension) {
  const std::string exact = exact_value(si, dimension);
  if (dimension == Dimension::number) return exact;
  const std::string text = readable_text({si, dimension});
  const bool as_exact = parse_quantity(text).si == si;
  return as_exact && text.size() + 2 <= exact.size() + 1 ? in_quotes(text) : exact;
}

std::string range_text(const Range& range, Dimension dimension, std::string (*value)(double si, Dimension dimension)) {
  return fmt::format("[{}, {}]", value(range.lower, dimension), value(range.upper, dimension));
}

std::string workspace_text(std::span<const Range> workspace, const ModelDescription& model,
                           std::string (*value)(double si, Dimension dimension)) {
  std::string text;
  for (std::size_t c = 0; c < workspace.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    text += fmt::format("{}{} = {}", c == 0 ? "{ " : ", ", coordinate.name,
                        range_text(workspace[c], coordinate.dimension, value));
  }
  return text + " }";
}

std::string set_name(std::span<const FactorIndex> factors, const ModelDescription& model) {
  for (const FactorSet& set : model.factor_sets) {
    if (std::equal(factors.begin(), factors.end(), set.factors.begin(), set.factors.end())) return set.name;
  }
  if (model.find_set("all") != nullptr || factors.size() != model.factors.size()) return {};
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].value != f) return {};
  }
  return "all";
}

std::string resolved_text(const Study& study) {
  const SolverOptions& solver = study.solver;
  const std::string solver_text =
      "[solver]\n" + metric_text(study) +
      fmt::format("method = {}\ntolerance = {}\nmax_iterations = {}\nnot_converged = {}\nmax_not_converged = {}\n",
                  in_quotes(name(solver.method)), shortest(solver.tolerance), solver.max_iterations,
                  in_quotes(name(study.not_converged)), shortest(study.max_not_converged));
  return fmt::format("format = \"poesy-study\"\nversion = 1\ntitle = {}\n\n{}\n{}\n{}\n{}\n{}\n[run]\nseed = {}\n",
                     in_quotes(study.title), mechanism_text(study), poses_text(study), errors_text(study),
                     analysis_text(study), solver_text, study.seed);
}

}  // namespace poesy
