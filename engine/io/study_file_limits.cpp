#include <algorithm>

#include "engine/base/text.h"
#include "engine/io/study_file_parts.h"

namespace poesy {
namespace {

/// In the order of the model's responses.
std::vector<ResponseLimit> read_response_limits(const StudySection& section, const ModelDescription& model) {
  section.allow(names(model.responses), "response");
  std::vector<ResponseLimit> limits;
  for (std::size_t r = 0; r < model.responses.size(); ++r) {
    const Response& response = model.responses[r];
    if (const auto value = section.find(response.name)) {
      limits.push_back({r, value->positive_quantity(response.dimension)});
    }
  }
  return limits;
}

Judge read_judge(const StudyValue& value) {
  std::vector<std::string_view> words;
  for (const Judge judge : kJudges) words.push_back(name(judge));
  return kJudges[value.word(words)];
}

}  // namespace

void read_limits(const StudySection& section, const ModelDescription& model, Analysis& analysis) {
  const auto limits = section.find("limits");
  const auto judge = section.find("judge");
  const auto share = section.find("share");
  if (limits) {
    analysis.limits = read_response_limits(limits->section(), model);
    if (analysis.limits.empty()) limits->fail("states no limit", "write a response with its limit, or leave it out");
  }
  if (judge) analysis.judge = read_judge(*judge);
  if (share) analysis.share = read_share(*share, "0.9973");
  if (analysis.judge == Judge::share && !share) {
    judge->fail("is \"share\", but analysis.share is missing", "write the share of the draws, e.g. share = 0.9973");
  }
  if (analysis.judge != Judge::share && share) {
    share->fail("is set, but analysis.judge is \"rms\"", "write judge = \"share\", or leave it out");
  }
  if (judge && !limits)
    judge->fail("is set, but the study states no limit", "write [analysis.limits], or leave it out");
}

}  // namespace poesy
