#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/model/model.h"

namespace poesy {

/// A response of the model with its weight.
struct ResponseTerm {
  std::size_t response;                      ///< position among the model's, or behind them among the earlier own ones
  double weight = 1.0;                       ///< SI
  Dimension weighed_in = Dimension::number;  ///< of the weight: a number, or a length
};

/// The pose whose value is subtracted from a response, with the same errors.
struct ReferencePose {
  std::vector<double> pose = {};  ///< [pose coordinates], SI; empty: the pose before (SampleBlock::previous)
  Place place = {};               ///< for messages

  bool is_previous() const { return pose.empty(); }  ///< Whether it is the pose before.
};

/// A response that somebody forms from those of a model.
struct OwnResponse {
  std::string name;                 ///< unlike those of the model
  Dimension dimension;              ///< of what is formed
  bool is_norm;                     ///< whether it is the root of the sum of the terms' squares, else their sum
  std::vector<ResponseTerm> terms;  ///< at least one, each response once
  std::string description = {};     ///< for people; empty: what it is formed of
  /// The pose whose value is subtracted; only of a sum, whose terms have none. If it is the pose before, the value at a
  /// pose without one before is 0.
  std::optional<ReferencePose> relative_to = {};
};

/// The dimension of a term: that of its response, or what a length makes of it, which is a length of an angle and a
/// moment of a force. Empty where nothing is known of the product.
std::optional<Dimension> dimension_of(const ResponseTerm& term, const ModelDescription& model);

/// The description with these responses behind its own, and first among those that a summary shows.
ModelDescription described(ModelDescription model, const std::vector<OwnResponse>& own);

/// The model with these responses behind its own, formed before anything is counted. A sample without a solution at a
/// pose that a response is relative to has none at any pose. Throws InputError at its place if a response is relative
/// to a pose that the model does not reach.
std::unique_ptr<Model> with_responses(std::unique_ptr<Model> model, std::vector<OwnResponse> own);

/// The mechanism with these responses. Its other metrics and loads stay without them.
CatalogEntry with_responses(CatalogEntry entry, const std::vector<OwnResponse>& own);

}  // namespace poesy
