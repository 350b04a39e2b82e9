#include "engine/kinds/allocation/members.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <string>

#include "engine/base/name_pattern.h"
#include "engine/base/text.h"

namespace poesy::allocation {
namespace {

const Factor& factor_of(const Study& study, FactorIndex factor) { return study.model().factors[factor.value]; }

bool varies(const Study& study, FactorIndex factor) {
  return std::ranges::find(study.analysis.factors, factor) != study.analysis.factors.end();
}

/// The varied errors of this dimension. Throws InputError at the value if there are none.
PartMembers members_of(const StudyValue& value, Dimension dimension, const Study& study) {
  PartMembers members;
  for (const FactorIndex factor : study.analysis.factors) {
    if (factor_of(study, factor).dimension == dimension) members.push_back(factor);
  }
  if (!members.empty()) return members;
  value.fail(fmt::format("is \"{}\", but no error that the study varies is {}", error_kind(dimension),
                         with_article(dimension)),
             "leave this part out");
}

/// The errors that a word names: "linear", "angular" and "relative" name all varied errors of that dimension, unless a
/// factor set has this name. Any other word is the name of a factor set.
PartMembers members_by_word(const StudyValue& value, const Study& study) {
  const ModelDescription& model = study.model();
  for (const Dimension dimension : kErrorDimensions) {
    const std::string_view word = error_kind(dimension);
    if (value.text() == word && model.find_set(word) == nullptr) return members_of(value, dimension, study);
  }
  PartMembers members = read_factors(value, study);
  for (const FactorIndex factor : members) {
    if (varies(study, factor)) continue;
    value.fail("has '" + factor_of(study, factor).name + "', which the study does not vary",
               "name it in analysis.factors, or list the errors of this part by name");
  }
  return members;
}

/// Refuses a name or a pattern that fits no varied error.
[[noreturn]] void refuse_pattern(const StudyValue& value, const std::string& pattern, const Study& study) {
  const ModelDescription& model = study.model();
  const auto fits = [&](const Factor& factor) { return matches(pattern, factor.name); };
  if (const auto factor = std::ranges::find_if(model.factors, fits); factor != model.factors.end()) {
    value.fail(fmt::format("is '{}', but the study does not vary '{}'", printable(pattern), factor->name),
               "name it in analysis.factors, or leave it out here");
  }
  value.fail("is '" + printable(pattern) + "', which is none of the model's errors",
             is_pattern(pattern) ? listed_by_models(study) : suggestion(pattern, names(model.factors)));
}

PartMembers members_by_pattern(const StudyValue& value, const Study& study) {
  PartMembers members;
  std::vector<bool> taken(study.model().factors.size());
  for (const StudyValue& element : value.list()) {
    const std::string pattern = element.text();
    bool any = false;
    for (const FactorIndex factor : study.analysis.factors) {
      if (!matches(pattern, factor_of(study, factor).name)) continue;
      any = true;
      if (!taken[factor.value]) members.push_back(factor);
      taken[factor.value] = true;
    }
    if (!any) refuse_pattern(element, pattern, study);
  }
  if (members.empty()) value.fail("is empty", "name the part's errors, e.g. [\"delta_1_4_*\"]");
  return members;
}

bool is_digit(const std::string& text, std::size_t at) {
  return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0;
}

/// The pieces of a name, which are numbers and the text between them: "rod_", "1", "_x" for "rod_1_x".
std::vector<std::string> pieces_of(const std::string& name) {
  std::vector<std::string> pieces;
  for (std::size_t at = 0; at < name.size(); ++at) {
    if (at == 0 || is_digit(name, at) != is_digit(name, at - 1)) pieces.emplace_back();
    pieces.back() += name[at];
  }
  return pieces;
}

/// Returns true if two names differ only in one number: "rod_1_x" and "rod_2_x".
bool differ_in_one_number(const std::string& one, const std::string& other) {
  const std::vector<std::string> a = pieces_of(one);
  const std::vector<std::string> b = pieces_of(other);
  if (a.size() != b.size()) return false;
  std::size_t numbers = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k] == b[k]) continue;
    if (!is_digit(a[k], 0) || !is_digit(b[k], 0)) return false;
    ++numbers;
  }
  return numbers == 1;
}

/// The only error of limb `limb` with the frame and the dimension of `factor` whose name differs from that of `factor`
/// in one number. None if there is no such error, or if there are several.
std::optional<FactorIndex> only_similar(const Factor& factor, std::size_t limb, const ModelDescription& model) {
  std::optional<FactorIndex> only;
  for (std::size_t f = 0; f < model.factors.size(); ++f) {
    const Factor& other = model.factors[f];
    if (other.limb != limb || other.frame != factor.frame || other.dimension != factor.dimension) continue;
    if (!differ_in_one_number(factor.name, other.name)) continue;
    if (only) return std::nullopt;
    only = FactorIndex(f);
  }
  return only;
}

