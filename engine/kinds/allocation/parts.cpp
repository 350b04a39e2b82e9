#include "engine/kinds/allocation/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "engine/base/text.h"
#include "engine/kinds/allocation/cost_keys.h"
#include "engine/kinds/allocation/members.h"
#include "engine/kinds/allocation/zone_blocks.h"
#include "engine/study/table_file.h"

namespace poesy::allocation {
namespace {

using PartChoice = AllocatedPart::Choice;

constexpr double kSigmasOfCpk = 3.0;  // by definition, a tolerance at Cpk = 1 is three standard deviations
// With more standard deviations, a tolerance divided by their number could approach rounding errors.
constexpr double kMostSigmas = 1e6;
constexpr double kMostCpk = 1e5;

NumberBounds sigmas_bounds(double most, std::string_view example) {
  return {0.0, most, false, "greater than 0",
          fmt::format("it must be greater than zero and below {}, e.g. {}", shortest(most), example)};
}

/// Reads the lower and the upper bound of a tolerance.
std::pair<double, double> read_bounds(const StudyValue& value, Dimension dimension) {
  const std::vector<StudyValue> list =
      value.list(2, "write the least and the largest tolerance, e.g. [\"0.01 mm\", \"0.5 mm\"]");
  const double lo = list[0].quantity(dimension);
  if (lo < 0.0) list[0].fail("is '" + printable(list[0].text()) + "'", "a tolerance is at least 0");
  const double hi = list[1].positive_quantity(dimension);
  if (lo <= hi) return {lo, hi};
  list[1].fail(fmt::format("is '{}', less than '{}' before it", printable(list[1].text()), printable(list[0].text())),
               "write the smaller bound first");
}

/// The block of a part, and the data that are needed to read its keys.
struct PartBlock {
  const StudySection& block;
  Dimension dimension;  ///< dimension of the part's tolerance
  const ModelDescription& model;
};

void read_range(const StudyValue& value, const PartBlock& of, AllocatedPart& part) {
  std::tie(part.lo, part.hi) = read_bounds(value, of.dimension);
}

void read_values(const StudyValue& value, const PartBlock& of, AllocatedPart& part) {
  for (const StudyValue& one : value.list()) {
    const double tolerance = one.positive_quantity(of.dimension);
    if (!part.values.empty() && tolerance <= part.values.back()) {
      one.fail("is '" + printable(one.text()) + "', not above the one before it", "write them in ascending order");
    }
    part.values.push_back(tolerance);
  }
  if (part.values.empty()) value.fail("is empty", "write the tolerances that can be had, or leave it out");
}

std::string size_text(double size) { return readable_text({size, Dimension::length}, 9); }

/// Whether two sizes are the same except for rounding.
bool is_same_size(double a, double b) {
  constexpr double kSame = 1e-9;  // relative difference
  return std::abs(a - b) <= kSame * b;
}

/// A distance of the drawing that has a known size and whose error is in the part. Null if there is none. Throws
/// InputError if there are two with different sizes.
const Feature* sized_distance(const StudyValue& grades, const AllocatedPart& part, const ModelDescription& model) {
  const Feature* found = nullptr;
  for (const Feature& feature : model.features) {
    const bool is_sized = feature.kind == FeatureKind::distance && feature.size[0] > 0.0;
    if (!is_sized || std::ranges::find(part.factors, feature.middle.front()) == part.factors.end()) continue;
    if (found != nullptr && !is_same_size(found->size[0], feature.size[0])) {
      grades.fail(fmt::format("is set, but '{}' is {} and '{}' is {} on the drawing", found->name,
                              size_text(found->size[0]), feature.name, size_text(feature.size[0])),
                  "a grade has another width for each size; make them separate parts");
    }
    found = &feature;
  }
  return found;
}

/// Reads the nominal size of a part from the key `nominal_size`, or takes it from the distance of the drawing that is
/// in the part. Throws InputError if both are missing or differ, or if ISO 286-1 has no grades for this size.
void read_nominal_size(const StudyValue& grades, const PartBlock& of, AllocatedPart& part) {
  const Feature* const own = sized_distance(grades, part, of.model);
  const auto size = of.block.find("nominal_size");
  if (!size && own == nullptr) {
    grades.fail("is set, but nominal_size is missing", "write the size of the part, e.g. \"50 mm\"");
  }
  part.nominal_size = size ? size->positive_quantity(Dimension::length) : own->size[0];
  if (own != nullptr && !is_same_size(part.nominal_size, own->size[0])) {
    size->fail(fmt::format("is '{}', but '{}' is {} in the mechanism's file", printable(size->text()), own->name,
                           size_text(own->size[0])),
               fmt::format("leave it out, or put '{}' into a block of its own", own->name));
  }
  if (it_grade_width(part.nominal_size, ItGrade::it7)) return;
  (size ? *size : grades)
      .fail(fmt::format("{} '{}', for which ISO 286-1 has no grades", size ? "is" : "is set for a size of",
                        size ? printable(size->text()) : size_text(part.nominal_size)),
            "its sizes end at 3150 mm");
}

void read_grades(const StudyValue& value, const PartBlock& of, AllocatedPart& part) {
  std::vector<std::string> known;
  for (int grade = 0; grade <= static_cast<int>(ItGrade::it18); ++grade) {
    known.push_back(it_grade_name(ItGrade{grade}));
  }
  const std::vector<std::string_view> words(known.begin(), known.end());
  const std::vector<StudyValue> list = value.list();
  if (list.empty()) value.fail("is empty", "name grades, e.g. [\"IT6\", \"IT7\"], or leave it out");
  if (of.dimension != Dimension::length) {
    value.fail("is set, but the part's errors are angles", "ISO 286-1 has grades of lengths; write values instead");
  }
  read_nominal_size(value, of, part);
  for (const StudyValue& one : list) {
    const ItGrade grade{static_cast<int>(one.word(words))};
    if (!part.grades.empty() && grade <= part.grades.back()) {
      one.fail("is " + it_grade_name(grade) + ", not coarser than the one before it", "write the finest one first");
    }
    if (!it_grade_width(part.nominal_size, grade)) {
      one.fail(fmt::format("is {}, for which ISO 286-1 has no value at a nominal size of {}", it_grade_name(grade),
                           readable_text({part.nominal_size, Dimension::length})),
               "leave it out, or correct nominal_size");
    }
    part.grades.push_back(grade);
  }
}

void read_processes(const StudyValue& value, const PartBlock& of, AllocatedPart& part) {
  for (const StudyValue& one : value.list()) {
    const StudySection section = one.section();
    section.allow();
    StatedProcess process;
    process.name = read_name(section, names(part.processes), std::to_string(part.processes.size() + 1));
    process.cost = read_cost(section.require("cost"), of.dimension);
    if (const auto bounds = section.find("bounds")) {
      std::tie(process.lo, process.hi) = read_bounds(*bounds, of.dimension);
    }
    part.processes.push_back(std::move(process));
  }
  if (part.processes.empty()) value.fail("is empty", "name a process with its cost, or leave it out");
}

void read_fixed(const StudyValue& value, const PartBlock& of, AllocatedPart& part) {
  part.lo = value.positive_quantity(of.dimension);
}

/// A key of a study file that states which tolerances a part may have.
struct ChoiceKey {
  std::string_view name;
  PartChoice choice;
  void (*read)(const StudyValue& value, const PartBlock& of, AllocatedPart& part);
};

constexpr std::array<ChoiceKey, 5> kChoiceKeys{{{"bounds", PartChoice::range, read_range},
                                                {"values", PartChoice::values, read_values},
                                                {"grades", PartChoice::grades, read_grades},
                                                {"processes", PartChoice::processes, read_processes},
                                                {"tolerance", PartChoice::fixed, read_fixed}}};

/// Throws InputError if none of the values to which tolerances are rounded is between lo and hi (SI).
void check_rounding(const StudyValue& value, double lo, double hi, const Rounding& round) {
  if (std::isinf(hi) || round.up(lo) <= round.down(hi)) return;
  value.fail("is set, but no such value is within the bounds of the tolerance", "take a finer step, or wider bounds");
}

void read_round(const StudySection& block, Dimension dimension, AllocatedPart& part) {
  const auto value = block.find("round");
  if (!value) return;
  part.round = read_rounding(*value, dimension);
  if (part.choice == PartChoice::range) return check_rounding(*value, part.lo, part.hi, *part.round);
  if (part.choice != PartChoice::processes) {
    value->fail("is set, but the part has a list of the tolerances that can be had, or one that is given",
                "remove it, or write bounds instead of the list");
  }
  for (const StatedProcess& process : part.processes) check_rounding(*value, process.lo, process.hi, *part.round);
}

/// Reads the cost and the possible tolerances of a part.
void read_choice(const PartBlock& of, AllocatedPart& part) {
  const auto& [block, dimension, model] = of;
  std::optional<StudyValue> chosen;
  for (const ChoiceKey& key : kChoiceKeys) {
    const auto value = block.find(key.name);
    if (!value) continue;
    key.read(*value, of, part);
    if (chosen) {
      value->fail("is set, and so is " + chosen->full_name(),
                  "write one of bounds, values, grades, processes and tolerance");
    }
    chosen = value;
    part.choice = key.choice;
  }
  if (const auto size = block.find("nominal_size"); size && part.choice != PartChoice::grades) {
    static_cast<void>(size->positive_quantity(Dimension::length));
    size->fail("is set, but the part has no grades", "write grades, e.g. [\"IT7\"], or leave it out");
  }
  read_round(block, dimension, part);
  const auto cost = block.find("cost");
  if (!cost) return;
  part.cost = read_cost(*cost, dimension);
  if (part.choice != PartChoice::processes) return;
  cost->fail("is set, but each of the processes has a cost of its own", "remove one or the other");
}

double read_shift(const StudySection& block) {
  const auto value = block.find("shift");
  if (!value) return 0.0;
  const double shift = value->number();
  if (0.0 <= shift && shift < 1.0) return shift;
  value->fail("is " + shortest(shift), "it must be at least 0 and less than 1, a share of the tolerance");
}

/// Names two errors of different dimensions: "the length 'delta_1' and the angle 'epsilon_1'". Empty if all errors have
/// the same dimension.
std::string two_dimensions(std::span<const PartMembers> parts, const ModelDescription& model) {
  const Factor& first = model.factors[parts.front().front().value];
  for (const PartMembers& part : parts) {
    for (const FactorIndex factor : part) {
      const Factor& other = model.factors[factor.value];
      if (other.dimension == first.dimension) continue;
      return fmt::format("the {} '{}' and the {} '{}'", name(first.dimension), first.name, name(other.dimension),
                         other.name);
    }
  }
  return {};
}

/// Throws InputError if a part has errors of two dimensions, or if parts of two dimensions share a cost or a list of
/// possible tolerances.
void check_dimensions(const StudySection& block, std::span<const PartMembers> parts, const ModelDescription& model) {
  constexpr std::string_view kRemedy = "write a block with factors = \"linear\" and another with factors = \"angular\"";
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (const std::string both = two_dimensions(parts.subspan(p, 1), model); !both.empty()) {
      block.require("factors").fail("has " + both + ", but a part has one tolerance", kRemedy);
    }
  }
  const std::string both = two_dimensions(parts, model);
  if (both.empty()) return;
  for (const std::string_view key : {"cost", "bounds", "values", "grades", "processes", "tolerance", "round"}) {
    if (!block.find(key)) continue;
    block.require("factors").fail(fmt::format("has {}, and '{}' cannot hold for both", both, key), kRemedy);
  }
}

double sigmas_of(const StudySection& block, std::optional<double> usual, const std::string& name) {
  const auto own = read_sigmas(block);
  if (own) return *own;
  if (usual) return *usual;
  throw InputError(block.place(), "part '" + name + "' has neither sigmas nor cpk, here or in [analysis]",
                   "say how many standard deviations a tolerance is: sigmas = 3 or cpk = 1");
}

/// Checks the name of a part of a block with `each`, which is the name of its first error. Throws InputError if the
/// block has the key `name`, or if another part has this name.
void check_each_name(const StudySection& block, std::span<const std::string_view> taken, const std::string& name) {
  if (const auto value = block.find("name")) {
    static_cast<void>(value->text());
    value->fail("is set, but with each = true every part has the name of its error", "remove one of them");
  }
  if (std::ranges::find(taken, name) == taken.end()) return;
  throw InputError(block.place(),
                   "a part of this block has the name of its error '" + name + "', which another part has as well",
                   "give the other part another name");
}

/// The parts of a block with `zones`.
std::vector<AllocatedPart> read_zone_block(const StudySection& block, const Study& study,
                                           std::span<const std::string_view> taken) {
  std::vector<AllocatedPart> parts = read_zones(block, study, taken);
  for (AllocatedPart& part : parts) {
    part.shift = read_shift(block);
    read_choice({block, Dimension::length, study.model()}, part);
  }
  return parts;
}

std::string bounds_text(double lo, double hi, Dimension dimension) {
  return fmt::format("[{}, {}]", exact_value(lo, dimension), exact_value(hi, dimension));
}

std::string grades_text(const AllocatedPart& part) {
  std::vector<std::string> grades;
  for (const ItGrade grade : part.grades) grades.push_back(in_quotes(it_grade_name(grade)));
  return fmt::format("grades = {}\nnominal_size = {}\n", list_text(grades),
                     exact_value(part.nominal_size, Dimension::length));
}

/// The processes as TOML, one on each line to keep the lines of a study file short.
std::string processes_text(const AllocatedPart& part, Dimension dimension) {
  std::string text = "processes = [\n";
  for (const StatedProcess& process : part.processes) {
    text += fmt::format("  {{ name = {}, cost = {}", in_quotes(process.name), cost_text(process.cost, dimension));
    if (std::isfinite(process.hi)) text += ", bounds = " + bounds_text(process.lo, process.hi, dimension);
    text += " },\n";
  }
  return text + "]\n";
}

std::string values_text(const AllocatedPart& part, Dimension dimension) {
  std::string text = "values = [\n";
  for (const double value : part.values) text += "  " + exact_value(value, dimension) + ",\n";
  return text + "]\n";
}

std::string choice_text(const AllocatedPart& part, Dimension dimension) {
  switch (part.choice) {
    case PartChoice::values:
      return values_text(part, dimension);
    case PartChoice::grades:
      return grades_text(part);
    case PartChoice::processes:
      return processes_text(part, dimension);
    case PartChoice::fixed:
      return "tolerance = " + exact_value(part.lo, dimension) + "\n";
    case PartChoice::range:
      break;
  }
  return std::isfinite(part.hi) ? "bounds = " + bounds_text(part.lo, part.hi, dimension) + "\n" : "";
}

std::string round_text(const AllocatedPart& part, Dimension dimension) {
  return part.round ? "round = " + rounding_text(*part.round, dimension) + "\n" : "";
}

/// Throws InputError at the value if this tolerance is too large for an error of the part.
void check_size(const StudyValue& value, double tolerance, const AllocatedPart& part, const Model& model) {
  for (const FactorIndex factor : part.factors) {
    if (const auto problem = beyond_bound(model, factor, tolerance, "a tolerance")) {
      value.fail(*problem, kTooLargeRemedy);
    }
  }
}

StudyTable parts_table() {
  return {
      .paths = {"analysis.parts"},
      .meaning =
          "For kind = \"allocation\". A part of the drawing has one tolerance T, written +-T. At most one of "
          "bounds, values, grades, processes and tolerance says of what it is chosen; with none of them it is "
          "any value.",
      .keys = {
          {.name = "name", .type = "text", .usual = "the name of its first error", .meaning = kNameMeaning},
          {.name = "factors",
           .type = "text or list of texts",
           .example = "[\"delta_1_4_*\"]",
           .meaning = "Its errors, of one dimension and in no other part: a list of names, in which '*' stands for any "
                      "letters and '?' for one; a factor set; linear or angular, all that vary and are lengths or "
                      "angles."},
          {.name = "zones",
           .type = "text or list of texts",
           .meaning = "Instead of factors, zones of the drawing, each a part of its own: \"all\", or a list such as "
                      "[\"rail.position\", \"hinge_?.position\"] of features with the keys of their zones. T is the "
                      "zone as written: a diameter, a width, or +- of a distance; errors.zones says how much of it is "
                      "used. An orientation that does not pay is left out. With each = true."},
          {.name = "each",
           .type = "true or false",
           .usual = "`false`",
           .meaning = "Whether every error is a part of its own, with its name, rather than all of them one part."},
          {.name = "identical_limbs",
           .type = "list of integers",
           .usual = "none",
           .meaning = "With each: limbs that are made alike. Errors of them whose names differ in one number "
                      "only, that of the limb or of its copy, share one tolerance. A warning says if the limbs have "
                      "other joints than each other."},
          {.name = "sigmas",
           .type = "number",
           .bounds = "greater than 0",
           .usual = "that of [analysis]",
           .meaning = "How many standard deviations of an error its tolerance is, beside the shift: "
                      "T = shift T + sigmas x standard deviation."},
          {.name = "cpk",
           .type = "number",
           .bounds = "greater than 0",
           .meaning = "Instead of sigmas, the capability of the process: sigmas / 3."},
          {.name = "shift",
           .type = "number",
           .bounds = "at least 0",
           .usual = "`0`",
           .meaning = "By which share of T the mean is off, as often up as down; less than 1."},
          {.name = "cost", .type = "table", .usual = "none", .meaning = "What the tolerance costs."},
          {.name = "bounds",
           .type = "list of two quantities",
           .meaning = "The least and the largest tolerance; the least may be 0."},
          {.name = "values",
           .type = "list of quantities",
           .bounds = "greater than 0",
           .meaning = "The tolerances that can be had, ascending."},
          {.name = "grades",
           .type = "list of texts",
           .meaning = "The grades of ISO 286-1 that can be had, IT01 to IT18, from the finest one, for lengths: +-T is "
                      "half the width of the grade's zone."},
          {.name = "nominal_size",
           .type = "length",
           .bounds = "greater than 0",
           .meaning =
               "With grades: the part's size, up to 3150 mm. A distance of the drawing has its own nominal_size, "
               "which is taken; otherwise it is required."},
          {.name = "processes",
           .type = "list of tables",
           .meaning = "Ways to make the part, one of which is chosen, instead of cost."},
          {.name = "tolerance",
           .type = "quantity",
           .bounds = "greater than 0",
           .meaning = "The tolerance itself, where it is given."},
          {.name = "round",
           .type = "quantity or text",
           .usual = "none",
           .meaning =
               "With bounds, processes or none of these: the tolerances that a workshop has, multiples of a step "
               "such as \"0.001 mm\", or the preferred numbers of ISO 3, \"R5\", \"R10\" or \"R20\", in mm "
               "or deg. T is rounded down to one of them at the end, and the certificate is of rounded "
               "tolerances."}}};
}

}  // namespace

