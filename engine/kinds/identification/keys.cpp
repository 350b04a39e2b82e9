#include <fmt/format.h>

#include <array>

#include "engine/base/text.h"
#include "engine/kinds/identification/identification.h"
#include "engine/study/study_kind.h"
#include "engine/study/table_file.h"

namespace poesy::identification {
namespace {

constexpr std::array<std::string_view, 3> kKeys{"factors", "pose_share", "groups"};

/// The pair of sizes for a study that states none: one display unit of length (1 mm) and one of angle (1 deg).
ErrorSize usual_group() { return {"group 1", display_unit(Dimension::length).si, display_unit(Dimension::angle).si}; }

const InnerRows<ErrorSize>& group_keys() {
  static const InnerRows<ErrorSize> keys{
      .paths = {"analysis.groups[]"},
      .meaning = "For kind = \"identification\".",
      .rows = {InnerRow<ErrorSize>{.name = "name",
                                   .value = text_at(&ErrorSize::name),
                                   .usual = "group 1, group 2 and so on",
                                   .meaning = kNameMeaning},
               InnerRow<ErrorSize>{.name = "linear",
                                   .value = positive_at(Dimension::length, &ErrorSize::linear),
                                   .missing = "a group sets both",
                                   .meaning = "Size of errors that are lengths."},
               InnerRow<ErrorSize>{.name = "angular",
                                   .value = positive_at(Dimension::angle, &ErrorSize::angular),
                                   .missing = "a group sets both",
                                   .meaning = "Size of errors that are angles."}}};
  return keys;
}

void read_groups(const StudyValue& value, Study& study, const Reading&) {
  std::vector<ErrorSize>& groups = asked_of<Options>(study.analysis).groups;
  for (const StudyValue& one : value.list()) {
    ErrorSize group{};
    read_keys(group_keys(), one.section(), group, Nothing());
    group.name = read_name(one.section(), names(groups), "group " + std::to_string(groups.size() + 1));
    groups.push_back(std::move(group));
  }
  if (groups.empty()) value.fail("is empty", "leave it out for one group of 1 mm and 1 deg");
}

std::string groups_lines(const Study& study) {
  std::string text;
  for (const ErrorSize& group : asked_of<Options>(study.analysis).groups) {
    text += "\n[[analysis.groups]]\n" + keys_text(group_keys(), group);
  }
  return text;
}

std::string shown_groups(const TemplateLines& lines, const Study&) {
  return lines.explanation_lines("analysis", "groups") + lines.keys_lines("analysis.groups[]") +
         "groups = [\n"
         "  { name = \"group 1\", linear = \"5 mm\", angular = \"0.005 rad\" },\n"
         "  { name = \"group 2\", linear = \"1 mm\", angular = \"1 deg\" },\n"
         "]\n";
}

std::vector<StudyRow> identification_rows() {
  const ErrorSize group = usual_group();
  return {StudyRow{.name = "groups",
                   .value = {.type = "list of tables"},
                   .usual = fmt::format("`[{{ name = {}, linear = {}, angular = {} }}]`", in_quotes(group.name),
                                        readable_value(group.linear, Dimension::length),
                                        readable_value(group.angular, Dimension::angle)),
                   .meaning = "The sizes at which errors are set; each group gives verdicts of its own.",
                   .reader = read_groups,
                   .lines = groups_lines,
                   .late = 2,
                   .shown = shown_groups},
          StudyRow{.name = "pose_share",
                   .value = asked_value(number_at(between_0_and_1("0.95"), &Options::pose_share)),
                   .meaning = "The share of the poses that a verdict asks for."}};
}

void add_usual_group(Study& study, const Reading&) {
  std::vector<ErrorSize>& groups = asked_of<Options>(study.analysis).groups;
  if (groups.empty()) groups.push_back(usual_group());
}

void check_groups(const StudySection& analysis, const Study& study, const Model& model) {
  const auto value = analysis.find("groups");
  const std::vector<StudyValue> written = value ? value->list() : std::vector<StudyValue>{};
  const std::vector<ErrorSize>& groups = asked_of<Options>(study.analysis).groups;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const StudySection section = written.empty() ? analysis : written[g].section();
    for (const FactorIndex factor : study.analysis.factors) {
      const Factor& error = model.description().factors[factor.value];
      if (error.dimension == Dimension::number) {
        analysis.require("factors").fail("has '" + error.name + "', which is a number, but groups have no size for it",
                                         "name errors that are lengths or angles");
      }
      check_error_size(model, factor, error.dimension == Dimension::length ? groups[g].linear : groups[g].angular,
                       section);
    }
  }
}

std::optional<Refusal> nothing_deforms(const ModelDescription& model) {
  if (model.deformation) return std::nullopt;
  return Refusal{"nothing deforms in model \"" + model.name + "\"",
                 "identification needs limbs that hold one platform against each other; choose another kind"};
}

std::optional<Refusal> no_template(const ModelDescription& model) {
  if (model.deformation) return std::nullopt;
  return Refusal{"nothing deforms in model '" + model.name + "', so it has no identification", "choose another kind"};
}

AtPose identification_at_pose(const Study& study) {
  const auto groups = static_cast<double>(asked_of<Options>(study.analysis).groups.size());
  const double tried = static_cast<double>(study.analysis.factors.size()) * groups;
  return {tried, "factors times groups", tried, "factors times groups"};
}

}  // namespace

const StudyKind kStudy{.name = "identification",
                       .asks = "which errors deform the mechanism at all",
                       .keys = kKeys,
                       .rows = identification_rows,
                       .tables = [] { return StudyTables{described(group_keys())}; },
                       .refusal = nothing_deforms,
                       .no_template = no_template,
                       .complete = add_usual_group,
                       .check_errors = check_groups,
                       .at_pose = identification_at_pose};

}  // namespace poesy::identification
