#include "engine/kinds/sobol/groups.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>

#include "engine/base/contract.h"
#include "engine/base/name_pattern.h"

namespace poesy::sobol {
namespace {

const Factor& factor_at(const Analysis& analysis, const ModelDescription& model, std::size_t position) {
  return model.factors[analysis.factors[position].value];
}

/// Joins errors with equal text(position) into a group, which has this text as its name. Groups have the order in which
/// their texts first appear.
std::vector<ErrorGroup> joined_by(const Analysis& analysis, const std::function<std::string(std::size_t)>& text) {
  std::vector<ErrorGroup> groups;
  for (std::size_t p = 0; p < analysis.factors.size(); ++p) {
    const std::string name = text(p);
    auto group = std::ranges::find(groups, name, &ErrorGroup::name);
    if (group == groups.end()) group = groups.insert(group, {name, {}});
    group->members.push_back(p);
  }
  return groups;
}

std::string named_group(const std::vector<NamedGroup>& groups, std::string_view factor) {
  for (const NamedGroup& group : groups) {
    const auto fits = [&](const std::string& pattern) { return matches(pattern, factor); };
    if (std::ranges::any_of(group.patterns, fits)) return group.name;
  }
  return std::string(kOtherErrors);
}

/// Joins errors into the groups that the study names, in the order of the study. Errors that no named group contains
/// come last.
std::vector<ErrorGroup> joined_by_name(const Analysis& analysis, const ModelDescription& model) {
  const std::vector<NamedGroup>& named = asked_of<Options>(analysis).named_groups;
  std::vector<ErrorGroup> groups =
      joined_by(analysis, [&](std::size_t p) { return named_group(named, factor_at(analysis, model, p).name); });
  const auto place = [&](const ErrorGroup& group) { return std::ranges::find(named, group.name, &NamedGroup::name); };
  std::ranges::sort(groups, {}, place);
  return groups;
}

/// The position of the response with this name; none if the model has no such response.
std::optional<std::size_t> find_response(const ModelDescription& model, const std::string& name) {
  const auto found = std::ranges::find(model.responses, name, &Response::name);
  if (found == model.responses.end()) return std::nullopt;
  return static_cast<std::size_t>(found - model.responses.begin());
}

/// The vector whose x component is the response `x`; none if the model has no such vector.
std::optional<SignedVector> vector_of(const ModelDescription& model, std::size_t x) {
  const std::string& name = model.responses[x].name;
  if (name != "x" && !name.ends_with("_x")) return std::nullopt;
  const std::string stem = name.substr(0, name.size() - 1);
  const auto y = find_response(model, stem + "y");
  const auto z = find_response(model, stem + "z");
  if (!y || !z) return std::nullopt;
  for (const std::size_t r : {x, *y, *z}) {
    if (model.responses[r].dimension != model.responses[x].dimension) return std::nullopt;
    if (model.responses[r].is_magnitude()) return std::nullopt;
  }
  return SignedVector{stem.empty() ? "displacement" : stem.substr(0, stem.size() - 1), {x, *y, *z}};
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char letter : text) {
    if (letter == ',') {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

/// The name of a component without its axis: "omega" of "omega_x".
std::string stem_of(const std::string& component) { return component.substr(0, component.find_last_of('_')); }

/// Divides the components of an additional output of the model into sequences with the same unit, and adds a vector for
/// each sequence to `vectors`. first: position of the output's first component, as in SignedVector::components.
void append_parts(const Detail& detail, std::size_t first, std::vector<SignedVector>& vectors) {
  const std::vector<std::string> units = component_units(detail);
  const bool alone = units == std::vector(units.size(), detail.unit);
  for (std::size_t c = 0; c < detail.components.size(); ++c) {
    if (c == 0 || units[c] != units[c - 1]) {
      vectors.push_back({alone ? detail.name : detail.name + "_" + stem_of(detail.components[c]), {}});
    }
    vectors.back().components.push_back(first + c);
  }
}

}  // namespace

std::vector<ErrorGroup> error_groups(const Analysis& analysis, const ModelDescription& model) {
  const auto limb = [&](std::size_t p) { return "limb " + std::to_string(factor_at(analysis, model, p).limb); };
  switch (asked_of<Options>(analysis).groups_by) {
    case GroupsBy::limb:
      return joined_by(analysis, limb);
    case GroupsBy::frame:
      return joined_by(analysis, [&](std::size_t p) {
        return limb(p) + " frame " + std::to_string(factor_at(analysis, model, p).frame);
      });
    case GroupsBy::name:
      return joined_by_name(analysis, model);
    case GroupsBy::none:
      break;
  }
  return joined_by(analysis, [&](std::size_t p) { return factor_at(analysis, model, p).name; });
}

std::vector<std::uint8_t> split_groups(std::span<const ErrorGroup> groups, const Study& study) {
  std::vector<std::uint8_t> split(groups.size(), 0);
  for (const CorrelatedErrors& block : study.errors.correlated) {
    const auto is_in_block = [&](std::size_t p) {
      return std::ranges::find(block.factors, study.analysis.factors[p]) != block.factors.end();
    };
    std::vector<std::size_t> holders;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (std::ranges::any_of(groups[g].members, is_in_block)) holders.push_back(g);
    }
    if (holders.size() < 2) continue;
    for (const std::size_t g : holders) split[g] = 1;
  }
  return split;
}

std::vector<GroupPair> group_pairs(std::size_t groups) {
  std::vector<GroupPair> pairs;
  for (std::size_t i = 0; i < groups; ++i) {
    for (std::size_t j = i + 1; j < groups; ++j) pairs.emplace_back(i, j);
  }
  return pairs;
}

std::vector<std::string> component_units(const Detail& detail) {
  const std::vector<std::string> units = split(detail.unit);
  return units.size() == 1 ? std::vector(detail.components.size(), detail.unit) : units;
}

std::vector<SignedVector> signed_vectors(const ModelDescription& model) {
  std::vector<SignedVector> vectors;
  for (std::size_t r = 0; r < model.responses.size(); ++r) {
    if (auto vector = vector_of(model, r)) vectors.push_back(*std::move(vector));
  }
  std::size_t first = model.responses.size();
  for (const Detail& detail : model.details) {
    append_parts(detail, first, vectors);
    first += detail.components.size();
  }
  return vectors;
}

}  // namespace poesy::sobol