StudyTables part_tables() {
  return {parts_table(),
          cost_table(),
          {.paths = {"analysis.parts.processes"},
           .meaning = "A way to make the part.",
           .keys = {{.name = "name", .type = "text", .usual = "1, 2 and so on", .meaning = kNameMeaning},
                    {.name = "cost",
                     .type = "table",
                     .required = true,
                     .missing = "write what its tolerances cost, e.g. {}",
                     .example = "{ law = \"reciprocal\", a = 1, b = 2, unit = \"mm\" }",
                     .meaning = "What a tolerance by this process costs."},
                    {.name = "bounds",
                     .type = "list of two quantities",
                     .usual = "any tolerance",
                     .meaning = "The least and the largest tolerance that the process holds."}}}};
}

std::optional<double> read_sigmas(const StudySection& section) {
  const auto sigmas = section.find("sigmas");
  const auto cpk = section.find("cpk");
  const auto of_cpk =
      cpk ? std::optional(kSigmasOfCpk * read_number(*cpk, sigmas_bounds(kMostCpk, "1.33"))) : std::nullopt;
  if (!sigmas) return of_cpk;
  const double own = read_number(*sigmas, sigmas_bounds(kMostSigmas, "3"));
  if (!cpk) return own;
  cpk->fail("is set, and so is " + sigmas->full_name(), "write one of them: cpk is sigmas / 3");
}

