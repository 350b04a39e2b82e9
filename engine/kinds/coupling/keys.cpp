#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "engine/base/text.h"
#include "engine/kinds/coupling/coupling.h"
#include "engine/study/study.h"
#include "engine/study/study_kind.h"

namespace poesy::coupling {
namespace {

constexpr std::array<std::string_view, 6> kKeys{"linear", "angular", "limbs", "components", "worst_case", "sources"};

using PatternChoice = ErrorPattern::Choice;

constexpr std::size_t kFewestSources = 2;
constexpr std::size_t kMostSources = 8;  // eight sources have 255 subsets

/// Reads "all" or "independent".
PatternChoice read_choice(const StudyValue& value) {
  constexpr std::array<std::string_view, 2> kWords{"all", "independent"};
  return value.word(kWords) == 0 ? PatternChoice::all : PatternChoice::independent;
}

void read_limbs(const StudyValue& value, Study& study, const Reading&) {
  const ModelDescription& model = study.model();
  ErrorPattern& pattern = asked_of<Options>(study.analysis).pattern;
  if (value.is_text()) {
    pattern.limbs = read_choice(value);
    return;
  }
  std::set<std::size_t> limbs;
  for (const Factor& factor : model.factors) limbs.insert(factor.limb);
  pattern.limbs = PatternChoice::some;
  pattern.limb = static_cast<std::size_t>(value.whole_number(0));
  if (limbs.contains(pattern.limb)) return;
  std::string known;
  for (const std::size_t limb : limbs) known += (known.empty() ? "" : ", ") + std::to_string(limb);
  value.fail("is " + std::to_string(pattern.limb) + ", but model \"" + model.name + "\" has errors of limbs " + known,
             "name one of them, or write \"all\" or \"independent\"");
}

void read_components(const StudyValue& value, Study& study, const Reading&) {
  ErrorPattern& pattern = asked_of<Options>(study.analysis).pattern;
  if (value.is_text()) {
    pattern.components = read_choice(value);
    return;
  }
  constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
  pattern.components = PatternChoice::some;
  for (const StudyValue& element : value.list()) {
    const std::string axis(kAxes[element.word(kAxes)]);
    if (std::ranges::find(pattern.axes, axis) != pattern.axes.end()) {
      element.fail("names '" + axis + "' a second time", "remove one of them");
    }
    pattern.axes.push_back(axis);
  }
  if (pattern.axes.empty()) value.fail("is empty", "name components, e.g. [\"x\", \"z\"], or write \"all\"");
}

/// Throws InputError if an earlier source also has one of these errors.
void require_own_factors(const StudyValue& factors, const ErrorSource& source, std::span<const ErrorSource> others,
                         const ModelDescription& model) {
  for (const ErrorSource& other : others) {
    for (const FactorIndex factor : source.factors) {
      if (std::ranges::find(other.factors, factor) == other.factors.end()) continue;
      factors.fail("has '" + model.factors[factor.value].name + "', which source '" + other.name + "' has as well",
                   "a factor belongs to one source; list the factors of one of them by name");
    }
  }
}

ErrorSource read_source(const StudySection& section, std::span<const ErrorSource> others, const ErrorPattern& pattern,
                        const Study& study) {
  const ModelDescription& model = study.model();
  section.allow();
  std::vector<std::string_view> taken;
  for (const ErrorSource& other : others) taken.push_back(other.name);
  ErrorSource source{read_name(section, taken, "source " + std::to_string(others.size() + 1)), {}};
  if (source.name.find('+') != std::string::npos) {
    section.find("name")->fail("is '" + printable(source.name) + "'", "write it without '+', which joins sources");
  }
  const StudyValue factors = section.require("factors");
  source.factors = read_factors(factors, study);
  for (const FactorIndex factor : source.factors) {
    const Factor& error = model.factors[factor.value];
    if (error.dimension != Dimension::number) continue;
    factors.fail("has '" + error.name + "', which is a number, but a coupling study has no size for it",
                 "name errors that are lengths or angles");
  }
  require_own_factors(factors, source, others, model);
  if (error_blocks(source, pattern, model).empty()) {
    factors.fail("has no factor of the limbs and components that the study asks for",
                 "change limbs or components, or leave this source out");
  }
  return source;
}

/// The error sources that the model lists, for a study that names none. Throws InputError if the model lists none, or
/// if the pattern excludes all errors of a source.
std::vector<ErrorSource> usual_sources(const StudySection& analysis, const ModelDescription& model,
                                       const ErrorPattern& pattern) {
  constexpr std::string_view kNameThem =
      "write 2 to 8 [[analysis.sources]], each with name and factors (a factor set or a list of names)";
  if (model.sources.empty()) {
    throw InputError(analysis.place(),
                     "kind = \"coupling\" needs sources of errors, and model \"" + model.name + "\" suggests none",
                     std::string(kNameThem));
  }
  std::vector<ErrorSource> sources;
  for (const SourceSet& usual : model.sources) {
    sources.push_back({usual.name, model.find_set(usual.set)->factors});
    const ErrorSource& source = sources.back();
    if (!error_blocks(source, pattern, model).empty()) continue;
    throw InputError(analysis.place(),
                     "source '" + source.name + "' has no factor of the limbs and components that the study asks for",
                     std::string(kNameThem));
  }
  return sources;
}

void read_sources(const StudyValue& value, Study& study, const Reading&) {
  const std::vector<StudyValue> list = value.list();
  if (list.size() < kFewestSources || list.size() > kMostSources) {
    value.fail("has " + std::to_string(list.size()) + (list.size() == 1 ? " source" : " sources") +
                   ", but there must be " + std::to_string(kFewestSources) + " to " + std::to_string(kMostSources),
               "group factors into fewer or more sources");
  }
  Options& coupling = asked_of<Options>(study.analysis);
  for (const StudyValue& one : list) {
    coupling.sources.push_back(read_source(one.section(), coupling.sources, coupling.pattern, study));
  }
}

std::string sources_lines(const Study& study) {
  std::string text;
  for (const ErrorSource& source : asked_of<Options>(study.analysis).sources) {
    text += fmt::format("\n[[analysis.sources]]\nname = {}\nfactors = {}\n", in_quotes(source.name),
                        factors_text(source.factors, study.model()));
  }
  return text;
}

using Sizes = std::vector<double>;

/// The key for the sizes of errors of this dimension.
KeyValue<Study> sizes_at(Dimension dimension, Sizes Options::*member) {
  const auto read = [=](const StudyValue& value, Study& study) {
    Sizes& sizes = asked_of<Options>(study.analysis).*member;
    for (const StudyValue& size : value.list()) sizes.push_back(size.positive_quantity(dimension));
    if (sizes.empty()) value.fail("is empty", "write at least one size");
  };
  return {.type = "list of " + std::string(name(dimension)) + "s", .bounds = "greater than 0", .read = read};
}

template <Dimension kDimension>
std::string sizes_line(const Study& study) {
  std::vector<std::string> sizes;
  for (const double size : asked_of<Options>(study.analysis).sizes_of(kDimension)) {
    sizes.push_back(exact_value(size, kDimension));
  }
  return sizes.empty() ? "" : fmt::format("{} = {}\n", error_kind(kDimension), list_text(sizes));
}

/// Whether a source that the model lists has an error of this dimension.
bool has_source_of(const ModelDescription& model, Dimension dimension) {
  return std::ranges::any_of(model.sources, [&](const SourceSet& source) {
    return std::ranges::any_of(model.find_set(source.set)->factors,
                               [&](FactorIndex factor) { return model.factors[factor.value].dimension == dimension; });
  });
}

template <Dimension kDimension>
std::string shown_sizes(const TemplateLines& lines, const Study& study) {
  std::vector<std::string> sizes;
  for (const double factor : {0.1, 0.3, 0.5}) {
    sizes.push_back(fmt::format("\"{} {}\"", factor, display_unit(kDimension).name));
  }
  const std::string_view key = error_kind(kDimension);
  const std::string_view sign = has_source_of(study.model(), kDimension) ? "" : "# ";
  return lines.explained("analysis", key, fmt::format("{}{} = {}", sign, key, list_text(sizes)));
}

std::string shown_sources(const TemplateLines& lines, const Study& study) {
  std::string text = "\n" + lines.explanation_lines("analysis", "sources") + lines.keys_lines("analysis.sources") +
                     "# Factor sets:\n" + sets_comment(study.model());
  for (const SourceSet& source : study.model().sources) {
    text +=
        fmt::format("[[analysis.sources]]\nname = {}\nfactors = {}\n\n", in_quotes(source.name), in_quotes(source.set));
  }
  text.pop_back();
  return text;
}

std::string choice_text(PatternChoice choice, const std::string& some) {
  if (choice == PatternChoice::some) return some;
  return choice == PatternChoice::all ? "\"all\"" : "\"independent\"";
}

std::string limbs_text(const Study& study) {
  const ErrorPattern& pattern = asked_of<Options>(study.analysis).pattern;
  return choice_text(pattern.limbs, std::to_string(pattern.limb));
}

std::string components_text(const Study& study) {
  const ErrorPattern& pattern = asked_of<Options>(study.analysis).pattern;
  std::vector<std::string> axes;
  for (const std::string& axis : pattern.axes) axes.push_back(in_quotes(axis));
  return choice_text(pattern.components, list_text(axes));
}

void require_sizes(const StudySection& analysis, Dimension dimension, const Options& study,
                   const ModelDescription& model) {
  const std::string key(error_kind(dimension));
  const std::vector<FactorIndex> factors = coupling_factors(study, model);
  const auto dimension_at = [&](FactorIndex factor) { return model.factors[factor.value].dimension; };
  const auto factor = std::ranges::find(factors, dimension, dimension_at);
  if (analysis.find(key) || factor == factors.end()) return;
  throw InputError(analysis.place(),
                   "key '" + key + "' is missing in [analysis], for the sources have errors such as '" +
                       model.factors[factor->value].name + "'",
                   "write sizes, e.g. " + key + " = [\"0.1 " + std::string(display_unit(dimension).name) + "\"]");
}

/// Refuses sizes of a dimension (lengths or angles) if no error of the sources has this dimension. Errors that the
/// pattern leaves at zero count as errors of the sources.
void refuse_idle_sizes(const StudySection& analysis, Dimension dimension, const Options& study,
                       const ModelDescription& model) {
  const auto value = analysis.find(error_kind(dimension));
  if (!value) return;
  for (const ErrorSource& source : study.sources) {
    for (const FactorIndex factor : source.factors) {
      if (model.factors[factor.value].dimension == dimension) return;
    }
  }
  value->fail("gives sizes, but no source has an error with that dimension (" + std::string(name(dimension)) + ")",
              "remove it");
}

void require_equal_numbers(const StudyValue& angular, const Options& study) {
  if (study.linear.size() == study.angular.size()) return;
  const auto sizes = [](std::size_t count) { return std::to_string(count) + (count == 1 ? " size" : " sizes"); };
  angular.fail("has " + sizes(study.angular.size()) + ", but linear has " + sizes(study.linear.size()),
               "a run takes one of each, so write as many");
}

/// Throws InputError if the sizes at two positions of the lists `linear` and `angular` are equal, for lengths as well
/// as for angles. value: the key `linear` or `angular`, to which the message points.
void require_different_runs(const StudyValue& value, const Options& study) {
  const auto same = [](const std::vector<double>& sizes, std::size_t a, std::size_t b) {
    return sizes.empty() || sizes[a] == sizes[b];
  };
  const std::vector<StudyValue> list = value.list();
  for (std::size_t z = 0; z < list.size(); ++z) {
    for (std::size_t before = 0; before < z; ++before) {
      if (!same(study.linear, before, z) || !same(study.angular, before, z)) continue;
      list[z].fail("repeats a size", "each run needs a size of its own; remove one of them");
    }
  }
}

/// Sets the sources that the model lists, if the study lists none. Throws InputError if an error of a source has no
/// size, or if sizes are stated for a dimension that no error has.
void complete_sources(const StudySection& analysis, const ModelDescription& model, Options& study) {
  if (!analysis.find("sources")) study.sources = usual_sources(analysis, model, study.pattern);
  for (const Dimension dimension : {Dimension::length, Dimension::angle}) {
    require_sizes(analysis, dimension, study, model);
  }
  for (const Dimension dimension : {Dimension::length, Dimension::angle}) {
    refuse_idle_sizes(analysis, dimension, study, model);
  }
}

void complete_coupling(Study& whole, const Reading& reading) {
  const StudySection analysis = reading.root.section("analysis");
  const ModelDescription& model = whole.model();
  Options& study = asked_of<Options>(whole.analysis);
  const auto linear = analysis.find("linear");
  const auto angular = analysis.find("angular");
  if (linear && angular) require_equal_numbers(*angular, study);
  if (linear || angular) require_different_runs(linear ? *linear : *angular, study);
  if (reading.use == StudyUse::run) complete_sources(analysis, model, study);
  whole.analysis.factors = coupling_factors(study, model);
}

std::vector<StudyRow> coupling_key_rows() {
  return {
      StudyRow{.name = "linear",
               .value = sizes_at(Dimension::length, &Options::linear),
               .meaning =
                   "Sizes of lengths. Each gives a run of its own, in which all lengths have this size. Required where "
                   "a source has lengths; as many as of angular, if there are both.",
               .lines = sizes_line<Dimension::length>,
               .shown = shown_sizes<Dimension::length>},
      StudyRow{.name = "angular",
               .value = sizes_at(Dimension::angle, &Options::angular),
               .meaning = "Sizes of angles, likewise.",
               .lines = sizes_line<Dimension::angle>,
               .shown = shown_sizes<Dimension::angle>},
      StudyRow{.name = "limbs",
               .value = {.type = "text or integer", .text = limbs_text},
               .meaning =
                   "all: errors of every limb, together; a number: of that limb alone; independent: each limb on "
                   "its own, in the worst case and the root sum square.",
               .reader = read_limbs},
      StudyRow{.name = "components",
               .value = {.type = "text or list of texts", .text = components_text},
               .meaning =
                   "all: every component of an error, together; a list such as [\"x\", \"z\"]: those and scalars; "
                   "independent: each component of each error on its own, as for limbs.",
               .reader = read_components},
      StudyRow{
          .name = "worst_case",
          .value = asked_value(word_at<UnknownSigns>(
              {{UnknownSigns::search,
                "the largest value that a search finds: it begins with the signs of the first-order sum, and flips "
                "them one by one until no flip is worse; some solves for each error and response at each pose, "
                "size and subset"},
               {UnknownSigns::sum, "no worst case, only the first-order sum, which takes no solves"}},
              &Options::worst_case)),
          .meaning = "How the worst case is found where signs are not known."},
      StudyRow{.name = "sources",
               .value = {.type = "list of tables"},
               .usual = "those of the literature, where the model has them",
               .meaning = "2 to 8 sources of errors: each alone, and every combination of them at once.",
               .reader = read_sources,
               .lines = sources_lines,
               .late = 2,
               .shown = shown_sources}};
}

StudyTables source_tables() {
  return {{.paths = {"analysis.sources"},
           .meaning = "For kind = \"coupling\".",
           .keys = {{.name = "name",
                     .type = "text",
                     .usual = "source 1, source 2 and so on",
                     .meaning = "Name of the source, without '+', commas and quotes."},
                    {.name = "factors",
                     .type = "text or list of texts",
                     .required = true,
                     .missing = "write a factor set or a list of factors",
                     .meaning = "Its errors: a factor set, all, or a list of factors, of which no other source has "
                                "one."}}}};
}

void check_sizes(const StudySection& analysis, const Study& study, const Model& model) {
  const Options& coupling = asked_of<Options>(study.analysis);
  for (const FactorIndex factor : study.analysis.factors) {
    const Dimension dimension = model.description().factors[factor.value].dimension;
    const Sizes& sizes = coupling.sizes_of(dimension);
    for (std::size_t z = 0; z < sizes.size(); ++z) {
      const auto problem = beyond_bound(model, factor, sizes[z], "an error");
      if (problem) analysis.require(error_kind(dimension)).list()[z].fail(*problem, kTooLargeRemedy);
    }
  }
}

std::optional<Refusal> no_sources(const ModelDescription& model) {
  if (!model.sources.empty()) return std::nullopt;
  return Refusal{"model '" + model.name + "' suggests no sources of errors, so its coupling has no template",
                 "choose another kind, or write [[analysis.sources]] in a study of this kind"};
}

AtPose coupling_at_pose(const Study& study) {
  const Options& coupling = asked_of<Options>(study.analysis);
  const auto sets = static_cast<double>(coupling.sizes() * coupling_rows(coupling, study.model()).errors.size());
  return {sets, "sizes times sets of sources", sets, "sizes times sets of sources"};
}

}  // namespace

const StudyKind kStudy{.name = "coupling",
                       .asks = "what sources of errors do one by one and together",
                       .keys = kKeys,
                       .rows = coupling_key_rows,
                       .tables = source_tables,
                       .no_template = no_sources,
                       .complete = complete_coupling,
                       .check_errors = check_sizes,
                       .at_pose = coupling_at_pose};

}  // namespace poesy::coupling
