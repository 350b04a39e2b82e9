#include "engine/schema/own_response_keys.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/base/text.h"

namespace poesy {
namespace {

constexpr std::string_view kPrevious = "previous";
constexpr std::string_view kOrigin = "origin";

/// The Scope (see Key) of keys whose readers need only the value of the key.
struct Nothing {};

const Keys<OwnResponse, Nothing>& response_keys() {
  using Row = Key<OwnResponse, Nothing>;
  static const Keys<OwnResponse, Nothing> keys{
      .paths = {"response"},
      .meaning =
          "A response that you define from those of the mechanism. It is computed for each sample, before statistics. "
          "It has `norm`, `sum` or `direction`, and may be named wherever a response may, also in later [[response]].",
      .rows = {
          Row{.name = "name",
              .value = text_at(&OwnResponse::name),
              .missing = "give it a name, e.g. name = \"tilt\"",
              .meaning = "Small letters, digits and underscores; unlike those of the mechanism."},
          Row{.name = "norm",
              .value = {.type = "list of texts"},
              .usual = "",
              .example = "[\"theta_x\", \"theta_y\"]",
              .meaning = "Responses of one dimension: the root of the sum of their squares."},
          Row{.name = "sum",
              .value = {.type = "table"},
              .usual = "",
              .example = "{ z = 1, theta_x = \"-20 mm\" }",
              .meaning = "Responses with signs, each with its weight: a number, a length that makes an angle a length "
                         "and a force a moment, or a number over a length, which does the reverse."},
          Row{.name = "direction",
              .value = {.type = "list of numbers"},
              .usual = "",
              .example = "[0.6, 0, 0.8]",
              .meaning = "The displacement of `point` along this direction of any length, in the base's axes."},
          Row{.name = "point",
              .value = {.type = "text"},
              .usual = "",
              .example = "\"origin\"",
              .meaning = "The point of `direction`: \"origin\" of the platform, \"tip\" of its tool, or a named point "
                         "or body."},
          Row{.name = "relative_to",
              .value = {.type = "table or text"},
              .usual = "none",
              .example = "{ x = 0, y = 0, z = \"200 mm\" }",
              .meaning = "The pose at which the same machine is zeroed: the response is less its value there, and a "
                         "norm is that of its members' differences, which are responses NAME_MEMBER. \"previous\" is "
                         "the pose before in the list; at the first pose the difference is 0."},
          Row{.name = "description",
              .value = text_at(&OwnResponse::description),
              .usual = "what it is formed of",
              .meaning = "For people."}}};
  return keys;
}

bool is_name(const std::string& text) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !text.empty() && is_letter(text.front()) &&
         std::ranges::all_of(text, [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

std::optional<std::size_t> find_response(const ModelDescription& model, const std::string& name) {
  const auto found = std::ranges::find(model.responses, name, &Response::name);
  if (found == model.responses.end()) return std::nullopt;
  return static_cast<std::size_t>(found - model.responses.begin());
}

/// A point of the platform whose displacement the model reports as three responses.
struct ReportedPoint {
  std::string name;
  /// Indices of the responses that are the displacement (m) along the base's x, y and z.
  std::array<std::size_t, 3> responses;
};

std::vector<ReportedPoint> reported_points(const ModelDescription& model) {
  std::vector<ReportedPoint> points;
  for (const Response& response : model.responses) {
    const std::string& x = response.name;
    if (x != "x" && !x.ends_with("_x")) continue;
    const std::string stem = x.substr(0, x.size() - 1);
    ReportedPoint point{stem.empty() ? std::string(kOrigin) : stem.substr(0, stem.size() - 1), {}};
    bool is_displacement = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<std::size_t> found = find_response(model, stem + "xyz"[axis]);
      is_displacement = is_displacement && found && model.responses[*found].dimension == Dimension::length &&
                        !model.responses[*found].is_magnitude();
      point.responses[axis] = found.value_or(0);
    }
    if (is_displacement) points.push_back(std::move(point));
  }
  return points;
}

/// Reads tables [[response]] one after the other. The terms of a response may be responses that were read before.
class OwnReader {
 public:
  OwnReader(ModelDescription model, PoseBefore before) : model_(std::move(model)), before_(before) {}

  void read(const StudyValue& value) {
    const StudySection section = value.section();
    OwnResponse own{};
    read_keys(response_keys(), section, own, Nothing());
    check_name(section.require("name"), own.name);
    read_form(value, section, own);
    if (const auto relative = section.find("relative_to")) make_relative(*relative, section, own);
    add(std::move(own));
  }

  std::vector<OwnResponse> own() && { return std::move(own_); }

 private:
  void check_name(const StudyValue& value, const std::string& name) const {
    if (!is_name(name)) {
      value.fail("is '" + printable(name) + "'", "a name has small letters, digits and '_', and begins with a letter");
    }
    if (std::ranges::find(own_, name, &OwnResponse::name) != own_.end()) {
      value.fail("is '" + name + "' for the second time", "choose another name");
    }
    if (!find_response(model_, name)) return;
    value.fail("is '" + name + "', which is the name of another response", "choose another name");
  }

  void read_form(const StudyValue& value, const StudySection& section, OwnResponse& own) const {
    const auto norm = section.find("norm");
    const auto sum = section.find("sum");
    const auto direction = section.find("direction");
    const auto point = section.find("point");
    if (point && !direction) point->fail("has no direction", "write one, e.g. direction = [0.6, 0, 0.8]");
    const int forms = (norm ? 1 : 0) + (sum ? 1 : 0) + (direction ? 1 : 0);
    if (forms != 1) {
      const std::string_view problem = norm && sum ? "has a norm and a sum"
                                       : forms > 1 ? "has a direction and a norm or sum"
                                                   : "has neither a norm nor a sum nor a direction";
      value.fail(problem, "write one of them: norm = [\"x\", \"y\"], sum = { z = 1 } or direction = [0.6, 0, 0.8]");
    }
    own.is_norm = norm.has_value();
    if (norm) read_norm(*norm, own);
    if (sum) read_sum(*sum, own);
    if (direction) read_direction(*direction, section.require("point", "name it: point = \"origin\""), own);
  }

  /// The index of the response of this name. Throws InputError at the value if there is no such response.
  std::size_t response_of(const StudyValue& value, const std::string& name) const {
    const std::optional<std::size_t> found = find_response(model_, name);
    if (found) return *found;
    value.fail("names '" + printable(name) + "', which is not a response of the mechanism",
               suggestion(name, names(model_.responses)));
  }

  void read_norm(const StudyValue& value, OwnResponse& own) const {
    const std::vector<StudyValue> list = value.list();
    if (list.size() < 2) value.fail(list.empty() ? "is empty" : "names one response", "name at least two");
    for (const StudyValue& one : list) {
      const std::size_t response = response_of(one, one.text());
      if (std::ranges::find(own.terms, response, &ResponseTerm::response) != own.terms.end()) {
        one.fail("is '" + one.text() + "' for the second time", "name each response once");
      }
      own.terms.push_back({response});
      const Dimension dimension = model_.responses[response].dimension;
      if (own.terms.size() == 1) own.dimension = dimension;
      if (dimension == own.dimension) continue;
      one.fail("is " + std::string(with_article(dimension)) + ", but the first one is " +
                   std::string(with_article(own.dimension)),
               "take responses of one dimension, or make a sum with lengths as weights");
    }
  }

  /// Reads a weight with a unit: "20 mm", or "1 / 20 mm".
  static void read_weight(const StudyValue& value, ResponseTerm& term) {
    const std::string written = printable(value.text());
    const std::string text(trimmed(written));
    const std::size_t slash = text.find('/');
    term.is_inverse = slash != std::string::npos;
    if (!term.is_inverse) {
      term.weight = value.quantity(Dimension::length);
      return;
    }
    const std::optional<double> above = parse_number(trimmed(std::string_view(text).substr(0, slash)));
    if (!above) value.fail("is '" + text + "', which has no number before the '/'", "write \"1 / 20 mm\"");
    const double below =
        value.quantity_of(std::string(trimmed(std::string_view(text).substr(slash + 1))), Dimension::length);
    if (below == 0.0) value.fail("divides by a length of 0", "write \"1 / 20 mm\"");
    term.weight = *above / below;
    if (!std::isfinite(term.weight)) value.fail("is not finite", "write \"1 / 20 mm\"");
  }

  ResponseTerm read_term(const StudyValue& weight, std::size_t response) const {
    ResponseTerm term{response};
    if (weight.is_text()) {
      term.weighed_in = Dimension::length;
      read_weight(weight, term);
    } else {
      term.weight = weight.number();
    }
    if (term.weight == 0.0) weight.fail("is 0", "leave the response out");
    if (model_.responses[response].is_magnitude()) {
      weight.fail("weighs '" + model_.responses[response].name + "', which has no sign",
                  "take its components, or make a norm of it");
    }
    if (!dimension_of(term, model_)) {
      weight.fail((term.is_inverse ? "is a number over a length, and '" : "is a length, and '") +
                      model_.responses[response].name + "' is " +
                      std::string(with_article(model_.responses[response].dimension)),
                  "weigh it with a number");
    }
    return term;
  }

  void read_sum(const StudyValue& value, OwnResponse& own) const {
    const StudySection section = value.section();
    for (const std::string& name : section.keys()) {
      const StudyValue weight = section.require(name);
      own.terms.push_back(read_term(weight, response_of(weight, name)));
      const Dimension dimension = *dimension_of(own.terms.back(), model_);
      if (own.terms.size() == 1) own.dimension = dimension;
      if (dimension == own.dimension) continue;
      weight.fail(
          "makes " + std::string(with_article(dimension)) + ", but the first term is " +
              std::string(with_article(own.dimension)),
          "the terms of a sum have one dimension: a length as weight, such as \"20 mm\", makes an angle a length, and "
          "\"1 / 20 mm\" a length an angle");
    }
    if (own.terms.empty()) value.fail("is empty", "give at least one response a weight, e.g. sum = { z = 1 }");
    std::ranges::sort(own.terms, {}, &ResponseTerm::response);
  }

  void read_direction(const StudyValue& value, const StudyValue& point, OwnResponse& own) const {
    const std::vector<ReportedPoint> points = reported_points(model_);
    const auto found = std::ranges::find(points, point.text(), &ReportedPoint::name);
    if (found == points.end()) {
      point.fail("names '" + printable(point.text()) + "', which is not a point whose displacement is reported",
                 points.empty() ? "the mechanism reports no displacement; make a norm or a sum of its responses"
                                : suggestion(point.text(), names(points)));
    }
    std::array<double, 3> along{};
    const std::vector<StudyValue> list = value.list(3, "write three numbers, e.g. [0.6, 0, 0.8]");
    for (std::size_t axis = 0; axis < 3; ++axis) along[axis] = list[axis].number();
    const double length = std::hypot(along[0], along[1], along[2]);
    if (!(length > 0.0 && std::isfinite(length))) value.fail("has no length", "write the direction, e.g. [0, 0, 1]");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (along[axis] != 0.0) own.terms.push_back({found->responses[axis], along[axis] / length});
    }
    own.dimension = Dimension::length;
    if (!own.description.empty()) return;
    own.description = "displacement of " + found->name + " along [" + shortest(along[0]) + ", " + shortest(along[1]) +
                      ", " + shortest(along[2]) + "], a response of one's own";
  }

  ReferencePose read_reference(const StudyValue& value) const {
    ReferencePose reference{{}, value.place()};
    if (value.is_text()) {
      if (value.text() != kPrevious) {
        value.fail("is '" + printable(value.text()) + "'", "write \"previous\", or a pose such as " + pose_example());
      }
      if (before_ == PoseBefore::unknown) {
        value.fail("is \"previous\", but a mechanism has no list of poses",
                   "write this response in the study, or take a pose such as " + pose_example());
      }
      return reference;
    }
    const StudySection section = value.section();
    section.allow(names(model_.pose_coordinates), "coordinate");
    for (const PoseCoordinate& coordinate : model_.pose_coordinates) {
      const StudyValue written = section.require(coordinate.name, "give every coordinate, e.g. " + pose_example());
      reference.pose.push_back(written.is_zero() ? 0.0 : written.quantity(coordinate.dimension));
    }
    return reference;
  }

  std::string pose_example() const {
    return inline_table(model_.pose_coordinates, [&](std::size_t c) {
      return readable_value(model_.pose_lower.empty() ? 0.0 : 0.5 * (model_.pose_lower[c] + model_.pose_upper[c]),
                            model_.pose_coordinates[c].dimension);
    });
  }

  /// Throws InputError if a term is a response that is relative to a pose, or depends on a response that is.
  void check_terms(const StudyValue& value, const OwnResponse& own) const {
    for (const ResponseTerm& term : own.terms) {
      if (!model_.responses[term.response].is_relative) continue;
      value.fail(
          "is of a response made of '" + model_.responses[term.response].name + "', which is relative to a pose itself",
          "leave out one of them");
    }
  }

  void make_relative(const StudyValue& value, const StudySection& section, OwnResponse& own) {
    const ReferencePose reference = read_reference(value);
    check_terms(value, own);
    if (!own.is_norm) {
      own.relative_to = reference;
      return;
    }
    for (std::size_t k = 0; k < own.terms.size(); ++k) {
      ResponseTerm& term = own.terms[k];
      const Response member = model_.responses[term.response];
      const StudyValue place = section.require("norm").list()[k];
      if (member.is_magnitude()) {
        place.fail("is '" + member.name + "', which has no sign, so its difference is not a part of a norm",
                   "take its components, or leave out relative_to");
      }
      const std::string name = own.name + "_" + member.name;
      if (find_response(model_, name)) {
        place.fail("gives a response '" + name + "', which there is already", "choose another name of the norm");
      }
      const std::size_t position = model_.responses.size();
      add({name, member.dimension, false, {term}, {}, reference});
      term.response = position;
    }
  }

  void add(OwnResponse own) {
    model_ = described(std::move(model_), {own});
    own_.push_back(std::move(own));
  }

  ModelDescription model_;  ///< the mechanism's description with the responses that were read so far
  PoseBefore before_;
  std::vector<OwnResponse> own_;
};

std::string form_text(const OwnResponse& own, const ModelDescription& model) {
  std::string text;
  for (const ResponseTerm& term : own.terms) {
    const std::string& name = model.responses[term.response].name;
    text += text.empty() ? "" : ", ";
    text += own.is_norm       ? in_quotes(name)
            : term.is_inverse ? name + " = " + in_quotes(shortest(term.weight) + " / 1 m")
                              : name + " = " + exact_value(term.weight, term.weighed_in);
  }
  return own.is_norm ? "norm = [" + text + "]\n" : "sum = { " + text + " }\n";
}

std::string reference_text(const ReferencePose& reference, const ModelDescription& model) {
  if (reference.is_previous()) return "relative_to = " + in_quotes(kPrevious) + "\n";
  return "relative_to = " +
         inline_table(
             model.pose_coordinates,
             [&](std::size_t c) { return exact_value(reference.pose[c], model.pose_coordinates[c].dimension); }) +
         "\n";
}

}  // namespace

StudyTables own_response_tables() {
  return {described(response_keys()),
          {.paths = {"response.sum"},
           .meaning = "'poesy models MECHANISM' lists the responses.",
           .keys = {{.name = "RESPONSE",
                     .type = "number, length, or number over length",
                     .usual = "it is not in the sum",
                     .meaning = "The weight of a response."}}},
          {.paths = {"response.relative_to"},
           .meaning = "A pose that the mechanism reaches.",
           .keys = {
               {.name = "COORDINATE", .type = "quantity", .required = true, .meaning = "The value of a coordinate."}}}};
}

std::vector<OwnResponse> read_own_responses(const StudyValue& value, ModelDescription model, PoseBefore before) {
  OwnReader reader(std::move(model), before);
  for (const StudyValue& one : value.list()) reader.read(one);
  return std::move(reader).own();
}

std::string own_responses_text(const std::vector<OwnResponse>& own, const ModelDescription& model) {
  std::string text;
  for (const OwnResponse& one : own) {
    text += "\n[[response]]\nname = " + in_quotes(one.name) + "\n" + form_text(one, model);
    if (one.relative_to) text += reference_text(*one.relative_to, model);
    if (!one.description.empty()) text += "description = " + in_quotes(one.description) + "\n";
  }
  return text;
}

}  // namespace poesy
