#pragma once

#include <string>
#include <vector>

#include "engine/model/model.h"

namespace poesy {

/// A response of the model with its weight.
struct ResponseTerm {
  std::size_t response;                      ///< position among the model's
  double weight = 1.0;                       ///< SI
  Dimension weighed_in = Dimension::number;  ///< of the weight: a number, or a length
};

/// A response that somebody forms from those of a model.
struct OwnResponse {
  std::string name;                 ///< unlike those of the model
  Dimension dimension;              ///< of what is formed
  bool is_norm;                     ///< whether it is the root of the sum of the terms' squares, else their sum
  std::vector<ResponseTerm> terms;  ///< at least one, each response once
  std::string description = {};     ///< for people; empty: what it is formed of
};

/// The dimension of a term: that of its response, or what a length makes of it, which is a length of an angle and a
/// moment of a force. Empty where nothing is known of the product.
std::optional<Dimension> dimension_of(const ResponseTerm& term, const ModelDescription& model);

/// The mechanism with these responses behind its own, formed before anything is counted, and first among those that a
/// summary shows. Its other metrics and loads stay without them.
CatalogEntry with_responses(CatalogEntry entry, const std::vector<OwnResponse>& own);

}  // namespace poesy