/// The error of limb `limb` that corresponds to `factor`: it has the same frame and dimension, and its name differs
/// only in the number of the limb. If there is none, the error that only_similar() finds for `factor`, provided that
/// only_similar() finds `factor` for that error. This is the case for copies of a named limb, whose errors have the
/// number of the copy in their names.
std::optional<FactorIndex> counterpart(const Factor& factor, std::size_t limb, const ModelDescription& model) {
  const std::string number = std::to_string(factor.limb);
  for (std::size_t at = factor.name.find(number); at != std::string::npos; at = factor.name.find(number, at + 1)) {
    if (is_digit(factor.name, at + number.size()) || (at > 0 && is_digit(factor.name, at - 1))) continue;
    std::string name = factor.name;
    const auto found = model.find_factor(name.replace(at, number.size(), std::to_string(limb)));
    if (!found) continue;
    const Factor& other = model.factors[found->value];
    if (other.limb == limb && other.frame == factor.frame && other.dimension == factor.dimension) return found;
  }
  const std::optional<FactorIndex> similar = only_similar(factor, limb, model);
  if (!similar) return std::nullopt;
  const std::optional<FactorIndex> back = only_similar(model.factors[similar->value], factor.limb, model);
  return back && model.factors[back->value].name == factor.name ? similar : std::nullopt;
}

/// Joins each error with its counterparts in the other listed limbs into one part.
std::vector<PartMembers> joined(const PartMembers& members, const Limbs& limbs, const ModelDescription& model) {
  std::vector<bool> left(model.factors.size());
  for (const FactorIndex factor : members) left[factor.value] = true;
  std::vector<PartMembers> parts;
  for (const FactorIndex factor : members) {
    if (!left[factor.value]) continue;
    left[factor.value] = false;
    parts.push_back({factor});
    const Factor& first = model.factors[factor.value];
    if (std::ranges::find(limbs, first.limb) == limbs.end()) continue;
    for (const std::size_t limb : limbs) {
      const auto other = limb == first.limb ? std::nullopt : counterpart(first, limb, model);
      if (!other || !left[other->value]) continue;
      left[other->value] = false;
      parts.back().push_back(*other);
    }
  }
  return parts;
}

}  // namespace

void check_distributions(const StudyValue& value, const PartMembers& members, const Study& study) {
  for (const FactorIndex factor : members) {
    const std::string& error = factor_of(study, factor).name;
    if (study.errors.by_factor[factor.value].shape() == Distribution::Shape::measured) {
      value.fail("has '" + error + "', whose distribution is measured, so its tolerance cannot be chosen",
                 "leave it out of all parts to let it vary as measured, or give it another distribution");
    }
    if (study.errors.by_factor[factor.value].centre() != 0.0) {
      value.fail("has '" + error + "', whose mean is not zero, so its tolerance is not about the nominal size",
                 "take the nominal size in the middle of the limits and remove the mean, or leave it out of all parts");
    }
    for (const Feature& feature : features_drawn_together(study)) {
      const std::vector<FactorIndex> errors = feature.errors();
      if (std::ranges::find(errors, factor) == errors.end()) continue;
      value.fail("has '" + error + "', which is drawn with all of '" + feature.name + "' in its zone",
                 "write errors.zones = { distribution = \"normal\", sigmas = 3 }, or leave it out of all parts");
    }
    if (study.errors.is_per_pose(factor)) {
      value.fail("has '" + error + "', which a machine draws anew at each pose, so no part has it",
                 "leave it out of all parts; it varies all the same");
    }
    for (const CorrelatedErrors& block : study.errors.correlated) {
      if (std::ranges::find(block.factors, factor) == block.factors.end()) continue;
      value.fail("has '" + error + "', which errors.correlated correlates with others",
                 "leave it out of all parts, or out of errors.correlated");
    }
  }
}

Limbs read_limbs(const StudyValue& value, const ModelDescription& model) {
  std::set<std::size_t> known;
  for (const Factor& factor : model.factors) known.insert(factor.limb);
  Limbs limbs;
  for (const StudyValue& element : value.list()) {
    if (element.is_text()) {
      element.fail(
          "is '" + printable(element.text()) + "', but this key takes the numbers of limbs",
          fmt::format("write some of {}; each copy of a limb has a number of its own", fmt::join(known, ", ")));
    }
    limbs.push_back(static_cast<std::size_t>(element.whole_number(0)));
    if (std::ranges::count(limbs, limbs.back()) > 1) {
      element.fail(fmt::format("names limb {} a second time", limbs.back()), "remove one of them");
    }
    if (known.contains(limbs.back())) continue;
    element.fail(
        fmt::format("is {}, but model \"{}\" has errors of limbs {}", limbs.back(), model.name, fmt::join(known, ", ")),
        "name some of them");
  }
  if (limbs.size() < 2) value.fail("names fewer than two limbs", "name all limbs that are made alike, e.g. [1, 2]");
  return limbs;
}

bool is_each(const StudySection& block) {
  const auto each = block.find("each");
  return each && each->yes_or_no();
}

std::vector<PartMembers> read_members(const StudySection& block, const Study& study) {
  const StudyValue value =
      block.require("factors", "name the part's errors, e.g. [\"delta_1_4_*\"], or zones of the drawing");
  const PartMembers members = value.is_text() ? members_by_word(value, study) : members_by_pattern(value, study);
  check_distributions(value, members, study);
  const auto identical = block.find("identical_limbs");
  const Limbs limbs = identical ? read_limbs(*identical, study.model()) : Limbs();
  if (is_each(block)) {
    std::vector<PartMembers> parts = joined(members, limbs, study.model());
    if (!identical || parts.size() < members.size()) return parts;
    identical->fail("joins no two errors of this block",
                    "name limbs whose errors have the same names, or leave it out");
  }
  if (!identical) return {members};
  identical->fail("is set, but each is not true, so all errors of the block share one tolerance",
                  "write each = true besides, or leave it out");
}

}  // namespace poesy::allocation
