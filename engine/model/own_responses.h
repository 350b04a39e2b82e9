#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/model/model.h"

namespace poesy {

/// A term of a response that a user defines: another response times a weight.
struct ResponseTerm {
  std::size_t response;  ///< index in the list of the model's responses followed by the user's earlier ones
  double weight = 1.0;   ///< factor by which the response is multiplied, SI
  Dimension weighed_in = Dimension::number;  ///< dimension of `weight`, or of its inverse: number or length
  bool is_inverse = false;                   ///< true if `weighed_in` is the dimension of the inverse of `weight`
};

/// The pose to which a response is relative: the value of the response at this pose, with the same errors, is
/// subtracted.
struct ReferencePose {
  std::vector<double> pose = {};  ///< [pose coordinates], SI; empty: the previous pose (SampleBlock::previous)
  Place place = {};               ///< place in the study file, for messages

  bool is_previous() const { return pose.empty(); }  ///< Returns true if the reference is the previous pose.
};

/// A response that a user defines from the responses of a model.
struct OwnResponse {
  std::string name;                 ///< name, different from the names of all other responses
  Dimension dimension;              ///< dimension of this response
  bool is_norm;                     ///< true: root of the sum of the squares of the terms; false: sum of the terms
  std::vector<ResponseTerm> terms;  ///< terms, at least one; each response once
  std::string description = {};     ///< explanation for users; empty: the list of the terms
  /// The pose to which the response is relative; none: the response is absolute. Only a sum whose terms are absolute
  /// may be relative to a pose. A response relative to the previous pose is 0 at the first pose.
  std::optional<ReferencePose> relative_to = {};
};

/// The dimension of a term, which is a response times a weight. A weight without unit keeps the dimension of the
/// response. If the weight is a length, the product with an angle or a number is a length, and the product with a force
/// is a moment. If the weight is the inverse of a length, the product with a length is an angle, and the product with a
/// moment a force. None for other products.
std::optional<Dimension> dimension_of(const ResponseTerm& term, const ModelDescription& model);

/// The description with the user's responses appended to the list of responses, and put first among the responses that
/// summaries show (`headline` and `signed_headline`).
ModelDescription described(ModelDescription model, const std::vector<OwnResponse>& own);

/// The model with the user's responses appended. They are computed sample by sample, before any statistics. A sample
/// that is not solved at a stated reference pose counts as not solved at every pose; one that is not solved at the
/// previous pose counts as not solved at this pose. Throws InputError, with the place of the pose in the study, if a
/// response is relative to a pose that the model does not reach.
std::unique_ptr<Model> with_responses(std::unique_ptr<Model> model, std::vector<OwnResponse> own);

/// The catalog entry whose models compute the user's responses too. The entries for other metrics
/// (CatalogEntry::other_metric) and loads (with_load) stay without these responses.
CatalogEntry with_responses(CatalogEntry entry, const std::vector<OwnResponse>& own);

}  // namespace poesy