std::vector<AllocatedPart> read_part_block(const StudySection& block, const Study& study,
                                           std::optional<double> usual_sigmas,
                                           std::span<const std::string_view> taken) {
  block.allow();
  const ModelDescription& model = study.model();
  if (block.find("zones")) return read_zone_block(block, study, taken);
  const std::vector<PartMembers> members = read_members(block, study);
  check_dimensions(block, members, model);
  std::vector<AllocatedPart> parts;
  for (const PartMembers& errors : members) {
    const std::string& first = model.factors[errors.front().value].name;
    AllocatedPart part;
    if (is_each(block)) check_each_name(block, taken, first);
    part.name = is_each(block) ? first : read_name(block, taken, first);
    part.factors = errors;
    part.sigmas = sigmas_of(block, usual_sigmas, part.name);
    part.shift = read_shift(block);
    read_choice({block, dimension_of(part, model), model}, part);
    parts.push_back(std::move(part));
  }
  return parts;
}

std::string part_text(const AllocatedPart& part, const ModelDescription& model) {
  const Dimension dimension = dimension_of(part, model);
  const std::string cost =
      part.cost.law == StatedCost::Law::none ? "" : "cost = " + cost_text(part.cost, dimension) + "\n";
  if (part.zone)
    return "\n[[analysis.parts]]\n" + zones_text(part, model) + cost + choice_text(part, dimension) +
           round_text(part, dimension);
  const std::string factors = part.factors.size() > 1
                                  ? factor_list_text(part.factors, model)
                                  : fmt::format("[{}]", in_quotes(model.factors[part.factors.front().value].name));
  return fmt::format("\n[[analysis.parts]]\nname = {}\nfactors = {}\nsigmas = {}\nshift = {}\n{}{}{}",
                     in_quotes(part.name), factors, shortest(part.sigmas), shortest(part.shift), cost,
                     choice_text(part, dimension), round_text(part, dimension));
}

