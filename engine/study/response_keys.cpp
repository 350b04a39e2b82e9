#include <algorithm>

#include "engine/base/text.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

const InnerRows<OwnResponse>& response_keys() {
  static const InnerRows<OwnResponse> keys{
      .paths = {"response"},
      .meaning =
          "A response of one's own, formed from those of the mechanism before anything is counted. It has `norm` "
          "or `sum`, and may be named wherever a response may.",
      .rows = {
          InnerRow<OwnResponse>{.name = "name",
                                .value = text_at(&OwnResponse::name),
                                .missing = "give it a name, e.g. name = \"tilt\"",
                                .meaning = "Small letters, digits and underscores; unlike those of the mechanism."},
          InnerRow<OwnResponse>{.name = "norm",
                                .value = {.type = "list of texts"},
                                .usual = "",
                                .example = "[\"theta_x\", \"theta_y\"]",
                                .meaning = "Responses of one dimension: the root of the sum of their squares."},
          InnerRow<OwnResponse>{.name = "sum",
                                .value = {.type = "table"},
                                .usual = "",
                                .example = "{ z = 1, theta_x = \"-20 mm\" }",
                                .meaning = "Responses with signs, each with its weight: a number, or a length "
                                           "that makes an angle a length and a force a moment."},
          InnerRow<OwnResponse>{.name = "description",
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

/// The position of a response of this name. Throws InputError at the value.
std::size_t response_of(const StudyValue& value, const std::string& name, const ModelDescription& model) {
  const auto found = std::ranges::find(model.responses, name, &Response::name);
  if (found == model.responses.end()) {
    value.fail("names '" + printable(name) + "', which is not a response of the mechanism",
               suggestion(name, names(model.responses)));
  }
  return static_cast<std::size_t>(found - model.responses.begin());
}

void check_name(const StudyValue& value, const std::string& name, const ModelDescription& model) {
  if (!is_name(name)) {
    value.fail("is '" + printable(name) + "'", "a name has small letters, digits and '_', and begins with a letter");
  }
  if (std::ranges::find(model.responses, name, &Response::name) == model.responses.end()) return;
  value.fail("is '" + name + "', which is the name of another response", "choose another name");
}

void read_norm(const StudyValue& value, const ModelDescription& model, OwnResponse& own) {
  const std::vector<StudyValue> list = value.list();
  if (list.size() < 2) value.fail(list.empty() ? "is empty" : "names one response", "name at least two");
  for (const StudyValue& one : list) {
    const std::size_t response = response_of(one, one.text(), model);
    if (std::ranges::find(own.terms, response, &ResponseTerm::response) != own.terms.end()) {
      one.fail("is '" + one.text() + "' for the second time", "name each response once");
    }
    own.terms.push_back({response});
    const Dimension dimension = model.responses[response].dimension;
    if (own.terms.size() == 1) own.dimension = dimension;
    if (dimension == own.dimension) continue;
    one.fail("is " + std::string(with_article(dimension)) + ", but the first one is " +
                 std::string(with_article(own.dimension)),
             "take responses of one dimension, or make a sum with lengths as weights");
  }
}

ResponseTerm read_term(const StudyValue& weight, std::size_t response, const ModelDescription& model) {
  ResponseTerm term{response};
  if (weight.is_text()) {
    term.weighed_in = Dimension::length;
    term.weight = weight.quantity(Dimension::length);
  } else {
    term.weight = weight.number();
  }
  if (term.weight == 0.0) weight.fail("is 0", "leave the response out");
  if (model.responses[response].is_magnitude()) {
    weight.fail("weighs '" + model.responses[response].name + "', which has no sign",
                "take its components, or make a norm of it");
  }
  if (!dimension_of(term, model)) {
    weight.fail("is a length, and '" + model.responses[response].name + "' is " +
                    std::string(with_article(model.responses[response].dimension)),
                "weigh it with a number");
  }
  return term;
}

void read_sum(const StudyValue& value, const ModelDescription& model, OwnResponse& own) {
  const StudySection section = value.section();
  for (const std::string& name : section.keys()) {
    const StudyValue weight = section.require(name);
    own.terms.push_back(read_term(weight, response_of(weight, name, model), model));
    const Dimension dimension = *dimension_of(own.terms.back(), model);
    if (own.terms.size() == 1) own.dimension = dimension;
    if (dimension == own.dimension) continue;
    weight.fail(
        "makes " + std::string(with_article(dimension)) + ", but the first term is " +
            std::string(with_article(own.dimension)),
        "the terms of a sum have one dimension: a length as weight, such as \"20 mm\", makes an angle a length");
  }
  if (own.terms.empty()) value.fail("is empty", "give at least one response a weight, e.g. sum = { z = 1 }");
  std::ranges::sort(own.terms, {}, &ResponseTerm::response);
}

OwnResponse read_response(const StudyValue& value, const ModelDescription& model) {
  const StudySection section = value.section();
  OwnResponse own{};
  read_keys(response_keys(), section, own, Nothing());
  check_name(section.require("name"), own.name, model);
  const auto norm = section.find("norm");
  const auto sum = section.find("sum");
  if (norm.has_value() == sum.has_value()) {
    value.fail(norm ? "has a norm and a sum" : "has neither a norm nor a sum",
               "write one of them: norm = [\"x\", \"y\"] or sum = { z = 1 }");
  }
  own.is_norm = norm.has_value();
  norm ? read_norm(*norm, model, own) : read_sum(*sum, model, own);
  return own;
}

std::string terms_text(const OwnResponse& own, const ModelDescription& model) {
  std::string text;
  for (const ResponseTerm& term : own.terms) {
    const std::string& name = model.responses[term.response].name;
    text += text.empty() ? "" : ", ";
    text += own.is_norm ? in_quotes(name) : name + " = " + exact_value(term.weight, term.weighed_in);
  }
  return own.is_norm ? "norm = [" + text + "]\n" : "sum = { " + text + " }\n";
}

std::string responses_lines(const Study& study) {
  std::string text;
  for (const OwnResponse& own : study.mechanism.responses) {
    text += "\n[[response]]\nname = " + in_quotes(own.name) + "\n" + terms_text(own, study.model());
    if (!own.description.empty()) text += "description = " + in_quotes(own.description) + "\n";
  }
  return text;
}

}  // namespace

StudyRow response_row() {
  return {.name = "response",
          .value = {.type = "list of tables"},
          .usual = "none",
          .meaning = "Responses of one's own, [[response]].",
          .lines = responses_lines,
          .late = 1};
}

StudyTables response_tables() {
  return {described(response_keys()),
          {.paths = {"response.sum"},
           .meaning = "'poesy models MECHANISM' lists the responses.",
           .keys = {{.name = "RESPONSE",
                     .type = "number or length",
                     .usual = "it is not in the sum",
                     .meaning = "The weight of a response."}}}};
}

void read_responses(Study& study, const Reading& reading) {
  const auto value = reading.root.find("response");
  if (!value) return;
  MechanismChoice& choice = study.mechanism;
  const CatalogEntry& entry = *choice.entry;
  for (const StudyValue& one : value->list()) {
    OwnResponse own = read_response(one, entry.description);
    if (std::ranges::find(choice.responses, own.name, &OwnResponse::name) != choice.responses.end()) {
      one.section().require("name").fail("is '" + own.name + "' for the second time", "choose another name");
    }
    choice.responses.push_back(std::move(own));
  }
  choice.with_responses = std::make_shared<const CatalogEntry>(with_responses(entry, choice.responses));
  choice.entry = choice.with_responses.get();
}

}  // namespace poesy