void check_part_sizes(const StudySection& block, const AllocatedPart& part, const Model& model) {
  const auto list = [&](std::string_view key) { return block.require(key).list(); };
  switch (part.choice) {
    case PartChoice::range:
      if (std::isfinite(part.hi)) check_size(list("bounds")[1], part.hi, part, model);
      break;
    case PartChoice::values: {
      const std::vector<StudyValue> values = list("values");
      for (std::size_t v = 0; v < part.values.size(); ++v) check_size(values[v], part.values[v], part, model);
      break;
    }
    case PartChoice::grades: {
      const std::vector<StudyValue> grades = list("grades");
      for (std::size_t g = 0; g < part.grades.size(); ++g) {
        const double width = it_grade_width(part.nominal_size, part.grades[g]).value();
        check_size(grades[g], 0.5 * width, part, model);
      }
      break;
    }
    case PartChoice::processes: {
      const std::vector<StudyValue> processes = list("processes");
      for (std::size_t p = 0; p < part.processes.size(); ++p) {
        if (!std::isfinite(part.processes[p].hi)) continue;
        const StudyValue bounds = processes[p].section().require("bounds");
        check_size(bounds.list()[1], part.processes[p].hi, part, model);
      }
      break;
    }
    case PartChoice::fixed:
      check_size(block.require("tolerance"), part.lo, part, model);
      break;
  }
}

bool has_cost(const AllocatedPart& part) { return part.cost.law != StatedCost::Law::none || !part.processes.empty(); }

Dimension dimension_of(const AllocatedPart& part, const ModelDescription& model) {
  return model.factors[part.factors.front().value].dimension;
}

}  // namespace poesy::allocation
